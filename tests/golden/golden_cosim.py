"""Commands that simulate: the co-simulation of docs/how-to/cosim.md, runs of scenes, Stribeck curves."""

import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

from golden_command import command, put_results, settings
from golden_laws import LINE, SMALL
from golden_record import Record

BLOCK = '''"""A mass on a spring and a damper, pulled by a force."""

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real


class Block(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.m, self.k, self.d = 0.5, 20e3, 20.0
        self.force = self.x = self.v = 0.0
        for name in ("m", "k", "d"):
            self.register_variable(Real(name, causality=Fmi2Causality.parameter, variability=Fmi2Variability.fixed))
        self.register_variable(Real("force", causality=Fmi2Causality.input))
        for name in ("x", "v"):
            self.register_variable(Real(name, causality=Fmi2Causality.output))

    def do_step(self, time, size):
        for _ in range(20):
            self.v += size / 20 * (self.force - self.k * self.x - self.d * self.v) / self.m
            self.x += size / 20 * self.v
        return True
'''
RIG = """
[fmus]
block = "Block.fmu"
contact = "contact.fmu"

[coupling]
connections = [["block.v", "contact.speed_1"], ["contact.friction_force", "block.force"]]
bonds = [["contact.friction_force", "block.v"]]

[parameters]
block.m = 0.4
contact.speed_2 = 0.1

[schedule]
contact.load = [[0, 50.0], ["50 ms", 30.0]]

[simulate]
stop_time = 0.1
step_size = "0.5 ms"
"""
FAST_LINE = {key: value for key, value in LINE.items() if key != "film.tolerance"} | {"film.model": "regression"}
WAYS = {
    "Jacobi": [],
    "Gauss-Seidel, order 2": ["simulate.algorithm=gauss_seidel", "simulate.order=2"],
    "quasi-Newton": ["simulate.iterate=quasi_newton", "simulate.order=1"],
    "a tolerance": ["simulate.tolerance=1e-3", "simulate.order=1"],
}
STEPS = "time [s],load [N],temperature [degC]\n0,{load},{warm}\n15,{less},{warm}\n30,{less},{warmer}\n"


def runs(before: Any) -> Iterator[tuple[str, Callable[[Record], None]]]:
    """Return the names and functions of all runs."""
    for flavour in ("embedded", "isolated"):
        for way in WAYS if flavour == "embedded" else ["Gauss-Seidel, order 2"]:
            yield f"cosim of docs/cosim.md, {flavour}, {way}", partial(_cosim, flavour, way)
    yield "cosim with a deterministic contact", _deterministic
    for name in ("azam_case_a", "ball_209_inner", "fzg_flank", "mtm_zddp"):
        yield f"run {name}", partial(_run, name)
    yield "stribeck mtm_zddp", partial(_stribeck, "mtm_zddp", SMALL)
    yield "stribeck fzg_flank, regression", partial(_stribeck, "fzg_flank", FAST_LINE)


def _rig(folder: Path, flavour: str, **more: str) -> None:
    folder.mkdir(exist_ok=True)
    (folder / "block.py").write_text(BLOCK, encoding="utf-8")
    (folder / "rig.toml").write_text(RIG, encoding="utf-8")
    build = [sys.executable, "-m", "pythonfmu", "build", "-f", "block.py", "--handle-state", "--serialize-state"]
    subprocess.run(build, cwd=folder, check=True, capture_output=True)
    python = ["--python"] if flavour == "isolated" else []
    words = ("build", "mtm_zddp", "--flavour", flavour, *python, "--out", str(folder / "contact.fmu"))
    command(*words, "--set", *(f"{key}={value}" for key, value in more.items()))


def _cosim(flavour: str, way: str, record: Record) -> None:
    folder = Path(flavour)
    if not folder.exists():
        _rig(folder, flavour, **{"film.model": "regression"})
    changes = ["--set", *WAYS[way]] if WAYS[way] else []
    done = command("cosim", str(folder / "rig.toml"), "--out", "cosim", *changes, fine=(0, 1))
    record.put("exit code", done.returncode)
    put_results(record, Path("cosim"))


def _deterministic(record: Record) -> None:
    folder = Path("deterministic")
    _rig(folder, "embedded", **SMALL)
    short = ["--set", "simulate.stop_time=0.03", "simulate.step_size=2 ms", "simulate.algorithm=gauss_seidel"]
    done = command("cosim", str(folder / "rig.toml"), "--out", "cosim", *short, fine=(0, 1))
    record.put("exit code", done.returncode)
    put_results(record, Path("cosim"))


def _run(name: str, record: Record) -> None:
    """A scene through a duty with steps."""
    load, warm = {"mtm_zddp": (53.7, 80), "azam_case_a": (77.85, 90), "fzg_flank": (4000, 90)}.get(name, (300, 90))
    text = STEPS.format(load=load, less=0.7 * load, warm=warm, warmer=warm + 2)
    Path("steps.csv").write_text(text, encoding="utf-8")
    coarse = {"mtm_zddp": SMALL, "azam_case_a": SMALL, "fzg_flank": LINE}.get(name, {"film.points": "33"})
    changes = settings(_=coarse | {"operation.interval": "5 s"})
    done = command("run", name, "--hours", "0.0125", "--duty", "steps.csv", "--out", name, *changes, fine=(0, 1))
    record.put("exit code", done.returncode)
    put_results(record, Path(name))


def _stribeck(name: str, overrides: dict[str, str], record: Record) -> None:
    words = ("stribeck", name, "--times", "0,0.5", "--points", "4", "--fastest", "2", "--slowest", "0.01")
    done = command(*words, "--out", f"stribeck_{name}", *settings(_=overrides), fine=(0, 1))
    record.put("exit code", done.returncode)
    put_results(record, Path(f"stribeck_{name}"), ("stribeck",))
