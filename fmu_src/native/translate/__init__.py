"""From the Python of the regression level to C99, with everything known of one scene put in.

    values        numbers that are known at run time only, as C expressions
    code          C statements, pruned and printed
    units         C functions under construction, values from several branches
    library       what functions of Python, math and numpy are in C
    interpreter   statements and expressions
    functions     calls, loops, C functions
"""

from .functions import Entry, Translator
from .values import Num, Untranslatable, leaves, literal, replaced

__all__ = ["Entry", "Num", "Translator", "Untranslatable", "leaves", "literal", "replaced"]
