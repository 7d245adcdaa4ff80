"""Errors that the regression level states, against the deterministic level on contacts that no curve was fitted to."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from comparison import approx

from contact_core import OperatingPoint, RangeFlag, Scene, advance, initial_state
from contact_core.state import Mean

# random contacts within the fit, beyond it, and rubbed for ten minutes, by the deterministic level
GOLDEN = Path(__file__).parent.parent / "golden" / "regression_level.json"
# tribofilms of circles within the fit, after the seconds said with it, from new surfaces: each as `advance` has it
TRIBOFILMS = GOLDEN.with_name("regression_level_tribofilms.json")
# wear is in proportion to the load on the solids
ERRORS = {"friction_coefficient": "error_friction", "h_c": "error_film", "contact_load_ratio": "error_wear"}
UNKNOWN = 1e3  # of wear: nobody knows


@pytest.fixture(scope="module")
def rows():
    """The contacts by name."""
    return json.loads(GOLDEN.read_text(encoding="utf-8"))


def scene_of(row):
    return Scene.from_toml(row["scene"], {key: str(value) for key, value in row["changes"].items()})


def fast(row):
    """The scene at the regression level, and its outputs."""
    scene = scene_of(row).at_level("regression")
    state = initial_state(scene)
    if row["means"]:
        state = replace(state, means=tuple(Mean(**mean) for mean in row["means"]))
    return scene, advance(scene, OperatingPoint(**row["point"]), state, 0.0)[1]


@pytest.fixture(scope="module")
def compared(rows):
    """Of each group and output: deviations of the deterministic level over the stated errors."""
    found = {}
    for name, row in rows.items():
        (_, outputs), group = fast(row), name.partition(" ")[0]
        outside = bool(outputs.range_flags & RangeFlag.OUTSIDE_FIT)
        assert outside or group != "beyond", name
        group = "beyond" if outside else group
        for output, error in ERRORS.items():
            stated, mine = getattr(outputs, error), getattr(outputs, output)
            if stated < UNKNOWN:
                ratio = abs(row["truth"][output] / mine - 1.0) / stated
                found.setdefault((group, output), []).append(ratio)
    return found


@pytest.mark.parametrize("name", ["beyond line 3", pytest.param("beyond circle 4", marks=pytest.mark.long)])
def test_the_deterministic_level_still_says_what_is_stored(rows, name):
    scene, row = scene_of(rows[name]), rows[name]
    _, outputs = advance(scene, OperatingPoint(**row["point"]), initial_state(scene), 0.0)
    for output in ERRORS:
        least = 1e-3 if output == "contact_load_ratio" else 0.0  # a contact of two nodes more or less
        assert getattr(outputs, output) == approx(row["truth"][output], rel=0.02, abs=least), output


def of_group(compared, group):
    return np.concatenate([ratios for (name, _), ratios in compared.items() if name == group])


def of_output(compared, output):
    return np.concatenate([ratios for (_, name), ratios in compared.items() if name == output])


@pytest.mark.parametrize("output", ERRORS)
def test_stated_errors_cover_nine_in_ten_and_neither_half_nor_a_tenth_of_them_would(compared, output):
    ratios = of_output(compared, output)
    assert ratios.size > 20
    assert (ratios <= 1.0).mean() >= 0.9
    assert (ratios <= 0.5).mean() < 0.9
    assert (ratios <= 0.1).mean() < 0.4


def test_beyond_the_fit_errors_are_as_wide_as_they_have_to_be(compared):
    ratios = of_group(compared, "beyond")
    assert (ratios <= 1.0).mean() >= 0.9
    assert (ratios <= 0.2).mean() < 0.8


def test_lines_that_have_rubbed_are_covered_and_errors_of_fresh_ones_would_not_do(compared):
    """Of circles that have rubbed only half are, lines and ellipses all."""
    ratios = of_group(compared, "rubbed")
    assert (ratios <= 1.0).mean() >= 0.9
    assert (ratios <= 1.0 / 3.0).mean() < 0.85


def test_tribofilms_of_circles_are_covered_and_a_tenth_of_the_error_would_not_do():
    ratios = {}
    for name, row in json.loads(TRIBOFILMS.read_text(encoding="utf-8")).items():
        scene = scene_of(row).at_level("regression")
        assert not scene.tribofilm.abrades
        _, found = advance(scene, OperatingPoint(**row["point"]), initial_state(scene), row["seconds"])
        assert not found.range_flags & ~RangeFlag.UNSURE
        for body in ("tribofilm_1", "tribofilm_2"):
            off = abs(row["truth"][body] / getattr(found, body) - 1.0)
            ratios.setdefault(body, {})[name] = off / getattr(found, f"error_{body}")
    both = np.array([list(found.values()) for found in ratios.values()])
    assert both.max() <= 1.0
    assert both.max() > 0.1


@pytest.mark.parametrize("scene", ["azam_case_a", "mtm_zddp"])
def test_tribofilms_of_two_hours_are_those_of_the_deterministic_level(scene):
    rows = json.loads(TRIBOFILMS.read_text(encoding="utf-8"))
    hours = [row for name, row in rows.items() if name.startswith(f"{scene} shipped")]
    assert max(row["seconds"] for row in hours) == 7200.0
    for row in hours:
        scene = scene_of(row).at_level("regression")
        _, found = advance(scene, OperatingPoint(**row["point"]), initial_state(scene), row["seconds"])
        for body in ("tribofilm_1", "tribofilm_2"):
            film = row["truth"][body]
            assert getattr(found, body) == approx(film, rel=0.27), (body, row["seconds"])


def test_tribofilms_of_lines_are_covered_and_a_tenth_of_the_error_would_not_do(rows):
    """Their exposures are those of circles. The films of ten minutes are the means with which rubbed lines begin."""
    ratios = []
    for row in (row for name, row in rows.items() if name.startswith("rubbed line")):
        scene = scene_of(row).at_level("regression")
        _, found = advance(scene, OperatingPoint(**row["point"]), initial_state(scene), 600.0)
        films = [max(mean["growth"] - mean["removal"], 0.0) for mean in row["means"]]
        own = (found.tribofilm_1, found.error_tribofilm_1), (found.tribofilm_2, found.error_tribofilm_2)
        ratios.append(max(abs(film / mine - 1.0) / error for film, (mine, error) in zip(films, own, strict=True)))
    assert max(ratios) <= 1.0
    assert max(ratios) > 0.1


def test_the_oil_of_lines_within_the_fit_rubs_as_much_as_it_should_on_average(rows):
    """Friction over the load that the oil carries. Of lines it hangs on how far above Hertz's pressure the oil does."""
    off = []
    for name, row in rows.items():
        share, load = row["truth"]["contact_load_ratio"], row["point"]["load"]
        if not name.startswith("fresh line") or share > 0.6:
            continue
        scene, outputs = fast(row)
        if outputs.range_flags & RangeFlag.OUTSIDE_FIT or outputs.error_friction > 1.0:  # next to no friction
            continue
        oil = row["truth"]["friction_coefficient"] - scene.boundary_friction.bare * share
        mine = abs(outputs.friction_fluid) / (1.0 - outputs.contact_load_ratio) / load
        off.append(np.log(mine / (oil / (1.0 - share))))
    assert len(off) > 4
    assert abs(np.mean(off)) < 0.15
    assert np.abs(off).max() < np.log(2.0)


