"""Ball on disc, the test rig.

    machine   its parts, contact and connections
    report    tables, Stribeck curves of its duty, energy of the bath, picture
    shipped/  the files of rigs that come with the package

Body 1 is the ball, body 2 the disc.
"""
