"""Short runs of what claims are about: when their numbers move, those that the long benchmarks found are of older code.

Each returns a few numbers by name, always the same ones for the same code but for rounding, in seconds on one thread.
Benchmarks are imported where they are needed: most of them are not.
"""

import functools
import tempfile
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from contact_core import OperatingPoint, Outputs, Scene, advance, dry_contact, initial_state, point_contact
from contact_core.laws.viscosity import kinematic_viscosity

Numbers = dict[str, float]
Sentinel = Callable[[], Numbers]
SHIPPED = ("azam_case_a", "mtm_zddp", "fzg_flank", "ball_209_inner", "cam_tappet")
SEEN = ("friction_coefficient", "h_c", "contact_load_ratio", "contact_area_ratio")
STATED = ("error_friction", "error_film", "error_load_ratio")
OVER_TIME = (*SEEN, "tribofilm_1", "tribofilm_2", "wear_depth_1", "wear_depth_2", "roughness_1", "roughness_2")
GIVEN: dict[str, Any] = {
    "load": 20.0, "radius_x": 8e-3, "reduced_modulus": 2.27e11, "viscosity": 0.03, "pressure_viscosity": 18e-9,
    "speed_1": 1.0, "speed_2": 0.8,
}  # fmt: skip


def read_off(out: Outputs, names: Iterable[str], prefix: str = "") -> Numbers:
    """Return outputs by name."""
    return {prefix + name: float(getattr(out, name)) for name in names}


# one contact at one instant


@functools.cache
def _first(name: str, **changes: str) -> Outputs:
    scene = Scene.from_toml(name, {"film.points": "65"} | changes)
    return advance(scene, scene.operation.point, initial_state(scene), 0.0)[1]


def first_blocks() -> Numbers:
    """First blocks of the thesis's cases on 65 nodes."""
    return {
        key: value
        for name in ("azam_case_a", "mtm_zddp")
        for key, value in read_off(_first(name), SEEN, f"{name} ").items()
    }


def shorter_steps() -> Numbers:
    """The first block of azam_case_a on 65 nodes, an instant for each quarter of a node of the oil's way."""
    return read_off(_first("azam_case_a", **{"control.nodes_per_instant": "0.25"}), SEEN)


def grid_errors() -> Numbers:
    """Errors that a first block states of its grid and its iteration."""
    return read_off(_first("azam_case_a"), STATED, "azam_case_a ") | read_off(_first("mtm_zddp"), STATED, "mtm_zddp ")


def accuracy_asked_for() -> Numbers:
    """First blocks of azam_case_a at both levels, the deterministic one with an accuracy asked for."""
    changes = {"control.accuracy": "20 %"}
    found: Numbers = {}
    for scene in (Scene.from_toml("azam_case_a", changes), Scene.from_toml("azam_case_a").at_level("regression")):
        out = advance(scene, scene.operation.point, initial_state(scene), 0.0)[1]
        found |= read_off(out, SEEN, f"{scene.film.points if scene.film.on_grid else 'regression'} ")
    return found


def single_call() -> Numbers:
    """A smooth ball by one call: its film, and the errors that are stated."""
    found = point_contact(**GIVEN, grid=65)
    errors = {f"error {name}": float(value) for name, value in found.error_estimate.items() if value > 0.0}
    return {"h_central": found.h_central, "h_min": found.h_min, "pressure_max": found.pressure_max} | errors


def smooth_films() -> Numbers:
    """Smooth films of the thesis's cases on 65 nodes."""
    from benchmarks.film.flux_films import scene_film

    films = {name: scene_film(name, 65, "fitted") for name in SHIPPED[:2]}
    return {f"{name} {part}": getattr(film, part) for name, film in films.items() for part in ("central", "least")}


def random_points() -> Numbers:
    """Three random rough contacts on 65 nodes, which independent code judges."""
    from benchmarks.film.hard_cases_kept import TOLERANCE
    from benchmarks.film.independent import answer, judge
    from benchmarks.film.random_points import draw

    found: Numbers = {}
    for number, point in zip(range(3), filter(None, draw(1)), strict=False):
        given = point.arguments(65)
        solved = point_contact(**given, tolerance=TOLERANCE)
        sound = judge(answer(given, solved))
        names = ("h_c", "h_min", "contact_load_ratio", "contact_area_ratio")
        found |= {f"{number} {name}": float(getattr(solved, name)) for name in names}
        assert not sound.failures, f"independent code finds {sound.failures}"
    return found


