"""Other kernels of BLAS and other instructions of numba round differently: answers agree within part of an error."""

import json
import os
import subprocess
import sys

import llvmlite.binding
import pytest

KERNELS = {"Prescott": "sse3", "Haswell": "avx2", "SkylakeX": "avx512f"}  # of OpenBLAS; what a processor needs for them
SAME = {"Prescott": "Katmai"}  # the name under which OpenBLAS reports these kernels
SCRIPT = """
import ctypes, json
from pathlib import Path
import numpy, scipy.linalg
from contact_core import Scene, advance, initial_state, uncertainty

names = []
for package in (numpy, scipy):  # each carries an OpenBLAS of its own
    for file in Path(package.__file__).parent.with_name(package.__name__ + ".libs").glob("*openblas*"):
        library = ctypes.CDLL(str(file))
        for symbol in ("scipy_openblas_get_corename64_", "scipy_openblas_get_corename", "openblas_get_corename"):
            if hasattr(library, symbol):
                name = getattr(library, symbol)
                name.restype = ctypes.c_char_p
                names.append(name().decode())
                break
answers = {}
coarse = {"film.points": "33", "film.tolerance": "1e-2", "film.iterations": "60"}
waves = {f"surface_{i}.correlation_length": "16 um" for i in (1, 2)}
light = {"operation.load": "0.05 N"}  # by Newton's method, with its factorisation
for name, changes in (("azam_case_a", waves), ("azam_case_a", waves | light), ("mtm_zddp", waves)):
    scene = Scene.from_toml(name, coarse | changes)
    state, found = advance(scene, scene.operation.point, initial_state(scene), 0.1)
    errors = {key: error.together for key, error in uncertainty(scene, state).items()}
    answers[f"{name} {len(changes)}"] = {key: (getattr(found, key), error) for key, error in errors.items()}
print(json.dumps({"kernels": names, "answers": answers}))
"""


def answers(**environment):
    run = [sys.executable, "-c", SCRIPT]
    found = subprocess.run(run, env=os.environ | environment, capture_output=True, text=True, check=False)
    assert found.returncode == 0, found.stderr
    return json.loads(found.stdout)


@pytest.fixture(scope="module")
def own():
    return answers()


def agree(own, other):
    for scene, values in own["answers"].items():
        assert len(values) > 3
        for name, (value, error) in values.items():
            assert abs(other["answers"][scene][name][0] - value) <= 0.1 * error + 1e-9 * abs(value), (scene, name)


@pytest.mark.parametrize("kernels", ["Prescott", *(pytest.param(k, marks=pytest.mark.long) for k in list(KERNELS)[1:])])
def test_other_kernels_of_blas_give_the_same_within_part_of_the_error(kernels, own):
    if not llvmlite.binding.get_host_cpu_features().get(KERNELS[kernels]):
        pytest.skip(f"this processor has no {KERNELS[kernels]}, and OpenBLAS does not ask")
    if set(own["kernels"]) <= {kernels}:
        pytest.skip(f"these are its own kernels: {', '.join(own['kernels']) or 'no OpenBLAS was found'}")
    agree(own, answers(OPENBLAS_CORETYPE=kernels))


@pytest.mark.skipif("OPENBLAS_CORETYPE" not in os.environ, reason="OPENBLAS_CORETYPE is not set")
def test_the_kernels_that_the_environment_names_are_in_use(own):
    asked = os.environ["OPENBLAS_CORETYPE"]
    assert set(own["kernels"]) <= {asked, SAME.get(asked)}


@pytest.mark.long
def test_numba_without_this_processors_instructions_gives_the_same_within_part_of_the_error(tmp_path, own):
    agree(own, answers(NUMBA_CPU_NAME="generic", NUMBA_CACHE_DIR=str(tmp_path)))
