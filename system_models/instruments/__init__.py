"""Files of instruments: measured surfaces, and logs of test rigs.

    image         heights as an instrument gives them, points without a height among them
    surface_file  reads them from the formats of instruments, by SurfaceTopography
    text_heights  heights in text that it does not take: a matrix of numbers, points with gaps
    patch         form removed, gaps filled, waves cut, on a square lattice; what is shorter as roughness below the grid
    surface_set   the patch as a file of heights and a set that a scene takes
    log_columns   which columns of a log are which quantity
    log_file      reads the steps of a log
    log_tables    a duty and data for `tribofmu fit` from them

Nothing below imports these: scenes know files of heights, duties and data, not where they came from.
"""
