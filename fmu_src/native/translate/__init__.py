"""From the Python of the regression level to C99, with everything known of one scene put in.

    values        numbers that are known at run time only, as C expressions
    code          C statements, pruned and printed
    units         C functions under construction, values from several branches
    sources       functions of Python: trees, names, texts
    library       what functions of Python, math and numpy are in C
    conditions    comparisons, `and`, `or`, `not`, choices
    names         names of a scope of Python
    expressions   other expressions of Python
    loops         loops that stay loops
    results       what C functions return
    members       members of results that nothing reads
    constants     known arrays as tables
    grids         arrays at run time: elements, views, loops over them
    grid_parts    parts of them: by numbers, slices, places and masks
    grid_sums     sums, extremes and their places
    grid_library  what functions and methods of numpy are for them
    arrays        what a law gives for each element of an array
    rolled        loops in place of what is written out for each node of a sum
    paired        two powers in one call
    passes        what is made of the statements of a C function
    interpreter   statements of Python
    functions     C functions: one for each way in which a Python function is used
    translator    calls, and what programs are written from

Nothing here knows contacts: `fmu_src.native.program` says what is written.
"""

from .code import c_type, declared, wrapped
from .grids import Stored
from .translator import Entry, Translator
from .values import Num, Untranslatable, array_kind, is_number, leaves, literal, parts, replaced
