"""The tests, the code and the documentation.

faults            faults put into the code, and the tests that notice them
golden            numbers of two revisions, bit for bit: `python benchmarks/house/golden.py REV`
stays             functions through which operating point, scene and state travel
soak              runs that are killed, interrupted and cut off, and gone on with
how_good          docs/how_good.md, written from the pages
"""
