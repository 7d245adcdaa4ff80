"""Many runs of one scene: which values it takes, how results depend on them.

    plan         what is varied: grids, choices, and ranges with samples in them
    points       one run of the scene for each point, kept in a file of its own; all of them as one Dataset
    sensitivity  Sobol indices: which share of an output's variance is due to which key
    ensemble     mean and band over patches of one surface
    members      the ensemble of a scene as one result
    report       table, sentences and picture

A point is a whole run, as `tribofmu run` makes it. Imports run from the bottom of this list to its top.
"""
