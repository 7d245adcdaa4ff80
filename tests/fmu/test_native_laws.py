"""contact.c of scenes with every law says what Python says."""

import re
import shutil
import sys

import pytest

from benchmarks.fmu import native_scenes
from benchmarks.fmu.native_contact import NativeContact, bits, differences, tolerance
from contact_core import Scene
from contact_core.errors import SceneError
from fmu_src.native import files, program
from fmu_src.native.build import WARNINGS
from fmu_src.native.translate import Translator

pytestmark = [pytest.mark.fmu, pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")]

LONG = pytest.mark.long
RUNS, STEPS = 4, 8
ZIG = (sys.executable, "-m", "ziglang", "cc", "-O2")


ALL = list(native_scenes.selection())
BY_DEFAULT = {"tribofilm12"}  # with most of the other slots
SCENES = [
    pytest.param(each, id=name, marks=() if BY_DEFAULT & {*name.split()} and not seed else LONG)
    for seed in (0, 1)
    for name, each in native_scenes.selection(seed)
]
# classes of stress are many equations: test_native_damage.py has them
WITHOUT_DAMAGE = [pytest.param(each, id=name) for name, each in ALL if "fatigue" not in name]


@pytest.mark.parametrize("changes", SCENES)
def test_c_does_what_python_does(changes, tmp_path):
    scene = native_scenes.scene_of(changes)
    found = differences(scene, NativeContact(scene, tmp_path), RUNS, STEPS)
    assert {name: wrong for name, wrong in found.items() if not wrong <= tolerance(name)} == {}


@pytest.mark.parametrize("changes", WITHOUT_DAMAGE)
def test_every_law_can_be_written_as_c(changes, monkeypatch):
    """By one pass over its Python, which leaves in what nothing reads."""

    def in_one_pass(function, operands):
        translator = Translator({}, None)
        entry = translator.program(function, operands)
        return entry, translator.texts([entry])

    monkeypatch.setattr(program, "translated", in_one_pass)
    sources = program._equations(native_scenes.scene_of(changes))
    assert "contact_step(" in sources["contact.c"]
    assert "contact_derivatives(" in sources["slopes.c"]


@pytest.fixture(scope="module")
def ball(quick, tmp_path_factory):
    return quick, NativeContact(quick, tmp_path_factory.mktemp("ball"))


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


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        pytest.param({"stress.set": "bearing_52100", "stress.layers": "64"}, "Lower stress.layers", marks=LONG),
        ({"film.model": "deterministic"}, "film.model = 'regression'"),
    ],
)
def test_scenes_without_c_are_refused_with_a_way_out(changes, said):
    scene = Scene.from_toml("mtm_zddp", {"film.model": "regression"} | changes)
    with pytest.raises(SceneError, match=said):
        files.contact(scene)


def test_arrays_that_take_more_stack_together_than_every_host_has_are_refused(monkeypatch):
    inner = "static void inner(void)\n{\n    double own[60000];\n}"
    outer = "static void outer(void)\n{\n    double own[60000];\n    inner();\n}"
    monkeypatch.setattr(program, "translated", lambda *_: (None, [inner, outer]))
    with pytest.raises(SceneError, match="Lower stress"):
        files.contact(native_scenes.scene_of({"surface_1.rq": "123 nm"}))


@pytest.mark.parametrize(
    "compiler",
    [
        ("gcc", "-O0"),
        pytest.param(("gcc", "-O2"), marks=LONG),
        pytest.param(("gcc", "-O3", "-march=native"), marks=LONG),
        pytest.param(ZIG, marks=LONG),
    ],
)
def test_no_compiler_warns_and_bits_depend_on_none(ball, compiler, tmp_path):
    if compiler is ZIG:
        pytest.importorskip("ziglang")
    scene, contact = ball
    assert bits(NativeContact(scene, tmp_path, *compiler, *WARNINGS), scene, 200) == bits(contact, scene, 200)
