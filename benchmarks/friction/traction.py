"""Friction: traction curves at full film, continuity in speed and through reversal, derivatives held and total.

    python -m benchmarks.friction.traction

Writes docs/measured/friction/traction.md and docs/measured/friction/traction.png.
"""

import argparse
from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure
from scipy.integrate import quad

from benchmarks.folders import MEASURED
from benchmarks.pages import cells, save
from contact_core import OperatingPoint, Scene, advance, initial_state, solve

DOCS = MEASURED / "friction"
OILS = {
    "Newtonian": {"lubricant.rheology.model": "newtonian", "lubricant.rheology.limiting_coefficient": "0"},
    "Newtonian, limit 0.047": {"lubricant.rheology.model": "newtonian", "lubricant.rheology.limiting_coefficient": "0.047"},
    "Eyring 5 MPa": {"lubricant.rheology.limiting_coefficient": "0"},
    "Eyring 5 MPa, limit 0.047": {},
    "Carreau 5 MPa, n = 0.5": {
        "lubricant.rheology.model": "carreau",
        "lubricant.rheology.critical_stress": "5 MPa",
        "lubricant.rheology.exponent": "0.5",
        "lubricant.rheology.limiting_coefficient": "0",
    },
}  # fmt: skip
SMOOTH = {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm", "tribofilm.model": "none", "heat.model": "none"}
FULL_FILM = SMOOTH | {"film.tolerance": "1e-4"}
LOAD, SPEED = 77.85, 4.0  # N, m/s


def at(scene: Scene, speed: float, ratio: float, load: float | None = None) -> OperatingPoint:
    """Entrainment at `speed` with a slide-to-roll ratio."""
    one, two = speed * (1.0 + 0.5 * ratio), speed * (1.0 - 0.5 * ratio)
    point = replace(scene.operation.point, speed_1=one, speed_2=two)
    return point if load is None else replace(point, load=load)


def friction_of(scene: Scene, op: OperatingPoint) -> float:
    """Signed friction force on body 1 over the load, surfaces fresh."""
    fields = solve(scene, op, initial_state(scene))
    return (fields.friction.force_solid + fields.friction.force_fluid) / op.load


def hertz_stiffness(scene: Scene) -> float:
    """Integral of the viscosity under Hertz's pressure [Pa s m2]."""
    hertz, oil, temperature = scene.hertz(LOAD), scene.lubricant, scene.operation.temperature

    def stiff(r: float) -> float:
        pressure = hertz.pressure_max * np.sqrt(1.0 - r * r)
        return float(oil.viscosity(np.array([pressure]), temperature)[0]) * 2.0 * np.pi * r

    return quad(stiff, 0.0, 1.0)[0] * hertz.a**2


def traction() -> tuple[list[str], dict[str, np.ndarray]]:
    ratios = np.geomspace(1e-9, 2.0, 40)
    curves, rows = {"ratio": ratios}, []
    for name, oil in OILS.items():
        scene = Scene.from_toml("azam_case_a", FULL_FILM | {"operation.load": f"{LOAD} N"} | oil)
        mu = np.array([-friction_of(scene, at(scene, SPEED, ratio)) for ratio in ratios])
        curves[name] = mu
        fields = solve(scene, at(scene, SPEED, 0.0), initial_state(scene))
        lubricant = scene.lubricant
        viscosity = lubricant.viscosity(fields.fluid_pressure, scene.operation.temperature)
        slope = float((viscosity / fields.gap).sum()) * scene.film.spacing**2 * SPEED / LOAD
        central = float(fields.gap[scene.film.points // 2, scene.film.points // 2])
        hertzian = hertz_stiffness(scene) / central * SPEED / LOAD
        limit = lubricant.rheology.limiting_coefficient
        rows.append(
            [
                name,
                mu[0] / ratios[0],
                slope,
                hertzian,
                mu[-1],
                limit * float(fields.fluid_pressure.sum()) * scene.film.spacing**2 / LOAD or "-",
            ]
        )
    lines = [
        "## Traction at full film",
        "",
        f"Case A's ball and oil, smooth, {LOAD:g} N, {SPEED:g} m/s, isothermal. `slope`: mu / SRR at SRR = 1e-9; besides, the sum of",
        "eta u_e / (h W) over the solved film, and that of Hertz's pressure under an even central film (by quadrature,",
        "an approximation). `limit`: mu at SRR = 2 against Lambda times the share of the load on the grid.",
        "",
        cells(["oil", "slope", "of the film", "Hertz, even film", "mu at SRR 2", "Lambda p"]),
        cells(["---"] * 6),
        *map(cells, rows),
    ]
    lines += [
        "",
        "At SRR 2 the annulus of low pressure around the contact has not reached its limit: 1.6 % of the load.",
    ]
    return lines, curves


def continuity() -> tuple[list[str], dict[str, np.ndarray]]:
    """The largest step of mu from one speed to the next, 24 a decade, on both levels."""
    lines, curves = (
        [
            "## Continuity",
            "",
            "Largest step of mu from one speed to the next, SRR of the scene; fresh surfaces. Below 1e-4 m/s the step is that of",
            "the boundary law itself (`slip_speed`).",
            "",
        ],
        {},
    )
    lines += [
        cells(["scene", "level", "speeds m/s", "mu from", "to", "largest step of mu", "at m/s"]),
        cells(["---"] * 7),
    ]
    for name in ("azam_case_a", "mtm_zddp"):
        for level, per_decade in (("regression", 24), ("deterministic", 4)):
            scene = Scene.from_toml(name).at_level(level)
            ratio = scene.operation.point.sliding_speed / scene.operation.point.entrainment_speed
            speeds = np.geomspace(1e-5, 10.0, 6 * per_decade + 1)
            state = initial_state(scene)
            points = [at(scene, speed, ratio) for speed in speeds]
            mu = [advance(scene, op, state, 0.0)[1].friction_coefficient for op in points]
            steps = np.abs(np.diff(mu))
            where = int(steps.argmax())
            lines.append(
                cells(
                    [
                        name,
                        f"{level}, {per_decade} a decade",
                        "1e-5 to 10",
                        mu[0],
                        mu[-1],
                        float(steps.max()),
                        float(speeds[where]),
                    ]
                )
            )
            print(lines[-1], flush=True)
            curves[f"{name}, {level}"] = np.array([speeds, mu])
    return lines, curves


INPUTS = {
    "speed at fixed SRR": lambda op, k: replace(op, speed_1=op.speed_1 * k, speed_2=op.speed_2 * k),
    "load": lambda op, k: replace(op, load=op.load * k),
    "temperature": lambda op, k: replace(op, temperature=op.temperature + 50.0 * (k - 1.0)),
}


def elasticity(out: object, op: OperatingPoint, name: str) -> float:
    """d ln F / d ln input from the derivative outputs; of temperature, per 50 K."""
    d = {key: getattr(out, f"dfriction_d{key}") for key in ("speed_1", "speed_2", "load", "temperature")}
    force = out.friction_force  # type: ignore[attr-defined]
    if name == "load":
        return d["load"] * op.load / force
    if name == "temperature":
        return d["temperature"] * 50.0 / force
    return (d["speed_1"] * op.speed_1 + d["speed_2"] * op.speed_2) / force


def held_and_total() -> list[str]:
    lines = [
        "## Derivatives: held film against total",
        "",
        "d ln F / d ln input (temperature: per 50 K). `held`: outputs of the deterministic level, at a held film and held shares;",
        "`total`: outputs of the regression level; `solved again`: the deterministic level at the input 20 % (10 K) to",
        "either side, fresh surfaces; it scatters by a few hundredths.",
        "",
        cells(["scene", "speed m/s", "mu", "W_c", "input", "held", "total", "solved again"]),
        cells(["---"] * 8),
    ]
    for name in ("azam_case_a", "mtm_zddp"):
        scene = Scene.from_toml(name, {"tribofilm.model": "none"})
        fast, point = scene.at_level("regression"), scene.operation.point
        for factor in (0.1, 1.0, 10.0, 30.0):
            op = INPUTS["speed at fixed SRR"](point, factor)
            held = advance(scene, op, initial_state(scene), 0.0)[1]
            total = advance(fast, op, initial_state(fast), 0.0)[1]
            for given, change in INPUTS.items():
                more, less = (
                    advance(scene, change(op, k), initial_state(scene), 0.0)[1].friction_force for k in (1.2, 0.8)
                )
                width = 0.4 if given == "temperature" else np.log(1.2 / 0.8)
                again = float(np.log(more / less)) / width
                lines.append(
                    cells(
                        [
                            name,
                            float(op.entrainment_speed),
                            held.friction_coefficient,
                            held.contact_load_ratio,
                            given,
                            elasticity(held, op, given),
                            elasticity(total, op, given),
                            again,
                        ]
                    )
                )
                print(lines[-1], flush=True)
    return lines


def plot(curves: dict[str, np.ndarray], speeds: dict[str, np.ndarray]) -> None:
    figure = Figure(figsize=(9.0, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    for name, mu in curves.items():
        if name != "ratio":
            left.loglog(curves["ratio"], mu, label=name)
    left.set(xlabel="slide-to-roll ratio", ylabel="friction coefficient", title="traction at full film")
    for k, (name, (speed, mu)) in enumerate(speeds.items()):
        level = name.split(", ")[1]
        right.semilogx(speed, mu, "-" if level == "regression" else "o", color=f"C{k // 2}", ms=4, label=name)
    right.set(
        xlabel="entrainment speed, m/s",
        ylabel="friction coefficient",
        title="from boundary to full film, fresh surfaces",
    )
    for axes in (left, right):
        axes.grid(alpha=0.3)
        axes.legend(fontsize="x-small")
    figure.savefig(DOCS / "traction.png", dpi=130)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.parse_args()
    first, curves = traction()
    print(*first, sep="\n", flush=True)
    second, speeds = continuity()
    third = held_and_total()
    plot(curves, speeds)
    head = [
        "# Friction",
        "",
        "Written by `python -m benchmarks.friction.traction`.",
        "",
        "![friction](traction.png)",
        "",
    ]
    save("friction/traction", "\n".join([*head, *first, "", *second, "", *third]))


if __name__ == "__main__":
    main()
