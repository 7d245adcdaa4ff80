"""Checks of scenes and operating points: a sentence for all that is unusable or not resolved well."""

import re
from collections.abc import Iterator
from dataclasses import fields, replace
from itertools import pairwise

import numpy as np

from ..quantities import out_of_range
from . import intervals
from .fields import ROOM, SceneFields
from .operation import OperatingPoint

_THINNED = 0.5  # of its thickness, by which pressure may thin a tribofilm


def refusal(scene: SceneFields, op: OperatingPoint) -> str:
    """Return why the scene cannot have an operating point, or an empty text.

    Radii may make a contact that the grid cannot hold; a shape may not allow a motion.
    """
    said = scene.geometry.refusal(op.radius_y, op.spin)
    if said:
        return said
    inlet = scene.lubricant.supply.inlet
    if inlet is not None and op.load > 0.0 and inlet <= (a := scene.hertz_at(op).a):
        return (
            f"lubricant.supply.distance = {inlet:g} m must be more than the half width of Hertz's contact, {a:.3g} "
            f"m at {op.load:g} N: no oil would be before it."
        )
    if not scene.film.on_grid or op.load == 0.0 or scene.shape(op) == scene.shape():
        return ""
    return _no_room(scene, op)


def _no_room(scene: SceneFields, op: OperatingPoint) -> str:
    """Return why the radii of an operating point make a contact that the grid cannot hold, or an empty text."""
    own, hertz, shape = scene.hertz(op.load), scene.hertz_at(op), scene.shape(op)
    radii = " and ".join(f"{name} = {value:g} m" for name, value in shape.radii)
    said = f"At {op.load:g} N {radii} make a Hertz"
    for half, before, room in zip((hertz.a, hertz.b), (own.a, own.b), scene.room, strict=True):
        if half > max(room, before):  # in proportion to the radii's power `power`
            most = (room / half) ** (1.0 / shape.power)
            return (
                f"{said} contact of {2 * hertz.a:.3g} m by {2 * hertz.b:.3g} m, too large for "
                f"film.domain = {scene.film.domain:g} m. Use at most "
                f"{' and '.join(f'{most * value:.3g} m' for _, value in shape.radii)}, less load, "
                f"or a scene with a domain of at least {1.2 * ROOM * half:.2g} m."
            )
    hardness = scene.plasticity.hardness
    if hertz.pressure_max > max(hardness, own.pressure_max):
        least = (hertz.pressure_max / hardness) ** (1.0 / (1.0 - shape.power))
        return (
            f"{said} pressure of {hertz.pressure_max:.3g} Pa, above plasticity.hardness = {hardness:g} Pa. Use at "
            f"least {' and '.join(f'{least * value:.3g} m' for _, value in shape.radii)}, or less load."
        )
    return ""


def errors(scene: SceneFields) -> list[tuple[str, str]]:
    """Return (rule, sentence) for everything that makes the scene unusable."""
    ranges = [("range", sentence) for sentence in out_of_range(scene, "")]
    if not re.fullmatch(r"[\w-]+", scene.name):  # files are named after it
        ranges.append(("name", f"name = {scene.name!r} must be letters, digits, '_' and '-' only."))
    return ranges or [
        *_shape_errors(scene), *wear_errors(scene), *_roughness_errors(scene), *_oil_errors(scene),
        *_duty_errors(scene),
        *(("intervals", sentence) for sentence in intervals.errors(scene)),
    ]  # fmt: skip


