"""contact.c of scenes with every law says what Python says."""

import re
import shutil
import sys

import pytest
from mapped_scene import mapped_scene

from benchmarks.fmu import native_scenes
from benchmarks.fmu.native_contact import NativeContact, bits, differences, tolerance
from contact_core import Scene
from contact_core.errors import SceneError
from fmu_src.native import files
from fmu_src.native.build import WARNINGS

pytestmark = [pytest.mark.fmu, pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")]

RUNS, STEPS = 4, 8
ZIG = (sys.executable, "-m", "ziglang", "cc", "-O2")


SCENES = [
    pytest.param(each, id=name, marks=marks)
    for seed, marks in ((0, ()), (1, pytest.mark.long))
    for name, each in native_scenes.selection(seed)
]


@pytest.mark.parametrize("changes", SCENES)
def test_c_does_what_python_does(changes, tmp_path):
    scene = native_scenes.scene_of(changes)
    found = differences(scene, NativeContact(scene, tmp_path), RUNS, STEPS)
    assert {name: wrong for name, wrong in found.items() if not wrong <= tolerance(name)} == {}


def test_c_does_what_python_does_by_a_map(tmp_path):
    scene = mapped_scene(tmp_path)
    found = differences(scene, NativeContact(scene, tmp_path), 2, STEPS)
    assert {name: wrong for name, wrong in found.items() if not wrong <= tolerance(name)} == {}


@pytest.fixture(scope="module")
def ball(tmp_path_factory):
    scene = native_scenes.scene_of({})
    return scene, NativeContact(scene, tmp_path_factory.mktemp("ball"))


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"radius_x": 9.6e-3}, "radius_x = 0.0096 m.*geometry.radius_x"),
        ({"radius_y": 9.6e-3}, "radius_y = 0.0096 m.*geometry.radius_y"),
        ({"temperature": 300.0}, "temperature = 300 K"),
        ({"load": 1e6}, "load = 1e[+]06 N.*Lower the load"),
    ],
)
def test_inputs_that_the_contact_cannot_have_are_refused(ball, changed, said):
    scene, contact = ball
    inputs = native_scenes.inputs_of(scene)
    assert not contact.initialise(inputs)
    before = list(contact.state), list(contact.outputs)
    assert re.search(said, contact.step(inputs | changed, 1.0))
    assert (list(contact.state), list(contact.outputs)) == before
    assert not contact.step(inputs, 1.0)


@pytest.mark.parametrize("changed", [{"radius_x": 9.6e-3}, {"temperature": 300.0}])
def test_derivatives_are_refused_as_steps_are(ball, changed):
    scene, contact = ball
    inputs = native_scenes.inputs_of(scene)
    assert not contact.initialise(inputs)
    assert not contact.derivatives(inputs)
    assert next(iter(changed)) in contact.derivatives(inputs | changed)


def test_radii_may_be_rounded_in_other_units(ball):
    scene, contact = ball
    inputs = native_scenes.inputs_of(scene)
    assert not contact.initialise(inputs | {"radius_x": inputs["radius_x"] * (1.0 + 1e-12)})


def test_the_radius_of_a_line_is_an_input(tmp_path):
    scene = native_scenes.scene_of(native_scenes.CHOICES["shape"][3])
    contact = NativeContact(scene, tmp_path)
    inputs = native_scenes.inputs_of(scene)
    films = []
    for radius in (5e-3, 20e-3):
        assert not contact.initialise(inputs | {"radius_x": radius})
        films.append(contact.found["h_c"])
    assert films[0] < films[1]


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"stress.set": "bearing_52100", "stress.layers": "64"}, "Lower stress.layers"),
        ({"film.model": "deterministic"}, "film.model = 'regression'"),
    ],
)
def test_scenes_without_c_are_refused_with_a_way_out(changes, said):
    scene = Scene.from_toml("mtm_zddp", {"film.model": "regression"} | changes)
    with pytest.raises(SceneError, match=said):
        files.contact(scene)


@pytest.mark.parametrize("compiler", [("gcc", "-O0"), ("gcc", "-O2"), ("gcc", "-O3", "-march=native"), ZIG])
def test_bits_do_not_depend_on_the_compiler(ball, compiler, tmp_path):
    if compiler is ZIG:
        pytest.importorskip("ziglang")
    scene, contact = ball
    assert bits(NativeContact(scene, tmp_path, *compiler), scene, 200) == bits(contact, scene, 200)


@pytest.mark.parametrize("compiler", [("gcc", "-O1"), ZIG])
def test_no_compiler_warns(ball, compiler, tmp_path):
    if compiler is ZIG:
        pytest.importorskip("ziglang")
    NativeContact(ball[0], tmp_path, *compiler, *WARNINGS)