def short_inlet() -> Numbers:
    """A ball's film behind a domain that cuts the inlet off: solved, and the loss that is stated."""
    from benchmarks.film.inlet_contacts import Contact

    ball = Contact("point", 1e-11, 4000.0, 1e-6)
    before = ball.half_widths[0] + ball.inlet
    return {"film": ball.film(before, 1.5 * ball.half_widths[0], ball.beside), "stated": ball.stated(before)}


def optical_films() -> Numbers:
    """Factor, scatter and slope of 21 films beside measured ones, on 65 nodes."""
    from system_models.validation.optical_films import films

    found = films(22e-9, 65)
    (_, slope), (factor, scatter, least) = found.slopes(), found.factor()
    return {"slope": slope, "factor": factor, "scatter": scatter, "least": least}


def dry_ball() -> Numbers:
    """The rough dry ball of the peers on 65 nodes."""
    from benchmarks.film.peers import LOAD, MODULUS, RADIUS, Case

    case = Case(65, 65)
    found = dry_contact(case.heights, case.spacing, RADIUS, LOAD, 2.0 * MODULUS, tolerance=1e-8)
    return {"pressure_max": float(found.pressure.max()), "touching": float((found.pressure > 0.0).mean())}


def march_of_steps() -> Numbers:
    """Steps of a march of mtm_zddp at a loose tolerance."""
    from benchmarks.film.tolerance import march

    pressures, _, _, share, _ = march("mtm_zddp", "1e-2")
    return {"W_c": share, "pressure": float(np.sqrt(np.mean(np.square(pressures))))}


# surfaces over hours


def _rubbed(name: str, seconds: float, changes: dict[str, str]) -> Numbers:
    scene = Scene.from_toml(name, changes)
    state, _ = advance(scene, scene.operation.point, initial_state(scene), 0.0)
    return read_off(advance(scene, scene.operation.point, state, seconds)[1], OVER_TIME)


def minutes_of_rubbing() -> Numbers:
    """Ten minutes of azam_case_a on 65 nodes."""
    return _rubbed("azam_case_a", 600.0, {"film.points": "65"})


def minutes_driven_mixed() -> Numbers:
    """Two minutes of mtm_zddp on 65 nodes, all blocks driven by mixed lubrication."""
    return _rubbed("mtm_zddp", 120.0, {"film.points": "65", "control.driver": "mixed"})


def minutes_of_the_thesis() -> Numbers:
    """Five minutes of the thesis's case A in the joint reading, on 65 nodes."""
    return _rubbed("azam_case_a_thesis", 300.0, {"film.points": "65"})


def load_share() -> Numbers:
    """Share of the load on the solids of one contact at two lambdas."""
    from benchmarks.surfaces.asperity_load_share import BASE, solved

    return {f"W_c at {ratio:g}": float(solved(BASE, ratio, {}).contact_load_ratio) for ratio in (0.5, 1.5)}


def traces() -> Numbers:
    """Spectra of both measured traces."""
    from benchmarks.surfaces.finishes import STEPS, row

    return {f"{name} {k}": float(value) for name in STEPS for k, value in enumerate(row(name)[1:])}


# the regression level


def regression_points() -> Numbers:
    """Every shipped scene at the regression level: fresh surfaces, its own point."""
    found: Numbers = {}
    for name in SHIPPED:
        scene = Scene.from_toml(name).at_level("regression")
        found |= read_off(
            advance(scene, scene.operation.point, initial_state(scene), 0.0)[1], (*SEEN, *STATED), f"{name} "
        )
    return found


def regression_hours() -> Numbers:
    """Two hours of both cases of the thesis at the regression level."""
    found: Numbers = {}
    for name in SHIPPED[:2]:
        scene = Scene.from_toml(name).at_level("regression")
        out = advance(scene, scene.operation.point, initial_state(scene), 7200.0)[1]
        found |= read_off(out, OVER_TIME, f"{name} ")
    return found


def regression_steps() -> Numbers:
    """Ten seconds of steps under changing load, speeds and temperature, with the costliest laws."""
    from benchmarks.regression.cost import OPTIONS, duty

    scene = Scene.from_toml("mtm_zddp", OPTIONS["all of them"]).at_level("regression")
    state, out = initial_state(scene), None
    for op in duty(scene.operation.point, 2.0)[:20]:
        state, out = advance(scene, op, state, 0.5)
    assert out is not None
    return read_off(out, SEEN)


