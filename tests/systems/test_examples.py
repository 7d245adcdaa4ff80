"""Each script of docs/examples runs as it stands, and what it finds agrees with something that it did not use."""

import math
import re
import runpy
import shutil
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
from comparison import approx

from contact_core import Scene, advance, initial_state

FOLDER = Path(__file__).parents[2] / "docs" / "examples"
STEEL = 230.47e9  # Pa, reduced modulus of the set "steel"
Example = Callable[[str], dict[str, Any]]


@pytest.fixture
def example(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Example]:
    """Yield a function that runs a script in an empty folder and returns its names."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [*sys.path])  # pythonfmu adds to it

    def run(name: str) -> dict[str, Any]:
        script = Path(shutil.copy(FOLDER / f"{name}.py", tmp_path))
        names = runpy.run_path(str(script), run_name="__main__")
        assert script.with_suffix(".png").is_file()
        return names

    yield run
    plt.close("all")


def hamrock_dowson(load: float, radius: float, speed: float, viscosity: float, alpha: float, modulus: float) -> float:
    """Return the central film [m] of a circular contact, J. Lubr. Technol. 99 (1977) 264."""
    u, g, w = viscosity * speed / (modulus * radius), alpha * modulus, load / (modulus * radius**2)
    return 2.69 * radius * u**0.67 * g**0.53 * w**-0.067 * (1.0 - 0.61 * math.exp(-0.73))


def test_every_example_is_on_the_page_with_its_picture_and_is_tested() -> None:
    scripts = {path.stem for path in FOLDER.glob("*.py")}
    page = FOLDER.with_suffix(".md").read_text("utf-8")
    assert len(scripts) >= 12
    assert set(re.findall(r"\]\(examples/(\w+)\.py\)", page)) == scripts
    assert set(re.findall(r"\]\(examples/(\w+)\.png\)", page)) == scripts
    assert {path.stem for path in FOLDER.glob("*.png")} == scripts
    assert scripts <= {name.removeprefix("test_") for name in globals()}


@pytest.mark.parametrize("path", sorted(FOLDER.glob("*.py")), ids=lambda path: path.stem)
def test_an_example_is_short_and_uses_no_private_name(path: Path) -> None:
    text = path.read_text("utf-8")
    assert len(text.splitlines()) <= 60
    assert not re.search(r"\b(?:import|from) [\w.]*\b_\w|\w\._[a-z]", text)


def test_point_contact(example: Example) -> None:
    """Pressure of Hertz, film of Hamrock and Dowson, thinnest at the sides."""
    contact = example("point_contact")["contact"]
    half_width = (1.5 * 50.0 * 0.01 / 230e9) ** (1.0 / 3.0)
    assert contact.pressure_max == approx(1.5 * 50.0 / (math.pi * half_width**2), rel=0.03)
    film = hamrock_dowson(50.0, 0.01, 0.5, 0.01, 18e-9, 230e9)
    assert 0.8 * film < contact.h_central < film  # which is up to a fifth thicker than solutions
    row, column = np.unravel_index(contact.film.argmin(), contact.film.shape)
    assert abs(contact.y[row]) > 0.6 * half_width > abs(contact.x[column])


@pytest.mark.long
def test_roller_ends(example: Example) -> None:
    """Hertz's line in the middle; the cylinder rises at its ends, Lundberg's profile and the measured one do not."""
    names = example("roller_ends")
    crowned, measured, straight = names["found"].values()
    hertz = math.sqrt(300e3 * 230e9 / (2.0 * math.pi * 8e-3))
    assert names["long_line"].pressure_max == approx(hertz, rel=0.05)
    assert crowned.pressure_max < 1.15 * hertz
    assert measured.pressure_max < 1.3 * hertz
    assert straight.pressure_max > 2.0 * hertz
    assert abs(straight.y[straight.pressure.max(axis=1).argmax()]) == approx(2e-3, rel=0.05)


def test_dry_contact(example: Example) -> None:
    """Between the theories of Persson and of Bush, Gibson and Thomas, which bound solutions of others."""
    kappa = example("dry_contact")["kappa"]
    assert math.sqrt(8.0 / math.pi) < kappa.min() < kappa.max() < math.sqrt(2.0 * math.pi)


def test_stress_below(example: Example) -> None:
    """0.62 p_H at 0.48 a below Hertz's circle (Johnson 1985, section 3.4); friction brings it to the surface."""
    names = example("stress_below")
    assert names["largest"][0.0] == approx(0.62, rel=0.01)
    assert names["where"][0.0] == approx(0.48, rel=0.1)
    assert names["where"][0.4] < 0.05


