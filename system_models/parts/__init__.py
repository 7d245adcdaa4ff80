"""Components of systems that are no contacts, each an FMU of its own.

    part        what a component is: parameters, variables, three pure functions
    drive       a motor that holds a speed; brake: what loads it; shaft: the inertia between them
    spindle     a body of a rig on its servo motor; load_arm: what presses it on the other
    thermal     temperatures of housing, oil and shafts, with thermostats

Numerics: linear: x' = A x + B u over any step; conduction: the same for heat capacities joined by conductances.
They know neither FMI nor one another.
"""
