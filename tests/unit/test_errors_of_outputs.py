"""Errors of outputs by their causes: of the grid, of iterations, of fitted curves; flags and validity that follow."""

import pytest
from comparison import approx

from contact_core import Error, Outputs, RangeFlag, Scene, advance, initial_state, uncertainty
from contact_core.deterministic.solution_error import with_errors_of_the_solution
from contact_core.film.grid_error import film_error, friction_error, inlet_error, load_ratio_error, solids_error
from contact_core.quantities import ABSOLUTE, STATED, TABLE
from contact_core.scene import Case
from contact_core.state import changed, flag_of_errors

# first blocks on fresh surfaces on 65 nodes and, of the same surfaces, on 257: rows of docs/measured/film.md
COARSE_AND_FINE = {
    ("azam_case_a", 1): {"contact_load_ratio": (0.6941, 0.6507), "friction": (0.09329, 0.08936), "h_c": (44.54, 49.67)},
    ("azam_case_a", 2): {"contact_load_ratio": (0.6336, 0.6126), "friction": (0.08691, 0.08486), "h_c": (49.02, 53.44)},
    ("mtm_zddp", 1): {"contact_load_ratio": (0.8329, 0.8022), "friction": (0.1083, 0.1043), "h_c": (46.63, 54.12)},
    ("mtm_zddp", 3): {"contact_load_ratio": (0.8011, 0.7489), "friction": (0.1042, 0.1004), "h_c": (53.03, 52.49)},
}
NODES = {"azam_case_a": (1.024, 1.02), "mtm_zddp": (1.024, 0.68)}  # per correlation length and across the inlet, on 65


def cheap_scene(**changes):
    coarse = {"film.points": "33", "surface_1.correlation_length": "16 um", "surface_2.correlation_length": "16 um"}
    quick = {"control.driver": "dry", "film.tolerance": "1e-2"}
    return Scene.from_toml("azam_case_a", coarse | quick | {k.replace("__", "."): v for k, v in changes.items()})


def cheap(**changes):
    scene = cheap_scene(**changes)
    return scene, *advance(scene, scene.operation.point, initial_state(scene), 60.0)


@pytest.mark.parametrize("case", COARSE_AND_FINE)
def test_errors_of_a_coarse_grid_cover_a_fine_one_and_a_tenth_of_them_would_not(case):
    rows, (rough, inlet) = COARSE_AND_FINE[case], NODES[case[0]]
    nodes = rough, inlet_error(inlet)
    share, fine = rows["contact_load_ratio"]
    friction, other = rows["friction"]
    solid = 0.13 * share
    stated = {
        "contact_load_ratio": (abs(share - fine), load_ratio_error(share, *nodes)),
        "friction": (abs(friction - other), friction_error(share, solid, friction - solid, *nodes)),
        "h_c": (abs(rows["h_c"][1] / rows["h_c"][0] - 1.0), film_error(share, *nodes)),
    }
    assert all(true <= error for true, error in stated.values()), stated
    assert any(true > 0.1 * error for true, error in stated.values()), stated


def test_the_error_of_a_smooth_film_covers_the_shipped_scenes_and_a_tenth_of_it_would_not():
    """Central films on the scenes' grids against 1025 nodes: docs/measured/film.md."""
    found = {1.02: 0.027, 2.03: 0.00097, 0.68: 0.176, 1.35: 0.005}  # by nodes across the inlet
    assert all(true <= inlet_error(nodes) for nodes, true in found.items())
    assert any(true > 0.1 * inlet_error(nodes) for nodes, true in found.items())


@pytest.mark.parametrize("error", [load_ratio_error, film_error, solids_error])
def test_errors_fall_as_nodes_come_closer(error):
    found = [error(0.5, 1.0 * finer, inlet_error(1.0 * finer)) for finer in (1, 2, 4, 8)]
    assert found == sorted(found, reverse=True)
    assert found[0] > 2.0 * found[-1] > 0.0


def test_smooth_bodies_have_no_error_by_roughness():
    assert film_error(0.0, 0.0, inlet_error(5.0)) == inlet_error(5.0)
    assert load_ratio_error(0.0, 1.0, 1.0) == 0.0