@pytest.mark.parametrize(
    "pause", [{"speed_1": 0.1, "speed_2": 0.1}, {"load": 0.0}, {"speed_1": 3.0, "speed_2": 2.9}], ids=str
)
def test_a_second_at_another_point_does_not_change_the_errors_of_what_has_grown_and_worn(pause):
    scene = Scene.from_toml("mtm_zddp").at_level("regression")
    state, long = advance(scene, scene.operation.point, initial_state(scene), 1200.0)
    _, after = advance(scene, replace(scene.operation.point, **pause), state, 1.0)
    assert long.error_wear > 0.1
    for name in ("error_wear", "error_tribofilm_1", "error_tribofilm_2"):
        assert getattr(after, name) == approx(getattr(long, name), rel=0.02), name


def test_bodies_that_roll_have_errors_of_film_and_load_and_none_of_friction():
    scene = Scene.from_toml("mtm_zddp").at_level("regression")
    point, state = replace(scene.operation.point, speed_1=0.1, speed_2=0.1), initial_state(scene)
    _, rolling = advance(scene, point, state, 0.0)
    _, sliding = advance(scene, replace(point, speed_2=0.1 + 1e-9), state, 0.0)
    assert rolling.friction_force == rolling.error_friction == 0.0
    for name in ("error_film", "error_load_ratio"):
        assert getattr(sliding, name) > 0.05, name
        assert getattr(rolling, name) == approx(getattr(sliding, name), rel=1e-6), name


def test_nothing_is_known_of_the_gap_of_bodies_without_load():
    scene = Scene.from_toml("mtm_zddp").at_level("regression")
    _, found = advance(scene, replace(scene.operation.point, load=0.0), initial_state(scene), 0.0)
    assert found.error_film == 1.0
    assert found.range_flags & RangeFlag.UNSURE
