"""Comparisons with measurements, published numbers, closed forms and a thesis: one verdict each, with its cause.

    registry        the comparisons of comparisons.toml, and how each is run
    model           records: comparison, row, cause, verdict
    optical_films   measured: central films from 5 mm/s to 4 m/s
    dimple          measured: a dimple that crosses a contact
    oils            measured: viscosities of the named oils
    base_oils       measured: pressure coefficients by two viscosities and a family
    traction        measured: friction of full films
    asperity_load   published numerical: share of the load on the solids
    rolling_torques measured: friction torques of bearings that roll
    film_formulas   published numerical: films of points and lines
    starvation      published numerical: films of too little oil
    dry_contact     closed form: Hertz's contact
    stresses        closed form: largest shear below it
    flash           closed form: heat sources that move
    thesis          thesis: two hours of the shipped cases
    tables          the tables in `data/`, with their licences
    terminal        outcomes as text
    page            outcomes as a web page of one file, with its pictures

A comparison says what an answer may differ by, and why, before it is run. Where the cause of a difference is known, so
is the range of answers that it explains: another answer is a disagreement of unknown cause.
"""
