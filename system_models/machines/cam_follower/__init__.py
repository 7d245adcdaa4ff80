"""Cam and flat-faced follower.

    machine    its parts, contacts and connections
    profile    CamProfile: lift over the angle of the cam, its derivatives, contour; stations where contacts are solved
    part       CamFollower: speed of the cam to the stations, their friction and heat back to the shaft
    record     the results of a run over the angle of the cam
    report     the printed report; pictures: over the angle of the cam, and against time
    shipped/   the files of cams that come with the package

Body 1 is the cam, body 2 the follower. Angles are those of the cam from its nose, negative while the follower opens.
"""
