"""The slave of a contact: the Python code that runs inside an FMU.

    slave       the slave of a contact: callbacks in, contact_core.advance out
    guarded     its base: phases and steps of a slave that raises nothing to its host
    references  the base of that: variables by value reference
    snapshot    the FMU's state as a frozen record and as bytes
    resources   scene, versions and script in the FMU, written and read in one place
    loader      clean-up after pythonfmu's binary (embedded FMUs)

"slave" is pythonfmu's word for the Python class of an FMU instance.
"""
