"""Results as HTML pages: one file each, without network, for reading, printing and showing to others.

    opened      a folder of results as a Run: finished or not, of a contact, a machine or any system
    summary     the end values and what to think of them
    scene       the scene as it was run; what was modelled and what was not
    ensemble    an ensemble of surfaces: its mean, its band, its members
    histories   quantities against time, of one contact, of a machine's parts and of each of its contacts
    maps        maps at times of the run as data of the page, profiles across the track
    machine     report and pictures of a machine, and its states solved again
    errors      errors by cause, of contacts and of the coupling of a machine's parts
    trust       flags with their times, statistics of the solver
    origin      sources, versions, digests
    page        the page of one run
    compare     several runs in the same charts, with their bands; a table for the terminal

All is there without the script of the page, but for maps and values under the pointer.
"""