def discs() -> Numbers:
    """Friction of two oils on discs at two speeds."""
    from system_models.validation.traction import Point

    found: Numbers = {}
    for oil, speed in (("m100", 2.0), ("pao100", 8.0)):
        (out,) = Point(oil, 1e9, speed, 333.15).curve((0.05,))
        found |= read_off(out, ("friction_coefficient", "h_c"), f"{oil} ")
    return found


# stress


def below_a_circle() -> Numbers:
    """Errors of stresses below a circle of 17 nodes, by depth."""
    from benchmarks.stress.field import circle

    return {f"depth {k}": float(error) for k, error in enumerate(circle(17).away)}


def pitted_roller() -> Numbers:
    """Damage of a coarse micropitting rig after six minutes."""
    from benchmarks.stress.micropitting_rig import Setting, scene_of

    scene = scene_of(Setting(points=65))
    out = advance(scene, scene.operation.point, initial_state(scene), 360.0)[1]
    return read_off(out, ("dang_van_ratio", "wear_depth_1", "roughness_2", "contact_area_ratio"))


# machines


def _torques(levels: int, load: float, celsius: float, rpm: float) -> tuple[Numbers, Any]:
    from benchmarks.machines.bearing_torque import machine, solved

    bearing, scene = machine(levels)
    parts, shown, _ = solved(bearing, scene, load, celsius, rpm)
    return parts, shown


def bearing_torques() -> Numbers:
    """Torque of bearing 209 in parts at two speeds."""
    found: Numbers = {}
    for rpm in (100.0, 3000.0):
        found |= {f"{rpm:g} rpm {part}": value for part, value in _torques(3, 2000.0, 50.0, rpm)[0].items()}
    return found


def bearing_lives() -> Numbers:
    """Ratings of bearing 209, and stress below its smooth contact."""
    from contact_core.scene import Case
    from system_models.machines.ball_bearing import rating
    from system_models.machines.ball_bearing import stress_life as life
    from system_models.machines.ball_bearing.equilibrium import RingLoads, solve
    from system_models.machines.ball_bearing.geometry import BEARING_209

    _, (op, _, scene) = _torques(3, 4000.0, 50.0, 1000.0)
    below = life.SmoothContact(Case.bind(scene, op).hertz, BEARING_209.poisson)
    capacity = rating.dynamic_rating(BEARING_209)
    loads = solve(BEARING_209, RingLoads(0.0, 4000.0), 100.0).load_inner
    return {
        "capacity": capacity,
        "life": rating.rating_life(capacity, rating.equivalent_load(BEARING_209, 4000.0, 0.0)),
        "limit": float(below.fatigue_limit),
        "largest load": float(np.max(loads)),
        "friction": float(below.life_factor(np.array([0.05]))[0]),
    }


@functools.cache
def _gears() -> Any:
    from benchmarks.machines.gear_friction import Case

    return Case(stations=5, duration=2.0).record([135.5], 2250.0)


def gear_friction() -> Numbers:
    """Mean friction of FZG gears of type C at load stage 7, beside formulas."""
    from benchmarks.machines.gear_friction import Found

    found = Found.of([_gears()])
    return {name: float(getattr(found, name)[-1]) for name in ("friction", "schlenk", "iso", "solids", "loss")}


def gear_safety() -> Numbers:
    """Ratings of gears of the FZG test A as far as they need no run."""
    from benchmarks.machines.gear_ratings import OILS, with_oil

    found = {stage: with_oil(_gears(), micropitting_stage=stage) for stage in OILS}
    last = found[7].micropitting(_gears().stages[-1].last)
    return {f"stage {stage}": float(each.failing) for stage, each in found.items()} | {
        f"at the end {k}": float(value) for k, value in enumerate(last)
    }


def rolling_bodies() -> Numbers:
    """Rolling resistance of shipped scenes at the regression level, and viscosities of bearing 209's oil."""
    found: Numbers = {}
    for name in SHIPPED:
        scene = Scene.from_toml(name).at_level("regression")
        out = advance(scene, scene.operation.point, initial_state(scene), 0.0)[1]
        found |= read_off(out, ("rolling_resistance", "error_rolling"), f"{name} ")
    found["viscosity"] = float(kinematic_viscosity(scene.lubricant.viscosity, 323.15))
    return found


