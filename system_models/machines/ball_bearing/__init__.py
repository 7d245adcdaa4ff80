"""Ball bearing on its shaft. Loads and speed of the shaft become loads and motion of the contacts.

    machine       its parts, contacts and connections
    part          the bearing as a component: `BallBearing`
    geometry      balls and grooves, curvatures, Hertz stiffness, free contact angle; bearings 209 and 218
    equilibrium   equilibrium of the inner ring, with five degrees of freedom
    kernels       equilibrium of balls and ring, rolling of balls
    kinematics    speeds, spin and differential sliding in the contacts
    load_classes  balls in load classes, one contact for all balls of about one load
    textbook      friction torque after SKF and Palmgren, load integrals after Sjovall
    rating        rating life by ISO 281 and ISO 16281
    stress_life   life of a contact by the integral of the stress below it
    lives         rating lives over a run, row by row
    record        the results of a run by class and ball
    report        the printed report; pictures: its pictures
    shipped/      the files of bearings that come with the package

x is the bearing's axis, y and z are radial, azimuths run from y towards z. The outer ring is at rest.
"""
