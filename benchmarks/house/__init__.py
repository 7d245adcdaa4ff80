"""The tests, the code and the documentation.

faults            faults put into the code, and the tests that notice them
stays             functions through which operating point, scene and state travel
how_good          docs/how_good.md, written from the sections
bibliography      docs/bibliography.md
"""
