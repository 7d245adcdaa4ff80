"""Damage in contact.c: it grows, wears off and breaks out as in Python."""

import shutil

import pytest

from benchmarks.fmu import native_scenes
from benchmarks.fmu.native_contact import NativeContact, bits, differences, tolerance

pytestmark = [pytest.mark.fmu, pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")]

# a steel that breaks out within the steps of `differences`, and wears by more than a hundredth of the first layer
WEAK = {
    "stress.set": "bearing_52100",
    "stress.layers": "6",
    "fatigue.set": "bearing_52100",
    "fatigue.single_strength": "500 MPa",
    "wear.bare": "3e-5",
    "wear.film": "3e-5",
}


@pytest.fixture(scope="module")
def weak(tmp_path_factory):
    scene = native_scenes.scene_of(WEAK)
    return scene, NativeContact(scene, tmp_path_factory.mktemp("weak"))


@pytest.mark.long
def test_classes_wear_and_break_out_one_after_the_other_as_in_python(weak):
    scene, contact = weak
    found = differences(scene, contact, 3, 8)
    assert {name: wrong for name, wrong in found.items() if not wrong <= tolerance(name)} == {}
    assert contact.found["profile_loss_1"] > contact.found["wear_depth_1"]
    assert 0.0 < contact.found["micropitted_area_1"] < 1.0
    assert contact.found["wear_depth_1"] > 0.01 * scene.depths[0]
    assert contact.found["damage_2"] > 0.0


@pytest.mark.long
def test_bits_of_damage_do_not_depend_on_the_compiler(weak, tmp_path):
    scene, contact = weak
    assert bits(NativeContact(scene, tmp_path, "gcc", "-O3"), scene, 50) == bits(contact, scene, 50)
