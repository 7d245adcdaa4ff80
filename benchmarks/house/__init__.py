"""The tests, the code and the documentation.

faults            faults put into the code, and the tests that notice them
stays             functions through which operating point, scene and state travel
trust             the tables of docs/trust.md, written from the sections
bibliography      docs/bibliography.md
"""
