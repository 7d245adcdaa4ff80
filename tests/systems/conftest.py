"""A contact on a coarse grid, its FMU, and a short run of it through a duty with steps; small FMUs with a defect."""

import sys
from collections.abc import Callable, Iterator
from contextlib import nullcontext
from pathlib import Path
from typing import IO, Any

import pytest
import xarray as xr
from built import Built
from checking import SLAVE, edited, replaced
from matplotlib.figure import Figure
from parsed_page import GEARS
from pythonfmu.builder import FmuBuilder

from contact_core import Scene
from fmu_src.native import build as native_build
from system_models.cli.main import main
from system_models.run.contact import run
from system_models.run.duty import Duty

COARSE = {
    "film.points": "17",
    "surface_1.correlation_length": "32 um",
    "surface_2.correlation_length": "32 um",
    "operation.duration": "0.02 h",
    "operation.interval": "30 s",
}
STEPS = "time [s],load [N],temperature [degC]\n0,53.7,80\n40,30,82\n"
RENDERING = Figure.savefig


def unrendered(figure: Figure, file: str | Path | IO[bytes], **options: Any) -> None:
    """Write the begin of a picture."""
    with nullcontext(file) if hasattr(file, "write") else Path(file).open("wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n")


@pytest.fixture(scope="module", autouse=True)
def _pictures_are_drawn_and_not_rendered() -> Iterator[None]:
    """Rendering is half of the time of a short run; tests of pictures ask for `rendered`."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Figure, "savefig", unrendered)
        yield


@pytest.fixture
def rendered(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let pictures be rendered."""
    monkeypatch.setattr(Figure, "savefig", RENDERING)


@pytest.fixture(params=["drawn", pytest.param("rendered", marks=pytest.mark.long)])
def drawn(request: pytest.FixtureRequest) -> bool:
    """True if pictures are rendered, too."""
    rendering = request.param == "rendered"
    if rendering:
        request.getfixturevalue("rendered")
    return rendering


@pytest.fixture(scope="session")
def scene() -> Scene:
    return Scene.from_toml("mtm_zddp", COARSE)


@pytest.fixture(scope="session")
def fine() -> Scene:
    """The same on a grid of half the spacing."""
    finer = {"film.points": "33"} | {f"surface_{body}.correlation_length": "16 um" for body in (1, 2)}
    return Scene.from_toml("mtm_zddp", COARSE | finer)


@pytest.fixture(scope="session")
def duty(scene: Scene, tmp_path_factory: pytest.TempPathFactory) -> Duty:
    table = tmp_path_factory.mktemp("duty") / "steps.csv"
    table.write_text(STEPS)
    return Duty.from_csv(table, scene.operation.point)


@pytest.fixture(scope="session")
def fmu(scene: Scene, built: Built) -> Path:
    return built.fmu(scene, "embedded")


@pytest.fixture(scope="session")
def dataset(fmu: Path, scene: Scene, duty: Duty) -> xr.Dataset:
    return run(fmu, duty, scene.operation.duration, scene.operation.interval)


@pytest.fixture(scope="session")
def gears(built: Built) -> Path:
    """The folder of the results of a short run of gears."""

    def make(folder: Path) -> None:
        assert main([*GEARS, "--out", str(folder)]) == 0

    return built.folder(GEARS, make)


@pytest.fixture
def unoptimised(monkeypatch: pytest.MonkeyPatch) -> None:
    """Compile native FMUs for this platform alone and quickly."""
    compiler = "gcc" if native_build.available("gcc") else "cc"
    monkeypatch.setattr(native_build, "default_compiler", lambda: compiler)
    monkeypatch.setattr(native_build, "FLAGS", tuple(flag for flag in native_build.FLAGS if flag != "-O2"))


@pytest.fixture
def coarse() -> list[str]:
    """The same contact on the command line."""
    return [part for key, value in COARSE.items() for part in ("--set", f"{key}={value}")]


@pytest.fixture
def slave(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Path]:
    """A small FMU, an integrator of its input u from -2 to 10, with a defect."""
    monkeypatch.setattr(sys, "path", [*sys.path])

    def make(name: str, step: str = "pass", start: str = "pass", body: str = "pass") -> Path:
        script = tmp_path / f"{name}.py"
        script.write_text(SLAVE.format(name=name, step=step, start=start, body=body))
        states = {"canGetAndSetFMUstate": True, "canSerializeFMUstate": True}
        fmu = FmuBuilder.build_FMU(script, tmp_path / f"{name}_plain.fmu", **states)
        ranged = replaced('<Real start="1.5"', '<Real start="1.5" min="-2" max="10"')
        independent = replaced('(<Outputs>\\s*<Unknown index="3")', r'\1 dependencies=""')
        return edited(fmu, tmp_path / f"{name}.fmu", lambda text: independent(ranged(text)))

    return make
