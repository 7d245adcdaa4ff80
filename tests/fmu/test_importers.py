"""The same FMU under the same inputs gives the bits of the core in every importer, and in a host in C."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from fmu_host import environment
from importers import IMPORTERS, STEP, STIMULI, UNUSABLE, real_outputs
from native_host import OK, NativeHost
from test_run import direct


@pytest.fixture(scope="session")
def expected(scene, fmu_file):
    """Real outputs after each step, from the core itself."""
    rows, _ = direct(scene, [(STEP, inputs) for inputs in STIMULI])
    found = [[row[name] for name in real_outputs(str(fmu_file))] for row in rows[1:]]
    assert len({tuple(row) for row in found}) == len(STIMULI)
    return found


@pytest.mark.parametrize("importer", IMPORTERS)
def test_every_importer_gives_the_same_bits(importer, flavour, flavoured_file, expected, request):
    if (importer, flavour) == ("fmuloader", "embedded"):
        reason = "fmuloader asks for the functions of model exchange, which pythonfmu's binary does not have"
        request.applymarker(pytest.mark.xfail(strict=True, reason=reason))
    script = Path(__file__).with_name("importers.py")
    run = subprocess.run(
        [sys.executable, str(script), importer, str(flavoured_file)],
        capture_output=True,
        text=True,
        env=environment() | {"TRIBOFMU_PYTHON": sys.executable},
    )
    if run.returncode == UNUSABLE:
        pytest.skip(f"{importer}: {run.stderr.strip()}")
    assert run.stdout, run.stderr[-2000:]
    assert json.loads(run.stdout.splitlines()[-1]) == expected  # libcosim logs to stdout
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
