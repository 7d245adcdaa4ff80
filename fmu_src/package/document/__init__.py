"""The documentation in an FMU: documentation/index.html, one page, readable without network and scripts.

    page        the page: its sections in order
    contact     sections on the contact: data, signs, validity, errors, steps
    formulas    the section of equations, from the records of the scene
    interface   sections on the FMU: status, variables, state, log, requirements, licence
    levels      sentences and rows that differ between the fidelity levels

`measured.toml` has the figures, `signs.svg` and `steps.svg` are the two drawings.

A new law, shape or output needs no change here: its record carries what the page shows of it.
"""
