"""The tests and the README: faults put into the code, figures written from the pages."""
