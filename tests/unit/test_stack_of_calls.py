"""The bytes that functions in C hold at once."""

from fmu_src.native.calls import stack_of

LEAF = "static double leaf(double x)\n{\n    double a[10];\n    return x;\n}"
SMALL = "static double small(double x)\n{\n    double a[2];\n    return x;\n}"
BRANCH = "static double branch(double x)\n{\n    double a[5];\n    int n[3];\n    return leaf(x) + small(x);\n}"


def test_a_function_holds_its_own_arrays_and_those_of_the_larger_one_that_it_calls() -> None:
    """Two calls one after the other share the stack: 8 (5 + 3) and 80 of the larger."""
    assert stack_of([LEAF]) == 80
    assert stack_of([LEAF, SMALL]) == 80
    assert stack_of([LEAF, SMALL, BRANCH]) == 64 + 80
    assert stack_of([]) == 0