def test_dimple(example: Example) -> None:
    """The film is that of Hamrock and Dowson but where the dimple is, which moves with the oil."""
    names = example("dimple")
    film = hamrock_dowson(15.0, 12.5e-3, 0.09, 0.25, 22e-9, 110e9)
    assert np.median([*names["middle"].values()]) == approx(1e9 * film, rel=0.1)
    passing = max(names["middle"], key=lambda time: names["middle"][time] if time > 0.5 else 0.0)
    assert passing == approx(1.0, abs=0.03)  # in the middle again after one passage of its patch
    assert 100.0 < names["middle"][passing] - 1e9 * film < 175.0  # its depth, less what the pressure flattens


def test_stribeck(example: Example) -> None:
    """Dry friction at the slow end; the film of Hamrock and Dowson at the fast one."""
    names = example("stribeck")
    assert 0.115 < names["friction"][0] < 0.13
    assert names["friction"][-1] < 0.03
    assert np.all(np.diff(names["share"]) < 0.0)
    film = hamrock_dowson(53.7, 9.525e-3, 10.0, 4e-3, 14.94e-9, STEEL)
    assert 0.8 * film < names["film"][-1] < film  # which is up to a fifth thicker than solutions


def test_traction(example: Example) -> None:
    """The mean stress rises over the logarithm of the slip by Eyring's 5 MPa, less where it flows as a liquid yet."""
    names = example("traction")
    pressure, curve = max(names["curves"].items())
    middle = slice(8, 17)
    slope = np.polyfit(np.log(names["ratios"][middle]), curve[middle], 1)[0] * pressure * 1e9 / 1.5
    assert 0.7 * 5e6 < slope < 5e6
    least = min(names["curves"].items())[1]
    assert least[1] / least[0] == approx(names["ratios"][1] / names["ratios"][0], rel=0.03)  # Newtonian


def test_zddp(example: Example) -> None:
    """Archard's depth without the additive; less than half of it with a film."""
    runs = example("zddp")["runs"]
    row, load, time = runs["without"][60], 53.7, 3600.0
    width = 2.0 * (1.5 * load * 9.525e-3 / STEEL) ** (1.0 / 3.0)
    volume = 1e-5 * load * runs["without"][0].contact_load_ratio * 0.005 * time / 6e9
    assert row.wear_depth_1 == approx(volume / (width * 59.847e-3), rel=0.05)
    assert runs["ZDDP"][-1].wear_depth_1 < 0.5 * runs["without"][-1].wear_depth_1
    assert 20e-9 < runs["ZDDP"][-1].tribofilm_2 < 200e-9
    assert runs["without"][-1].tribofilm_2 == 0.0


def test_laws(example: Example) -> None:
    """Less oil, more on the solids; a tribofilm that wears first saves the steel; the ratio of ISO/TR 13989-1."""
    ends = example("laws")["ends"]
    shipped, layer = ends["as shipped"], ends["a layer of 5 nm of oil"]
    assert layer.h_c < shipped.h_c
    assert layer.contact_load_ratio > shipped.contact_load_ratio
    assert (
        ends["tribofilm wears first"].wear_depth_1 < 0.1 * shipped.wear_depth_1
    )  # K of the film: a tenth of the steel's
    hot = ends["scuffing"]
    assert hot.scuffing_ratio == approx((hot.contact_temperature_max - 353.15) / (152.0 - 80.0), rel=1e-9)
    damages = [ends[f"damage: {law}"].damage_2 for law in ("Dang Van", "Basquin", "Morrow")]
    assert 0.0 < max(damages) < 3.0 * min(damages)  # one steel's lives, in three forms


def test_own_law(example: Example) -> None:
    """The film forms in the inlet, where both oils are alike; friction under the pressure at which they differ."""
    names = example("own_law")
    barus, mine = names["found"]["Barus"], names["found"]["McEwen"]
    assert mine.h_c == approx(barus.h_c, rel=0.02)
    assert 0.6 < mine.friction_coefficient / barus.friction_coefficient < 0.85
    low, high = names["oils"]["McEwen"](np.array([0.0, 1e5]), np.full(2, 353.15))
    assert math.log(high / low) / 1e5 == approx(17.9e-9, rel=1e-3)


