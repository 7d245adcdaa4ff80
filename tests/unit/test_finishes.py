"""Finishes of surfaces, the measured surfaces and the crown of a measured roller."""

import copy

import numpy as np
import pytest
from comparison import approx

from contact_core import Scene, SceneError
from contact_core.laws.profile import Measured
from contact_core.scene.finishes import FILE, ends_of_finish, finishes, values_of_finish
from contact_core.scene.toml import flat
from contact_core.scene.units import parse

BALL = {
    "geometry": {"radius_x": "9.525 mm"},
    "solids": {"set": "steel"},
    "surface_1": {"rq": "0 nm"},
    "lubricant": {"viscosity": {"viscosity_40": "46 mm2/s", "viscosity_100": "6.8 mm2/s", "density": "870 kg/m3"}},
    "operation": {"load": "50 N", "speed_1": "1.1 m/s", "speed_2": "0.9 m/s", "temperature": "60 degC"},
}


def with_surface(**keys):
    return Scene.from_dict(copy.deepcopy(BALL) | {"surface_2": keys})


def test_every_value_of_a_finish_has_a_source_or_is_assumed():
    lines = FILE.read_text("utf-8").splitlines()
    values = [line for line in lines if line.startswith(("rq", "correlation", "lay", "micro")) and "[" not in line]
    assert len(values) == 4 * len(finishes())
    assert all("  # " in line for line in values)


@pytest.mark.parametrize("name", finishes())
def test_a_finish_gives_roughness_above_and_below_the_grid_each_within_its_interval(name):
    scene, own = with_surface(finish=name), flat(values_of_finish(name))
    surface = scene.surface_2
    assert surface.rq == approx(parse(own["rq"], "m", "rq"))
    assert surface.microroughness.rms > 0.1 * parse(own["microroughness.rms"], "m", "rms")
    assert surface.microroughness.rms < surface.rq
    assert scene.warnings() == scene.doubts() == []
    given = {each.key: each for each in scene.intervals if each.key.startswith("surface_2")}
    assert given.keys() == {f"surface_2.{key}" for key in ("rq", "correlation_length", "microroughness.rms")}
    for key, (least, most) in ends_of_finish(name).items():
        assert least.startswith("-") and most.startswith("+"), f"{key} lies within its interval"


@pytest.mark.parametrize("name", finishes())
@pytest.mark.parametrize("length", ["2.5 um", "4 um", "30 um"])
def test_no_wave_of_a_finish_counts_twice_beside_a_length_of_the_scenes_own(name, length):
    scene = with_surface(finish=name, rq="50 nm", correlation_length=length)
    assert not [said for said in scene.warnings() if "count twice" in said]
    assert scene.surface_2.correlation_length == parse(length, "m", "length")


def test_what_is_shorter_goes_with_a_roughness_of_the_scenes_own_within_reason():
    below = {rq: with_surface(finish="ground", rq=rq, correlation_length="8 um").surface_2.microroughness.rms for rq in ("1 nm", "0.1 um", "5 um")}
    assert list(below.values()) == approx([10e-9, 20e-9, 160e-9])


def test_keys_beside_a_finish_win():
    layer = {"rms": "7 nm", "longest": "2 um"}
    surface = with_surface(finish="ground", rq="0.3 um", correlation_length="9 um", microroughness=layer).surface_2
    assert (surface.rq, surface.correlation_length) == approx((0.3e-6, 9e-6))
    assert (surface.microroughness.rms, surface.microroughness.longest) == approx((7e-9, 2e-6))


@pytest.mark.parametrize(("lay", "ratio"), [("along", 5.0), ("across", 0.2)])
def test_a_lay_stretches_roughness_along_it(lay, ratio):
    surface = with_surface(finish="ground", lay=lay).surface_2
    assert surface.correlation_length / surface.correlation_length_across == approx(ratio)


@pytest.mark.parametrize(
    ("surface", "said"),
    [
        ({"finish": "grinded"}, ("surface_2.finish: There is no finish 'grinded'", "Did you mean 'ground'?", "hobbed")),
        ({"finish": "ground", "lay": "acros"}, ("surface_2.lay = 'acros'", "Did you mean 'across'?")),
        ({"rq": "0.1 um", "lay": "along"}, ("surface_2.lay", "beside surface_2.finish")),
    ],
)
def test_what_no_finish_is_is_refused_with_the_way_out(surface, said):
    with pytest.raises(SceneError) as refused:
        with_surface(**surface)
    for part in said:
        assert part in str(refused.value)


def test_a_finish_is_listed_with_all_that_it_gives(tmp_path):
    path = tmp_path / "ball.toml"
    path.write_text(
        '[geometry]\nradius_x = "9.525 mm"\n[solids]\nset = "steel"\n[surface_1]\nrq = "0 nm"\n'
        '[surface_2]\nfinish = "Lapped"\n[lubricant.viscosity]\nviscosity_40 = "46 mm2/s"\nviscosity_100 = "6.8 mm2/s"\n'
        'density = "870 kg/m3"\n[operation]\nload = "50 N"\nspeed_1 = "1.1 m/s"\nspeed_2 = "0.9 m/s"\n'
        'temperature = "60 degC"\n'
    )
    listed = {each.key: each.value for each in Scene.read(path)[1] if each.key.startswith("surface_2")}
    assert listed["surface_2.finish"] == "lapped"
    assert {"rq", "correlation_length", "microroughness.rms", "microroughness.longest"} < {
        key.partition(".")[2] for key in listed
    }
    changed = Scene.read(path, {"surface_2.rq": "30 nm", "surface_2.finish": "ground"})[0].surface_2
    assert (changed.rq, changed.microroughness.rms) == approx((30e-9, 10e-9))


@pytest.mark.parametrize(("name", "rms"), [("nu206_raceway", 0.088e-6), ("nu206_roller", 0.095e-6)])
def test_measured_surfaces_have_their_roughness_on_the_grid_and_below_it(name, rms):
    scene = with_surface(set=name)
    assert scene.surface_2.rms == approx(rms, rel=0.01)
    assert scene.surface_2.microroughness.rms == approx(24e-9)
    assert scene.warnings() == []


def test_a_measured_roller_is_straight_in_its_middle_and_as_deep_at_its_ends_as_it_says():
    y = np.linspace(-5e-3, 5e-3, 101)
    drop = Measured(ends=13.2e-6).drop(y, 10e-3)
    assert drop[[0, -1]] == approx(13.2e-6)
    assert not drop[np.abs(y) <= 1.6e-3].any()
    assert (np.diff(drop[50:]) >= 0.0).all()
