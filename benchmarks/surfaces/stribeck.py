"""Shift of the Stribeck curves of the shipped scenes after two hours of rubbing, with and without tribofilm.

    python -m benchmarks.surfaces.stribeck                      what is not yet in results/surfaces/stribeck, then the page
    python -m benchmarks.surfaces.stribeck mtm_zddp --again     this scene only, and anew, after a change of the core
    python -m benchmarks.surfaces.stribeck --times 0,30 --points 6 --set film.points=65 surface_1.correlation_length="16 um" \
surface_2.correlation_length="16 um"              a quick look

Writes docs/measured/surfaces/stribeck.md, docs/measured/surfaces/stribeck.png and docs/measured/surfaces/stribeck_SCENE.png. About five minutes for each scene and tribofilm, one
thread.
"""

import argparse
import json
import shlex
import sys
import time
from itertools import product

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from benchmarks.dependencies import kept
from benchmarks.folders import MEASURED
from benchmarks.pages import save
from contact_core import Scene, shipped_scenes
from system_models.charts import files
from system_models.run import stribeck_report
from system_models.run.duty import Duty
from system_models.run.stribeck import Curves, Plan, measure
from system_models.store.results import write

DOCS, KEPT = MEASURED / "surfaces", kept("surfaces/stribeck")
FASTEST, SLOWEST = 10.0, 0.003  # m/s, as the command has them
BOUNDARY = 0.09, 0.14  # friction of ZDDP films
TRIBOFILMS: dict[str, dict[str, str]] = {"ZDDP": {}, "none": {"tribofilm.model": "none"}}
COLOURS = {"ZDDP": "#D55E00", "none": "#0072B2"}


def curves_of(name: str, tribofilm: str, args: argparse.Namespace) -> xr.Dataset:
    """The curves of a scene, from results/surfaces/stribeck if they are there."""
    scene = Scene.from_toml(name, dict(args.settings) | TRIBOFILMS[tribofilm])
    duty = Duty.of_scene(scene)
    curves = Curves(Plan.of(duty, args.times, FASTEST, SLOWEST, args.points))
    asked, file = curves.dataset(scene, duty), KEPT / f"{name}-{tribofilm}.nc"
    if file.exists() and not args.again:
        with xr.open_dataset(file) as stored:
            same = all(stored.attrs.get(key) == asked.attrs[key] for key in ("scene_json", "duty"))
            if same and all(stored[axis].equals(asked[axis]) for axis in asked.dims):
                return stored.load()
    start = time.process_time()
    measure(scene, duty, curves)
    found = curves.dataset(scene, duty).assign_attrs(seconds=time.process_time() - start)
    KEPT.mkdir(parents=True, exist_ok=True)
    write(found, KEPT, file.stem)
    print(f"{file.stem}: {found.attrs['seconds']:.0f} s", *stribeck_report.shift_lines(found), sep="\n", flush=True)
    return found


def exponent(found: xr.Dataset) -> float:
    """n of transition speed ~ roughness^n, fitted to the curves of one contact."""
    speed, rough = found["transition_speed"].values, found["composite_roughness"].values
    known = np.isfinite(speed)
    if known.sum() < 3:
        return float("nan")
    return float(np.polyfit(np.log(rough[known]), np.log(speed[known]), 1)[0])


def at_transition(curve: xr.Dataset, values: np.ndarray) -> float:
    """Values along the speeds of one curve, at its transition."""
    speeds, transition = np.log(curve["entrainment_speed"].values), np.log(float(curve["transition_speed"]))
    return float(np.interp(transition, speeds[::-1], values[::-1])) if np.isfinite(transition) else float("nan")


def film_exponent(found: xr.Dataset) -> float:
    """m of h_c ~ speed^m at the transition of the first curve."""
    curve = found.isel(rubbing_time=0)
    return at_transition(curve, np.gradient(np.log(curve["h_c"].values), np.log(curve["entrainment_speed"].values)))


