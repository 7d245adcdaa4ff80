"""Components of systems that are no contacts, each an FMU of its own.

    part           what a component is: parameters, variables, three pure functions
    speed_source   a motor that is stronger than its load
    shaft          the inertia that it drives; brake: what loads it
    spindle        a body of a rig on its servo motor; load_arm: what presses it on the other
    thermal        temperatures of housing, oil and shafts, with thermostats

Numerics: linear: x' = A x + B u over any step; conduction: the same for heat capacities joined by conductances.
These know neither FMI nor one another. Their FMUs: variables, resources (what lies in the FMU), slave (which runs it),
build; timetable: a machine's duty as a component.
"""
