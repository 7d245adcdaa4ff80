"""Charts as records, and the two ways in which they are drawn; units that people read.

    chart        the records: chart, line, map, and the sheet of charts that is one picture; the palette
    scale        the ranges of a chart's axes and the numbers along them
    svg          a chart as SVG within a page, with its points for the pointer
    files        a sheet as a picture by matplotlib: in a file, or within a page
    units        the units in which people read a quantity
    half_widths  values with the half widths of their errors as text

A report builds charts; how they look is decided here alone.
"""