@pytest.mark.long
def test_bearing(example: Example) -> None:
    """Once warm, what friction gives goes to the surroundings; the largest ball load is near Stribeck's 5 F / z."""
    end = example("bearing")["run"].isel(time=-1)
    warm = 0.25 * (end["housing.temperature_inner"] - 293.15) + 0.75 * (end["housing.temperature_outer"] - 293.15)
    power = float(end["bearing.friction_torque"]) * 3000.0 * math.pi / 30.0
    assert power == approx(float(warm), rel=0.03)
    assert float(end["bearing.load_max"]) == approx(5.0 * 2000.0 / 9.0, rel=0.1)


@pytest.mark.long
def test_gear(example: Example) -> None:
    """One pair carries all in the middle of the path; it rolls without sliding at the pitch point."""
    names = example("gear")
    base = 0.5 * 16 * 4.5e-3 * math.cos(math.radians(20.0))
    assert names["load"].max() == approx(265.0 / base, rel=0.02)
    assert np.all(np.diff(names["sliding"]) > 0.0)
    tip = math.sqrt(41.23e-3**2 - base**2) - math.sqrt(36.6e-3**2 - base**2)  # from the pitch point to the pinion's tip
    end = 2250.0 * math.pi / 30.0 * (1.0 + 16.0 / 24.0) * tip
    assert 0.85 * end < names["sliding"][-1] < end  # in the middle of the last part of the path


def test_fmu(example: Example) -> None:
    """The FMU answers as the core does in one step."""
    names = example("fmu")
    result, scene = names["result"], names["scene"]
    assert result["valid"].all()
    point = replace(scene.operation.point, load=50.0)
    _, out = advance(scene, point, initial_state(scene), 0.5)
    assert result["friction_force"][1] == approx(out.friction_force, rel=1e-3)
    assert np.abs(result["friction_force"][100]) == approx(20.0 * result["friction_coefficient"][100], rel=1e-6)


def test_cosimulation(example: Example) -> None:
    """At rest the spring holds the friction; before, the block swings with its own frequency."""
    run = example("cosimulation")["run"].load()
    place, force = (run[name].values for name in ("block.x", "contact.friction_force"))
    assert 20e3 * place[-1] == approx(force[-1], rel=1e-3)
    time = run["time"].values
    early = (time > 0.02) & (time < 0.4)
    swing = place[early] - np.median(place[early])
    rises = time[early][1:][(swing[:-1] < 0.0) & (swing[1:] >= 0.0)]
    assert 1.0 / np.diff(rises).mean() == approx(math.sqrt(20e3 / 0.5) / (2.0 * math.pi), rel=0.05)


@pytest.mark.long
def test_sweep(example: Example) -> None:
    """A run of the sweep is that of the scene alone; a rougher disc gives the solids more, a higher load less."""
    end = example("sweep")["end"]
    share = end["contact_load_ratio"].transpose("operation.load", "surface_2.rq").values
    assert np.all(np.diff(share, axis=1) > 0.0)
    scene = Scene.from_toml("mtm_zddp", {"film.model": "regression", "operation.load": "80 N", "surface_2.rq": "30 nm"})
    _, out = advance(scene, scene.operation.point, initial_state(scene), 1.0)
    assert float(end["friction_coefficient"][-1, 0]) == approx(out.friction_coefficient, rel=1e-3)


def test_fit(example: Example) -> None:
    """The constants that made the data are found again."""
    fitted = example("fit")["fitted"]
    text = Path("results/fit/films.toml").read_text("utf-8")
    thickness = float(re.findall(r"full_thickness = \"([\d.e-]+) ?m\"", text)[0])
    energy = float(re.findall(r"activation_energy = \"([\d.e-]+) ?J\"", text)[0])
    assert thickness == approx(150e-9, rel=0.05)
    assert energy / 1.602176634e-19 == approx(0.79, rel=0.01)
    scatter = np.std([1e9 * (float(row["measured"]) - float(row["curve"])) for row in fitted])
    assert 2.0 < scatter < 5.0
