"""The same FMU under the same inputs gives the bits of the core in every importer, and in a host in C."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from fmu_host import environment
from importers import IMPORTERS, PRINTED_DIGITS, STEP, STIMULI, UNUSABLE, real_outputs
from test_run import direct

from benchmarks.hosts.native_host import OK, NativeHost

EMBEDDED_REFUSED = {
    "fmuloader": "fmuloader asks for the functions of model exchange, which pythonfmu's binary does not have",
    "pyfmi": "PyFMI refuses FMUs with needsExecutionTool=true",
    "fmusim": "a program without Python cannot load pythonfmu's binary",
}
NAMED_BY = {"pyfmi": "TRIBOFMU_TEST_PYFMI", "fmusim": "TRIBOFMU_TEST_FMUSIM"}


@pytest.fixture(scope="session")
def expected(scene, fmu_file):
    """Real outputs after each step, from the core itself."""
    rows, _ = direct(scene, [(STEP, inputs) for inputs in STIMULI])
    found = [[row[name] for name in real_outputs(str(fmu_file))] for row in rows[1:]]
    assert len({tuple(row) for row in found}) == len(STIMULI)
    return found


def printed(value: str, digits: int | None) -> str:
    """The number that remains after an importer has printed it with so many digits."""
    return value if digits is None else float(f"{float.fromhex(value):.{digits}g}").hex()


@pytest.mark.parametrize("importer", IMPORTERS)
def test_every_importer_gives_the_same_bits(importer, flavour, flavoured_file, expected, request):
    if importer in EMBEDDED_REFUSED and flavour == "embedded":
        request.applymarker(pytest.mark.xfail(strict=True, reason=EMBEDDED_REFUSED[importer]))
    script = Path(__file__).with_name("importers.py")
    python = (importer == "pyfmi" and os.environ.get(NAMED_BY["pyfmi"])) or sys.executable
    run = subprocess.run(
        [python, str(script), importer, str(flavoured_file)],
        capture_output=True,
        text=True,
        env=environment() | {"TRIBOFMU_PYTHON": sys.executable},
    )
    variable = NAMED_BY.get(importer, "")
    if run.returncode == UNUSABLE and not os.environ.get(variable):
        pytest.skip(f"{importer}: {run.stderr.strip()}" + (f"; {variable} can name one" if variable else ""))
    assert run.stdout, run.stderr[-2000:]
    found = json.loads(run.stdout.splitlines()[-1])  # libcosim logs to stdout
    assert found == [[printed(value, PRINTED_DIGITS.get(importer)) for value in row] for row in expected]
    assert run.returncode == 0, run.stderr[-2000:]


def test_a_host_in_c_gives_the_same_bits(native_program, native_environment, flavoured_folder, expected):
    host = NativeHost(native_program, native_environment)
    instance = host.load(flavoured_folder).instance()
    assert instance.initialise() == [OK, OK, OK]
    rows = []
    for inputs in STIMULI:
        assert instance.step(STEP, **inputs) == OK
        rows.append([value.hex() for value in instance.outputs().values() if isinstance(value, float)])
    instance.free()
    host.close()
    assert {status for _, status, _, _ in instance.log} <= {OK}
    assert rows == expected
