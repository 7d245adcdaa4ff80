"""`seed` gives other surfaces of the same statistics, the same ones for the same number."""

import pytest
from fmu_host import hosted
from test_run import STEPS, bits, direct

from contact_core.scene import with_values


def run(folder, **parameters):
    with hosted(folder) as host:
        host.initialise(**parameters)
        return [host.outputs(), host.step(60.0)]


def test_seed_zero_is_the_scenes_own_surfaces(folder, scene):
    rows = run(folder, seed=0)
    assert rows == run(folder)
    assert [bits(row) for row in rows] == direct(scene, STEPS[:1])[0]


def test_a_seed_gives_the_realisation_of_that_number_each_time(folder, scene):
    rows = run(folder, seed=7)
    assert rows == run(folder, seed=7)
    assert [bits(row) for row in rows] == direct(scene.realisation(7), STEPS[:1])[0]


@pytest.mark.long
def test_other_seeds_give_other_surfaces(folder):
    forces = {run(folder, seed=seed)[0]["friction_force"] for seed in (0, 1, 2, 2**31 - 1)}
    assert len(forces) == 4


def test_the_seed_and_the_seeds_of_the_surfaces_work_together(folder, scene):
    rows = run(folder, seed=3, surface_1__seed=5)
    expected = with_values(scene, {"surface_1.seed": 5}).realisation(3)
    assert [bits(row) for row in rows] == direct(expected, STEPS[:1])[0]


@pytest.mark.long
def test_the_realisation_travels_with_the_state(host, folder):
    state, first = host.initialise(seed=7).state(), host.step(60.0)
    with hosted(folder) as second:
        second.initialise()
        second.restore(state)
        assert second.get("seed") == 7
        assert second.step(60.0) == first


def test_a_stored_contact_belongs_to_its_realisation(host, scene, tmp_path):
    file = tmp_path / "contact.state"
    file.write_bytes(direct(scene.realisation(7), STEPS[:1])[1].to_bytes())
    host.initialise(initial_state=str(file))
    assert "belongs to another contact" in host.log[0][1]
    host.fmu.reset()
    assert host.initialise(initial_state=str(file), seed=7).get("valid")


def test_the_surfaces_cannot_be_changed_under_way(stepped):
    stepped.set(seed=1)
    assert stepped.get("seed") == 0
    assert "seed is a parameter" in stepped.log[0][1]


@pytest.mark.parametrize("seed", [-1, -(2**31)])
def test_a_negative_seed_is_refused_until_a_reset(host, seed):
    host.initialise(seed=seed)
    assert not host.step(60.0)["valid"]
    assert all(f"seed = {seed} must be at least 0" in text for _, text in host.log)
    host.fmu.reset()
    assert host.initialise().get("valid")
