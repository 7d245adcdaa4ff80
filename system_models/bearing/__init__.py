"""Ball bearings: how loads and speed of the shaft become loads and motion of the contacts.

    geometry     balls and grooves, curvatures, Hertz stiffness, free contact angle; bearings 209 and 218
    equilibrium  where the inner ring comes to rest, with five degrees of freedom
    kernels      of it: balls and ring at rest, how balls roll
    kinematics   speeds, spin and differential sliding in the contacts
    levels       balls in classes of contacts, one for all that carry about one load
    part         the bearing as a component: `BallBearing`
    textbook     friction torque after SKF and Palmgren, load integrals after Sjovall

x is the bearing's axis, y and z are radial, azimuths run from y towards z. The outer ring is at rest.
"""