def _shape_errors(scene: SceneFields) -> Iterator[tuple[str, str]]:
    """Yield errors of shape, grid and hardness."""
    load, plasticity = scene.largest_load, scene.plasticity
    hertz = scene.hertz(load)
    for name, half, room in zip(("domain", "width"), (hertz.a, hertz.b), scene.room, strict=True):
        if half > room:
            name = name if scene.film.width > 0.0 else "domain"
            yield (
                name,
                f"film.{name} = {getattr(scene.film, name):g} m is too small: at {load:g} N the Hertz contact is "
                f"{2 * hertz.a:.3g} m by {2 * hertz.b:.3g} m. Use at least {1.2 * ROOM * half:.2g} m.",
            )
            break
    depth = (scene.rows - 1) * scene.film.spacing
    said = scene.geometry.depth_error(depth, scene.film.width)
    if said:
        yield "width", said
    if hertz.pressure_max >= plasticity.hardness:
        yield (
            "hardness",
            f"The Hertz pressure at {load:g} N is {hertz.pressure_max:.3g} Pa, above plasticity.hardness = "
            f"{plasticity.hardness:g} Pa. Lower the load or raise the hardness.",
        )
    if not scene.geometry.lumped and scene.film.lumped:
        yield (
            "criterion",
            "film.criterion = 'lumped' is for point contacts: it finds no film of a line. Use 'split'.",
        )
    for name in ("track_length_1", "track_length_2"):
        if getattr(scene.geometry, name) < scene.film.domain:
            yield (
                "track",
                f"geometry.{name} = {getattr(scene.geometry, name):g} m is shorter than film.domain = "
                f"{scene.film.domain:g} m: a point would be in the contact twice at once. Use a longer track.",
            )
    if plasticity.error:
        yield "hardness", plasticity.error
    if scene.stress.error:
        yield "stress", scene.stress.error
    if scene.fatigue.damages and not scene.stress.samples:
        yield (
            "stress",
            f"fatigue.model = '{scene.fatigue.name}' needs the stresses below the surfaces, and stress.model = "
            f"'{scene.stress.name}' has none. Set stress.model = 'half_space'.",
        )
    solids = scene.solids
    if solids.film_modulus is not None:
        given = solids.film_modulus, solids.film_poisson_ratio
        said = "solids.film_modulus = {:g} Pa with film_poisson_ratio = {:g}".format(*given)
        if solids.film_give < 0.0:
            yield "film_modulus", f"{said} makes a tribofilm stiffer than its solids. Lower it, or leave it out."
        if hertz.pressure_max * solids.film_give > _THINNED:
            yield (
                "film_modulus",
                f"{said} lets the Hertz pressure of {hertz.pressure_max:.3g} Pa take more than {_THINNED:.0%} of a "
                "tribofilm's thickness; the layer is linear. Raise it, or lower the load.",
            )
    if scene.wear.wears_film and not scene.tribofilm.takes_abrasion:
        yield (
            "wear",
            f"wear.model = '{scene.wear.name}' takes tribofilm in proportion to its thickness; tribofilm.model = "
            f"'{scene.tribofilm.name}' has no closed form with that. Use wear.model = 'archard', or another tribofilm.",
        )


def wear_errors(scene: SceneFields) -> Iterator[tuple[str, str]]:
    """Yield an error of a law of wear whose `coefficient`, which limits time steps, is not that of its `rate`."""
    wear, hardness, full = scene.wear, scene.plasticity.hardness, scene.tribofilm.full_thickness
    cover, speeds = np.array([0.0, 1.0]), (1.0, 0.5)
    for body in (0, 1):
        rate = wear.rate(np.full(2, hardness), cover, speeds, body, hardness, full)
        expected = wear.coefficient(cover, full) * wear.slide(speeds, body)
        if not np.allclose(rate, expected, rtol=1e-6, atol=0.0):
            yield (
                "wear",
                f"wear.model = '{wear.name}' contradicts itself: under a pressure of the hardness its rate, "
                f"{rate[0]:.3g} m/s of bare solids, must be its coefficient times the speed of `slide`, "
                f"{expected[0]:.3g} m/s.",
            )
            return


def _roughness_errors(scene: SceneFields) -> Iterator[tuple[str, str]]:
    for name, surface in (("surface_1", scene.surface_1), ("surface_2", scene.surface_2)):
        for sentence in surface.errors(scene.film.spacing, scene.patch_size):
            yield "resolution", f"{name}.{sentence}"
    given = (scene.surface_1.microroughness, scene.surface_2.microroughness)
    rms = {f"surface_{i}.microroughness.rms": below.rms for i, below in enumerate(given, 1) if below and below.rms}
    if scene.film.lumped and rms:
        yield (
            "criterion",
            "film.criterion = 'lumped' has one pressure for oil and solids; "
            f"{' and '.join(f'{field} = {value:g} m' for field, value in rms.items())} carry a part of it. Set "
            f"{' and '.join(rms)} to 0 nm, or use film.criterion = 'split'.",
        )


