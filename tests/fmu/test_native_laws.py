"""contact.c of scenes with every law says what Python says."""

import shutil

import native_scenes
import pytest
from native_contact import NativeContact, differences, tolerance

pytestmark = [pytest.mark.fmu, pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")]

RUNS, STEPS = 4, 8


@pytest.mark.parametrize("changes", [pytest.param(each, id=name) for name, each in native_scenes.selection()])
def test_c_does_what_python_does(changes, tmp_path):
    scene = native_scenes.scene_of(changes)
    found = differences(scene, NativeContact(scene, tmp_path), RUNS, STEPS)
    assert {name: wrong for name, wrong in found.items() if not wrong <= tolerance(name)} == {}
