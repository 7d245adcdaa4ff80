"""Measurements of accuracy and cost. Run from the root of the source tree: `python -m benchmarks.<room>.<name>`.

A benchmark writes the page docs/measured/<room>/<name>.md; long ones keep their runs in results/.

film        one contact at one instant: films, dry contacts, their errors and cost
stress      stress below the surface
surfaces    surfaces over hours: tribofilm, wear, roughness, Stribeck curves
friction    traction curves, cost of the laws
regression  the regression level: fit, errors, cost
thesis      the shipped cases against the thesis that they are from
machines    ball bearings, gear pairs, the test rig
coupling    the co-simulation master, other masters and importers
fmu         cost of a step, memory, lost processes
house       faults put into the code, numbers of two revisions (`golden.py`), arguments, docs/how_good.md, stale pages
models      small FMUs with exact solutions, for benchmarks and tests
hosts       programs that load FMUs, and importers of SSP, for benchmarks and tests

`pages`, `timing` and `folders` are shared by all rooms. `dependencies` declares what each page depends on and what its
command is; `digests` reads sources without their wording; `python -m benchmarks.house.pages` lists pages of older sources.
"""
