"""Measurements of accuracy and cost. Run from the root of the source tree: `python -m benchmarks.<room>.<name>`.

A benchmark backs a claim (`claims`): it keeps its section in benchmarks/measured, from which docs/measured/<room>.md is rendered
(`sections`), with the numbers of its sentinel (`sentinels`). `python -m benchmarks.claims` lists and checks what is claimed,
`python -m benchmarks.anew` measures all of it; runs of hours are kept in results/.

film        one contact at one instant: films, dry contacts, their errors and cost
stress      stress below the surface
surfaces    surfaces over hours
friction    friction of full films
regression  the regression level: errors, cost
thesis      the shipped cases against the thesis that they are from
machines    ball bearings, gear pairs, error of the coupling
coupling    the co-simulation master, importers of its machines
fmu         cost of a step
house       faults put into the code, arguments, the tables of docs/trust.md
models      small FMUs with exact solutions, for benchmarks and tests
hosts       programs that load FMUs, and importers of SSP, for benchmarks and tests

`pages`, `timing` and `folders` are shared by all rooms.
"""
