"""Components of systems that have no contact, each an FMU of its own.

    part          a component: parameters, variables, three pure functions
    speed_source  a motor that is stronger than its load
    shaft         the inertia that it drives; brake: a load on a shaft
    spindle       a body of a rig on its servo motor; load_arm: the load of a rig
    thermal       temperatures of housing, oil and shafts, with thermostats
    timetable     the duty of a machine as a component
    linear        x' = A x + B u over any step
    build         the FMU of a component; variables: its variables; resources: its files; slave: its runtime
    native        its C, written from its Python; scalars: what functions of libraries compute, for that once more with
                  bounded loops; eigen: eigenvalues of small symmetric matrices

Components know neither FMI nor one another.
"""
