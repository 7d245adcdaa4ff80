"""Components of systems that are no contacts, each an FMU of its own.

    part    what a component is: parameters, variables, three pure functions

They know neither FMI nor one another.
"""
