"""What `warm_up` has loaded, the first step of the scene finds."""

import json
import os
import subprocess
import sys
from functools import cache

import pytest

from contact_core import ConvergenceError, Scene, advance, initial_state, warm_up

SMALL = {"film.points": "33", "surface_1.correlation_length": "16 um", "surface_2.correlation_length": "16 um"}
ROLLING = {
    "operation.speed_1": "0.45 m/s",
    "operation.speed_2": "0.45 m/s",
    "heat": "field",
    "lubricant.flow": "local",
    "film.fft": "scipy",
}
AT_REST = {"operation.speed_1": "0 m/s", "operation.speed_2": "0 m/s"}

_PROCESS = """
import json, os, sys
from dataclasses import replace

from contact_core import Scene, advance, initial_state, warm_up


def kernels():
    modules = [module for name, module in sorted(sys.modules.items()) if name.startswith("contact_core.kernels.")]
    loaded = {f"{k.__module__}.{k.__name__}: {len(k.overloads)}"
              for module in modules for k in vars(module).values() if getattr(k, "overloads", None)}
    return sorted(loaded)


scene = Scene.from_toml(sys.argv[1], json.loads(sys.argv[2]))
threads = len(os.listdir("/proc/self/task"))
warm_up(scene)
print(json.dumps([threads, len(os.listdir("/proc/self/task"))]))
before, modules = kernels(), set(sys.modules)
point = replace(scene.operation.point, speed_1=0.5, speed_2=0.4)
state, _ = advance(scene, point, initial_state(scene), 0.0)
advance(scene, point, state, 1.0)
print(json.dumps([before, kernels(), sorted(set(sys.modules) - modules)]))
"""


@cache
def _run(name: str, **changes: str) -> tuple[list[int], list[str], list[str], list[str]]:
    """Numbers of threads before and after, kernels after `warm_up` and after a step, modules that the step loaded."""
    run = subprocess.run(
        [sys.executable, "-c", _PROCESS, name, json.dumps(changes)],
        capture_output=True,
        text=True,
        check=True,
        env=os.environ | {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"},
    )
    threads, (before, after, modules) = map(json.loads, run.stdout.splitlines())
    return threads, before, after, modules


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        pytest.param("mtm_zddp", {}, marks=pytest.mark.long),
        ("mtm_zddp", ROLLING),
        ("azam_case_a", AT_REST | {"surface_1.rq": "1 nm", "surface_2.rq": "1 nm"}),
    ],
)
def test_the_first_steps_find_every_kernel_and_module_loaded(name, changes):
    _, before, after, modules = _run(name, **SMALL | changes)
    assert len(before) > 15
    assert after == before
    assert not modules


def test_the_regression_level_is_warm_without_a_kernel():
    _, before, after, modules = _run("mtm_zddp", **{"film.model": "regression"})
    assert before == after == []
    assert not modules


@pytest.mark.skipif(sys.platform != "linux", reason="threads are counted in /proc")
def test_no_thread_is_started():
    (before, after), *_ = _run("mtm_zddp", **SMALL | ROLLING)
    assert before == after


def test_warming_up_changes_no_answer():
    scene = Scene.from_toml("mtm_zddp", SMALL)
    point, state = scene.operation.point, initial_state(scene)
    cold, _ = advance(scene, point, state, 0.0)
    warm_up(scene)
    warm, _ = advance(scene, point, state, 0.0)
    assert warm.to_bytes() == cold.to_bytes()


def test_a_contact_that_cannot_be_solved_is_left_to_its_own_step(monkeypatch):
    def unsolvable(*args, **kwargs):
        calls.append(args)
        raise ConvergenceError("no solution")

    calls = []
    monkeypatch.setattr("contact_core.deterministic.warming.solve_instant", unsolvable)
    warm_up(Scene.from_toml("mtm_zddp", SMALL))
    assert calls