def test_an_error_together_is_the_root_of_the_sum_of_squares():
    assert Error(time=3.0, grid=4.0).together == approx(5.0)
    assert Error(time=3.0, grid=4.0).scaled(-2.0) == Error(time=6.0, grid=8.0)


def test_the_deterministic_level_states_grid_time_sampling_and_iteration_apart_and_error_outputs_all_together():
    scene, state, out = cheap()
    found = uncertainty(scene, state)
    error = found["friction_coefficient"]
    assert min(error.time, error.grid, error.iteration) > 0.0
    assert error.curves == 0.0
    for name, stated in STATED.items():
        if name in found:
            value = 1.0 if stated in ABSOLUTE else abs(getattr(out, name))
            assert found[name].together <= getattr(out, stated) * value * (1.0 + 1e-12), name
    assert out.error_film == approx(found["h_c"].together / out.h_c)
    assert out.error_load_ratio == approx(found["contact_load_ratio"].together)


@pytest.mark.parametrize("rougher", [1, 2])
def test_the_tribofilm_of_the_rougher_body_is_less_sure_by_the_grid(rougher):
    rough = {f"surface_{rougher}__rq": "100 nm", f"surface_{3 - rougher}__rq": "20 nm"}
    scene = cheap_scene(**rough)
    out = changed(Outputs(), contact_load_ratio=0.5, tribofilm_1=1e-8, tribofilm_2=1e-8)
    names = [f"tribofilm_{body}" for body in (rougher, 3 - rougher)]
    case = Case.bind(scene, scene.operation.point)
    found = with_errors_of_the_solution(case, out, dict.fromkeys(names, Error()))
    assert found[names[0]].grid > 1.2 * found[names[1]].grid


def test_where_oil_and_solids_rub_alike_the_error_of_friction_is_that_of_the_oils_film():
    """What moves of the load from one to the other changes nothing then, and how much it is does not matter."""
    scene = cheap_scene()
    out = changed(Outputs(), contact_load_ratio=0.75, friction_solid=-3.0, friction_force=-4.0, h_c=1e-7)
    case = Case.bind(scene, scene.operation.point)
    found = with_errors_of_the_solution(case, out, {"friction_force": Error(), "h_c": Error()})
    assert found["h_c"].grid > 0.0
    assert found["friction_force"].grid / 1.0 == approx(found["h_c"].grid / 1e-7, rel=1e-9)


@pytest.mark.long
def test_a_finer_grid_states_a_smaller_error():
    coarse, fine = (cheap(film__points=points) for points in ("33", "65"))
    assert fine[2].error_film < coarse[2].error_film
    assert uncertainty(*fine[:2])["contact_load_ratio"].grid < uncertainty(*coarse[:2])["contact_load_ratio"].grid


def test_the_regression_level_states_the_error_of_its_curves_alone():
    scene = Scene.from_toml("mtm_zddp").at_level("regression")
    state, out = advance(scene, scene.operation.point, initial_state(scene), 60.0)
    found = uncertainty(scene, state)
    assert found["friction_coefficient"] == Error(curves=out.error_friction * out.friction_coefficient)
    assert found["contact_load_ratio"].curves == out.error_load_ratio > 0.0


def test_every_stated_error_is_an_output():
    assert {*STATED.values()} <= {*TABLE}
    assert {*STATED.values()} >= ABSOLUTE


def test_an_error_above_the_accuracy_asked_for_raises_a_flag():
    errors = {"error_friction": 0.04, "error_film": 0.1, "error_load_ratio": 0.01}
    assert flag_of_errors(errors, 0.2) == RangeFlag(0)
    assert flag_of_errors(errors, 0.05) == RangeFlag.UNSURE
    assert flag_of_errors(errors, None) == RangeFlag(0)
    assert flag_of_errors(errors | {"error_film": 0.6}, None) == RangeFlag.UNSURE
    out = cheap()[2]
    assert not out.range_flags & RangeFlag.UNSURE
    asked = cheap(control__accuracy="1 %", control__change="3 nm", control__dry_instants="3", film__points="33")[2]
    assert asked.range_flags & RangeFlag.UNSURE
    assert asked.friction_coefficient == out.friction_coefficient
