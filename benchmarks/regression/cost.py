"""Cost of a step at the regression level, film.model = "regression".

    python -m benchmarks.regression.cost

Writes docs/measured/regression.md: the median and the 90 % range of the time of `advance` over 10 000 steps of 1 ms with
inputs that change from step to step, with the temperature held (its viscosity is remembered) and with it changing, too,
of the shipped scenes and of one with other laws. After every hundred steps as many array operations of nine numbers are
timed. "over np.exp" is the median over these stretches of the ratio of both medians: of what the machine and others on it
do to the cost of a step, it shows the least.
"""

import time
from dataclasses import replace

import numpy as np

from benchmarks.pages import save
from contact_core import OperatingPoint, Scene, advance, initial_state

STEPS, STEP = 10_000, 1e-3  # s
STRETCH = 100  # steps between which the machine is measured
LUMPED = {"heat.bulk.model": "lumped"} | {
    f"heat.bulk.{name}": value
    for i in (1, 2)
    for name, value in ((f"heat_capacity_{i}", "20 J/K"), (f"conductance_{i}", "0.5 W/K"))
}
OIL, FIELD, INLET = {"lubricant.set": "fva3"}, {"heat.model": "field"}, {"heat.inlet_shear": "gupta"}
OPTIONS = {
    "heat none": {"heat.model": "none"},
    "oil fva3": OIL,
    "inlet_shear gupta": INLET,
    "tribofilm zhang_spikes": {"tribofilm.set": "zhang_spikes_80c_ethylhexyl"},
    "bulk lumped": LUMPED,
    "heat field": FIELD,
    "all of them": OIL | FIELD | INLET | LUMPED | {"tribofilm.set": "zhang_spikes_80c_ethylhexyl"},
}


def duty(op: OperatingPoint, warmth: float, seed: int = 1) -> list[OperatingPoint]:
    """Operating points about one of reference, each other than the one before."""
    random = np.random.Generator(np.random.Philox(seed))
    rows = (1.0 + 0.1 * random.uniform(-1.0, 1.0, (STEPS, 3))).tolist()
    warmer = (warmth * random.uniform(-1.0, 1.0, STEPS)).tolist()
    return [
        replace(
            op,
            load=op.load * load,
            speed_1=op.speed_1 * first,
            speed_2=op.speed_2 * second,
            temperature=op.temperature + more,
        )
        for (load, first, second), more in zip(rows, warmer, strict=True)
    ]


def times(name: str, changes: dict[str, str], warmth: float) -> tuple[list[float], list[float]]:
    """Microseconds of each step of a scene at the regression level, and of array operations in between."""
    scene = Scene.from_toml(name, changes).at_level("regression")
    points = duty(scene.operation.point, warmth)
    state, found, units = advance(scene, points[0], initial_state(scene), 60.0)[0], [], []
    for number, op in enumerate(points, 1):
        start = time.perf_counter()
        state, _ = advance(scene, op, state, STEP)
        found.append(1e6 * (time.perf_counter() - start))
        if number % STRETCH == 0:
            units += unit()
    return found, units


def unit() -> list[float]:
    """Microseconds of exponentials of nine numbers."""
    array, found = np.full(9, 0.3), []
    for _ in range(STRETCH):
        start = time.perf_counter()
        np.exp(array)
        found.append(1e6 * (time.perf_counter() - start))
    return found


def main() -> None:
    lines = [
        "# Cost of a step at the regression level",
        "",
        "Written by `python -m benchmarks.regression.cost`.",
        "",
        "| scene | laws | inputs that change | median [us] | 5 % [us] | 95 % [us] | np.exp of nine numbers [us] | over np.exp |",
        "|---|---|---|---|---|---|---|---|",
    ]
    print(*lines[-2:], sep="\n")
    cases = [(name, "as shipped", {}, warmth) for name in ("azam_case_a", "mtm_zddp") for warmth in (0.0, 2.0)]
    cases += [("mtm_zddp", laws, changes, 2.0) for laws, changes in OPTIONS.items()]
    for name, laws, changes, warmth in cases:
        found, units = times(name, changes, warmth)
        low, middle, high = np.percentile(found, [5, 50, 95])
        operation = float(np.median(units))
        stretches = (np.median(np.reshape(each, (-1, STRETCH)), axis=1) for each in (found, units))
        ratio = float(np.median(np.divide(*stretches)))
        inputs = "load, speeds, temperature" if warmth else "load, speeds"
        cost = f"{middle:.1f} | {low:.1f} | {high:.1f} | {operation:.2f} | {ratio:.0f}"
        lines.append(f"| {name} | {laws} | {inputs} | {cost} |")
        print(lines[-1], flush=True)
    save("regression/cost", "\n".join(lines))


if __name__ == "__main__":
    main()
