"""The same FMU under the same inputs gives the bits of the core in every importer, and in a host in C."""

import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from fmu_host import environment, unpacked
from imported_fmu import Fmu
from importers import IMPORTERS, PRINTED_DIGITS, STEP, STIMULI, UNUSABLE
from test_run import direct

from benchmarks.hosts.native_host import OK, NativeHost, plain_environment
from fmu_src.flavours import VERSIONS

pytestmark = pytest.mark.importers

KINDS = [(flavour, fmi) for flavour, versions in VERSIONS.items() for fmi in versions]
REFUSED = {  # by importer, and flavour or version of FMI
    ("fmuloader", "embedded"): "fmuloader asks for the functions of model exchange, which pythonfmu's binary lacks",
    ("pyfmi", "embedded"): "PyFMI refuses FMUs with needsExecutionTool=true",
    ("fmusim", "embedded"): "a program without Python cannot load pythonfmu's binary",
    ("pyfmi", 3): "PyFMI imports FMUs of FMI 3.0 for model exchange only",
    ("libcosimpy", 3): "libcosim knows FMI 1.0 and 2.0, and crashes on others",
}
INSTALLED = ("libcosimpy", "ecospy", "fmuloader", "fmu_manipulation_toolbox")
NAMED_BY = {
    "pyfmi": "TRIBOFMU_TEST_PYFMI",
    "fmusim": "TRIBOFMU_TEST_FMUSIM",
    "omsimulator": "TRIBOFMU_TEST_OMSIMULATOR",
}


@pytest.fixture(scope="module", params=KINDS, ids=lambda kind: f"{kind[0]}-{kind[1]}")
def kind(request):
    """Flavour and version of FMI."""
    return request.param


@pytest.fixture(scope="module")
def file(kind, scene, quick, built):
    flavour, fmi = kind
    if flavour == "native":
        return built.fmu(quick, flavour, fmi=fmi, here=True)
    return built.fmu(scene, flavour, fmi=fmi)


@pytest.fixture(scope="session")
def of_the_core(scene):
    """Outputs after each step, from the core itself."""
    rows, _ = direct(scene, [(STEP, inputs) for inputs in STIMULI])
    return rows[1:]


@pytest.fixture(scope="module")
def expected(kind, file, of_the_core):
    """Real outputs after each step. C rounds otherwise than Python does: its bits are those of the first importer."""
    fmu = Fmu.read(file)
    if kind[0] == "native":
        found = [[value.hex() for value in row] for row in IMPORTERS["fmpy"](fmu)]
    else:
        found = [[row[name] for name in fmu.outputs] for row in of_the_core]
    assert len({tuple(row) for row in found}) == len(STIMULI)
    return found


def printed(value: str, digits: int | None) -> str:
    """The number that remains after an importer has printed it with so many digits."""
    return value if digits is None else float(f"{float.fromhex(value):.{digits}g}").hex()


@pytest.mark.parametrize("importer", IMPORTERS)
def test_every_importer_gives_the_same_bits(importer, kind, file, expected, request):
    for why in filter(None, (REFUSED.get((importer, which)) for which in kind)):
        request.applymarker(pytest.mark.xfail(strict=True, reason=why))
    if importer in INSTALLED and importlib.util.find_spec(importer) is None:
        pytest.skip(f"{importer} is not installed")
    script = Path(__file__).with_name("importers.py")
    python = (importer == "pyfmi" and os.environ.get(NAMED_BY["pyfmi"])) or sys.executable
    run = subprocess.run(
        [python, str(script), importer, str(file)],
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


def test_a_host_in_c_gives_the_same_bits(native_program, kind, file, expected, tmp_path, request):
    embedded = kind[0] == "embedded"
    surroundings = request.getfixturevalue("embedding") if embedded else plain_environment()
    host = NativeHost(native_program, surroundings)
    instance = host.load(unpacked(file, tmp_path / "small")).instance()
    assert instance.initialise() == [OK, OK, OK]
    rows = []
    for inputs in STIMULI:
        assert instance.step(STEP, **inputs) == OK
        rows.append([value.hex() for value in instance.outputs().values() if isinstance(value, float)])
    instance.free()
    host.close()
    assert {status for _, status, _, _ in instance.log} <= {OK}
    assert rows == expected