def number(value: float, digits: int = 3) -> str:
    return f"{value:.{digits}g}" if np.isfinite(value) else ""


def shift_table(found: xr.Dataset) -> list[str]:
    """A row for each rubbing time."""
    lines = [
        "| rubbed min | W_c = 0.5 at m/s | against 0 min | lambda there | "
        f"friction {found.attrs['friction_midway']:.3f} at m/s | friction at {SLOWEST:g} m/s | at {FASTEST:g} m/s "
        "| tribofilm nm, ball, disc | its roughness nm, ball, disc | roughness of both surfaces nm | against 0 min |",
        "|" + "---|" * 11,
    ]
    first = found.isel(rubbing_time=0)
    for i, minutes in enumerate(stribeck_report.minutes(found)):
        row = found.isel(rubbing_time=i)
        friction = row["friction_coefficient"].values
        nm = {
            name: 1e9 * float(row[name])
            for name in row.data_vars
            if row[name].attrs["units"] == "m" and not row[name].dims
        }
        cells = [
            minutes,
            number(float(row["transition_speed"])),
            number(float(row["transition_speed"] / first["transition_speed"])),
            number(at_transition(row, row["lambda_ratio"].values)),
            number(float(row["transition_speed_friction"])),
            f"{friction[-1]:.4f}",
            f"{friction[0]:.4f}",
            f"{nm['tribofilm_1']:.0f}, {nm['tribofilm_2']:.0f}",
            f"{nm['tribofilm_roughness_1']:.1f}, {nm['tribofilm_roughness_2']:.1f}",
            f"{nm['composite_roughness']:.1f}",
            f"{float(row['composite_roughness'] / first['composite_roughness']):.2f}",
        ]
        lines.append(f"| {' | '.join(cells)} |")
    return lines


def verdicts(all_curves: dict[tuple[str, str], xr.Dataset]) -> list[str]:
    lines = ["| asked | found | met? |", "|---|---|---|"]
    for (name, tribofilm), found in all_curves.items():
        if tribofilm == "none":
            continue
        speed, rough = found["transition_speed"].values, found["composite_roughness"].values
        rougher = rough[1:] > rough[0]
        factors = speed[1:] / speed[0]
        met = bool(rougher.any() and (factors[rougher] > 1.0).all())
        told = ", ".join(number(factor) for factor in factors)
        lines.append(
            f"| {name}: at every time at which the film has made the surfaces rougher the transition is at a higher speed "
            f"| {rougher.sum()} of {rougher.size} times rougher; speed against 0 min: {told} | {'yes' if met else '**no**'} |"
        )
        slow = found["friction_coefficient"].values[:, -1]
        inside = bool((slow >= BOUNDARY[0]).all() and (slow <= BOUNDARY[1]).all())
        lines.append(
            f"| {name}: friction at the slowest speed within {BOUNDARY[0]} to {BOUNDARY[1]} "
            f"| {slow.min():.3f} to {slow.max():.3f} | {'yes' if inside else '**no**'} |"
        )
    return lines


def picture(all_curves: dict[tuple[str, str], xr.Dataset]) -> Figure:
    """Transition speed against roughness, a path through the rubbing times for each contact."""
    figure = Figure(figsize=(6.4, 4.6), layout="constrained")
    axis = figure.add_subplot()
    markers = dict(zip(dict.fromkeys(name for name, _ in all_curves), "os^vDP", strict=False))
    for (name, tribofilm), found in all_curves.items():
        x, y = 1e9 * found["composite_roughness"].values, found["transition_speed"].values
        axis.plot(
            x, y, f"{markers[name]}-", color=COLOURS[tribofilm], linewidth=1.0, label=f"{name}, tribofilm {tribofilm}"
        )
        for i, minutes in enumerate(stribeck_report.minutes(found)):
            if tribofilm != "none" and np.isfinite(y[i]):
                axis.annotate(minutes, (x[i], y[i]), textcoords="offset points", xytext=(5, 3), fontsize="x-small")
    axis.set_yscale("log")
    axis.set_xlabel("roughness of both surfaces together [nm]; numbers: rubbing time [min]")
    axis.set_ylabel("entrainment speed at which $W_c$ = 0.5 [m/s]")
    axis.legend(frameon=False, fontsize="small")
    axis.spines[["top", "right"]].set_visible(False)
    return figure


