"""The tests, the code and the README.

faults            faults put into the code, and the tests that notice them
golden            numbers of two revisions, bit for bit: `python benchmarks/house/golden.py REV`
stays             functions through which operating point, scene and state travel
readme_figures    figures of the README, written from the pages
"""