def _oil_errors(scene: SceneFields) -> Iterator[tuple[str, str]]:
    said = scene.lubricant.viscosity.error
    if said:
        yield "viscosity", said
    if scene.lubricant.supply.layer is not None and scene.lubricant.cavitation != "mass_conserving":
        yield (
            "supply",
            f"lubricant.supply.thickness = {scene.lubricant.supply.layer:g} m needs lubricant.cavitation = "
            f"'mass_conserving': with '{scene.lubricant.cavitation}' every gap counts as full. Set it, or use the "
            "supply 'meniscus'.",
        )


def _duty_errors(scene: SceneFields) -> Iterator[tuple[str, str]]:
    times = [step.time for step in scene.operation.steps]
    if times and scene.operation.file:
        yield "duty", f"operation.steps and operation.file = '{scene.operation.file}' exclude each other. Keep one."
    for name, point in duty_points(scene):
        said = refusal(scene, point)
        if said:
            yield "radii", f"{name}: {said}"
    for name, temperature in _temperatures(scene):
        said = scene.tribofilm.refusal(temperature)
        if said:
            yield "temperature", f"{name}{said}"
    if any(late <= early for early, late in pairwise([0.0, *times])):
        yield "duty", f"The times of operation.steps, {times} s, must be above 0 and increase."


def duty_points(scene: SceneFields) -> Iterator[tuple[str, OperatingPoint]]:
    """Yield names and values of the duty's operating points."""
    yield "operation", scene.operation.point
    for i, step in enumerate(scene.operation.steps):
        given = {f.name: getattr(step, f.name) for f in fields(OperatingPoint)}
        changed = {name: value for name, value in given.items() if value is not None}
        yield f"operation.steps[{i}]", replace(scene.operation.point, **changed)


def _temperatures(scene: SceneFields) -> Iterator[tuple[str, float]]:
    """Yield the temperatures of the duty that act on the tribofilm, and the words before their name."""
    for name, point in duty_points(scene):
        if scene.heat.bulk.from_inputs:
            yield from ((f"{name}: body {i + 1}, ", warm) for i, warm in enumerate(point.bodies))
        else:
            yield f"{name}.", point.temperature


def warnings(scene: SceneFields) -> list[str]:
    """Return sentences on what can be computed but is not resolved well."""
    found = []
    for name, surface in (("surface_1", scene.surface_1), ("surface_2", scene.surface_2)):
        found += [f"{name} {sentence}" for sentence in surface.warnings(scene.film.spacing)]
        if not scene.film.on_grid and not surface.fitted:
            found.append(
                f"{name} is taken for Gaussian roughness without lay by film.model = '{scene.film.name}': its curves "
                "are fitted to that, and their errors do not hold."
            )
    if not scene.tribofilm.covers(scene.operation.temperature):
        found.append(
            f"The tribofilm's constants are extrapolated: they do not hold at {scene.operation.temperature:g} K."
        )
    given = (scene.operation.body_temperature_1, scene.operation.body_temperature_2)
    if given != (None, None) and not scene.heat.bulk.from_inputs:
        found.append(f"heat.bulk = '{scene.heat.bulk.name}' does not use operation.body_temperature_1 and _2.")
    layer = scene.lubricant.double_layer
    if layer.acts and not scene.film.on_grid:
        found.append(
            f"film.model = '{scene.film.name}' leaves out lubricant.double_layer = '{layer.name}': it knows the mean "
            "film alone, and double layers act where the film is as thin as they are."
        )
    if scene.scuffing.judges and not scene.heat.warms_film:
        found.append(
            f"heat.model = '{scene.heat.name}' knows no temperature of each node: scuffing_ratio leaves the hottest "
            "spots out, or depends on the grid. Use heat.model = 'field'."
        )
    left_out = [
        name
        for name, given in (
            (f"plasticity.indentation = '{scene.plasticity.indentation}'", scene.plasticity.indentation != "none"),
            ("solids.film_modulus", scene.solids.film_modulus is not None),
        )
        if given
    ]
    if left_out and not scene.film.on_grid:
        found.append(
            f"film.model = '{scene.film.name}' leaves out {' and '.join(left_out)}: it has no nodes that yield."
        )
    return [*found, *scene.film.warnings(scene.lubricant.flow, scene.lubricant.rheology, scene.tribofilm)]