def page(all_curves: dict[tuple[str, str], xr.Dataset], options: str) -> list[str]:
    lines = [
        "# Stribeck curves while the tribofilm grows",
        "",
        f"Written by `python -m benchmarks.surfaces.stribeck{options}`; one scene alone: `tribofmu stribeck SCENE`. The contact is rubbed at its "
        "duty and stopped at each of the times; its surfaces then pass through all speeds unchanged, at the duty's slide-to-roll ratio, load and temperature. The transition is the speed at which the solids carry half of the "
        "load; for friction, the speed at which it is midway between the extremes of all curves of that contact.",
        "",
        "Measured Stribeck curves of ZDDP oils shift to higher speed as the film roughens (Dawczyk, Morgan, Russo and Spikes, "
        "Tribology Letters 67, 2019, 34, [10.1007/s11249-019-1148-9](https://doi.org/10.1007/s11249-019-1148-9)).",
        "",
        *verdicts(all_curves),
        "",
        "![transition speed against roughness](stribeck.png)",
        "",
        "## Shift and roughness",
        "",
        "n: of transition speed ~ roughness^n, fitted to the curves of one contact; m: of h_c ~ speed^m at the transition of "
        "the fresh surfaces, 0.67 only where no solids hold the gap open. If W_c depended on the lambda ratio alone, n would be "
        "1/m and lambda at the transition the same in all rows of the tables below; where it is higher, the shape of the tribofilm also holds the surfaces apart.",
        "",
        "| scene | tribofilm | n | m | 1/m | CPU s |",
        "|---|---|---|---|---|---|",
    ]
    for (name, tribofilm), found in all_curves.items():
        m = film_exponent(found)
        cells = (number(exponent(found)), number(m), number(1.0 / m), f"{found.attrs['seconds']:.0f}")
        lines.append(f"| {name} | {tribofilm} | {' | '.join(cells)} |")
    for (name, tribofilm), found in all_curves.items():
        scene = Scene.from_dict(json.loads(found.attrs["scene_json"]))
        lines += ["", f"## {name}, tribofilm {tribofilm}", "", *shift_table(found), ""]
        lines += [f"{scene.film.points} nodes a side. {' '.join(stribeck_report.closing_lines(found))}"]
        if tribofilm != "none":
            lines += ["", f"![Stribeck curves of {name}](stribeck_{name}.png)"]
            files.save(stribeck_report.sheet(found), DOCS / f"stribeck_{name}.png")
    return lines


def setting(text: str) -> tuple[str, str]:
    key, _, value = text.partition("=")
    return key, value


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "scenes", nargs="*", default=[name for name in shipped_scenes() if not name.endswith("_thesis")]
    )
    parser.add_argument("--times", default="0,5,15,30,60,120", help="minutes")
    parser.add_argument("--points", type=int, default=12)
    parser.add_argument("--set", dest="settings", nargs="+", default=[], type=setting)
    parser.add_argument("--again", action="store_true", help="measure anew")
    args = parser.parse_args()
    args.times = [60.0 * float(minutes) for minutes in args.times.split(",")]
    all_curves = {
        (name, tribofilm): curves_of(name, tribofilm, args) for name, tribofilm in product(args.scenes, TRIBOFILMS)
    }
    options = shlex.join(word for word in sys.argv[1:] if word != "--again")
    lines = page(all_curves, f" {options}" if options else "")
    picture(all_curves).savefig(DOCS / "stribeck.png", dpi=150)
    save("surfaces/stribeck", "\n".join(lines))
    print("\n".join(lines))


if __name__ == "__main__":
    main()
