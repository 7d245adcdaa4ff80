"""An .ssp or .fmu file in OMSimulator: python -m benchmarks.hosts.omsimulator FILE STOP_TIME [VARIABLE ...]

Prints the last row of the result, of the named variables or of all. Run it by hand, where OMSimulator is installed: its
executable is the one that OMSIMULATOR names, or `OMSimulator` on PATH. FMUs need TRIBOFMU_PYTHON or a python3 on PATH
with tribofmu. The step size of an .ssp file is that of its annotation, the one proposed when it was written.
"""

import csv
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from shutil import which


def program() -> str | None:
    """The executable, if there is one."""
    return which(os.environ.get("OMSIMULATOR", "OMSimulator"))


def last_row(file: str | Path, stop_time: float) -> dict[str, float]:
    """Every number at the end of a simulation. Raises RuntimeError with the log if OMSimulator reports an error."""
    executable = program()
    if executable is None:
        raise RuntimeError("There is no OMSimulator: name its executable in OMSIMULATOR.")
    with tempfile.TemporaryDirectory(prefix="omsimulator-") as folder:
        result = Path(folder, "result.csv")
        call = [
            executable,
            "--mode=cs",
            f"--stopTime={stop_time!r}",
            f"--resultFile={result}",
            str(Path(file).absolute()),
        ]
        run = subprocess.run(call, cwd=folder, capture_output=True, text=True)
        log = run.stdout + run.stderr
        if run.returncode or "error:" in log or not result.exists():
            raise RuntimeError(log[-4000:])
        with result.open(newline="") as table:
            names, *_, last = csv.reader(table)
    return dict(zip(names, map(float, last), strict=True))


def end_values(file: str | Path, stop_time: float, names: list[str]) -> list[float]:
    """Return the values of "component.variable" or "variable" at the end of a simulation, with any prefix of OMSimulator."""
    row = last_row(file, stop_time)
    found = {name: [value for key, value in row.items() if f".{key}".endswith(f".{name}")] for name in names}
    for name, values in found.items():
        if len(values) != 1:
            raise RuntimeError(f"'{name}' names {len(values)} variables of OMSimulator's result, not one.")
    return [values[0] for values in found.values()]


if __name__ == "__main__":
    source, until, *chosen = sys.argv[1:]
    wanted = dict(zip(chosen, end_values(source, float(until), chosen), strict=True))
    print(json.dumps(wanted if chosen else last_row(source, float(until)), indent=1))