def coupled_machine() -> Numbers:
    """Half a minute of the test rig, and the error that is stated of its coupling."""
    from system_models.machines import reading
    from system_models.master import simulate

    assembly = reading.assemble(reading.read("mtm_rig", {"simulate.stop_time": "30 s"}))
    with tempfile.TemporaryDirectory() as folder:
        found = simulate(assembly.system(Path(folder)), **assembly.settings, outputs=assembly.outputs())
    names = ("contact.friction_force", "bath.temperature_oil", "disc.torque", "ball.surface_speed")
    return {name: float(found[name].values[-1]) for name in names}


# co-simulation and FMUs


def two_masses() -> Numbers:
    """Errors of an oscillator in two FMUs by two schemes and step sizes."""
    from benchmarks.coupling.accuracy import STATES, STOP, exact, oscillator
    from system_models.master import simulate

    end, found = exact.two_mass(STOP)[0], {}
    with tempfile.TemporaryDirectory() as folder:
        system = oscillator(Path(folder), "f-d")
        for algorithm, order in (("jacobi", 1), ("gauss_seidel", 2)):
            data = simulate(system, STOP, 0.02, algorithm=algorithm, order=order, outputs=STATES)
            errors = [abs(data[name].values[-1] - end[n]) for n, name in enumerate(STATES)]
            found[f"{algorithm} {order}"] = float(max(errors))
    return found


def exported_machine() -> Numbers:
    """The test rig by the master with the importers' algorithm: Jacobi of order 0, fixed steps."""
    from benchmarks.coupling.ssp_importers import RIG
    from system_models.machines import reading
    from system_models.master import simulate

    assembly = reading.assemble(reading.read("mtm_rig", {}))
    with tempfile.TemporaryDirectory() as folder:
        settings: dict[str, Any] = {"step_size": 0.125, "algorithm": "jacobi", "order": 0, "outputs": RIG}
        found = simulate(assembly.system(Path(folder)), 5.0, **settings)
    return {name: float(found[name].values[-1]) for name in RIG}


def native_steps() -> Numbers:
    """Steps of mtm_zddp in C, compiled from the sources of a native FMU."""
    from benchmarks.fmu.native_contact import NativeContact

    scene = Scene.from_toml("mtm_zddp").at_level("regression")
    op = scene.operation.point
    with tempfile.TemporaryDirectory() as folder:
        contact = NativeContact(scene, Path(folder))
        inputs = {name: float(getattr(op, name)) for name in contact.names["inputs"] if getattr(op, name) is not None}
        inputs |= {f"body_temperature_{k}": op.temperature for k in (1, 2)}
        inputs |= dict(zip(("radius_x", "radius_y"), scene.radii(op), strict=True))
        assert not contact.initialise(inputs)
        for factor in (1.0, 0.9, 1.1):
            assert not contact.step(inputs | {"load": factor * op.load}, 60.0)
        return {name: float(contact.found[name]) for name in (*SEEN, "tribofilm_1", "wear_depth_2")}


def direct_steps() -> Numbers:
    """The same steps by direct calls, as an FMU in Python makes them."""
    scene = Scene.from_toml("mtm_zddp").at_level("regression")
    op, state = scene.operation.point, initial_state(scene)
    radius_x, radius_y = scene.radii(op)
    rest = {"body_temperature_1": op.temperature, "body_temperature_2": op.temperature}
    point: OperatingPoint = replace(op, radius_x=radius_x, radius_y=radius_y, **rest)
    state, out = advance(scene, point, state, 0.0)
    for factor in (1.0, 0.9, 1.1):
        state, out = advance(scene, replace(point, load=factor * op.load), state, 60.0)
    return read_off(out, (*SEEN, "tribofilm_1", "wear_depth_2"))


# tests and code


def listed_faults() -> Numbers:
    """How many faults are listed, and how many of them do not fit the code."""
    from benchmarks.house.faults import listed, misfits

    faults = listed()
    return {"listed": float(len(faults)), "misfits": float(len(misfits(faults)))}


def stays() -> Numbers:
    """Functions through which a scene, a state and an operating point travel at the regression level."""
    from benchmarks.house.stays import of_steps

    of_steps("regression")  # what is kept from one call to the next is there
    return {name: float(len(found)) for name, found in of_steps("regression").items()}
