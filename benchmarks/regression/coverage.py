"""Coverage of tracks and smoothing by wear over two hours: fitted constants of the regression level.

    python -m benchmarks.regression.coverage   # six runs of two hours: 8 min

Solved runs stay in results/regression. Writes docs/measured/regression/coverage.md.
"""

from dataclasses import replace

import numpy as np

from benchmarks.pages import Page
from benchmarks.regression.fit import fitted
from benchmarks.regression.points import RUBBING, SCENES, Columns, joined, observe_rubbed, rubbed_points, run, solved
from contact_core import Scene
from contact_core.film import Regression
from contact_core.laws.load_sharing import FittedSharing

LITTLE = 0.25  # wear over composite roughness
BODIES = ("rougher", "smoother")
WITHIN = 0.05  # rms of a growth over the full thickness
STEPS = 4  # of growth in a minute
Array = np.ndarray


class Rubbed:
    """Tracks after up to two hours of rubbing: one number for each run and each of `RUBBING` minutes."""

    def __init__(self, columns: Columns) -> None:
        self.columns = columns
        reference = {name: Scene.from_toml(name) for name in np.unique(columns["scene"])}
        track = np.array([reference[name].hertz(reference[name].operation.load).b for name in columns["scene"]])
        self.width = np.minimum(columns["width"] / track, 1.0)[:, None]  # share of the track that is in the contact

    def of(self, name: str, body: str) -> Array:
        """One of the numbers of a body [runs, minutes]."""
        return self.at(f"{name}_{body}")

    def at(self, name: str) -> Array:
        """One of the numbers of the contact [runs, minutes]."""
        return np.stack([self.columns[f"{name}_{minute}"] for minute in RUBBING], axis=1)

    def grown(self, law: FittedSharing, body: str) -> Array:
        """Growth over the law's full thickness that a coverage by the law leads to under the solved area [runs, minutes]."""
        return np.array([self._run(law, body, k) for k in range(len(self.width))])

    def misfit(self, law: FittedSharing, body: str) -> Array:
        """The same, less the solved growth."""
        return self.grown(law, body) - self.of("growth", body)

    def _run(self, law: FittedSharing, body: str, k: int) -> list[float]:
        scene, rougher, width = Scene.from_toml(self.columns["scene"][k]), body == "rougher", float(self.width[k, 0])
        tribofilm, length = scene.tribofilm, scene.track_lengths[scene.rougher if rougher else 1 - scene.rougher]
        residence = 0.5 * np.pi * float(self.columns["width"][k]) * width / length
        rate = tribofilm.rate(float(self.columns["temperature"][k])) / tribofilm.contact_share * residence
        growth, found = 0.0, []
        for minute in range(1, RUBBING[-1] + 1):
            area = float(np.interp(minute, RUBBING, self.at("area")[k]))
            exposed = float(law.exposed(area, rougher=rougher, dry=False))
            for _ in range(STEPS):
                coverage = max(width * float(law.coverage(exposed, min(growth / width, 1.0), rougher=rougher)), growth)
                growth += (coverage - growth) * -np.expm1(-rate * area * 60.0 / STEPS / coverage)
            if minute in RUBBING:
                found.append(growth)
        return found

    @property
    def fresh(self) -> Array:
        """Where wear has not yet brought other parts of the rougher body into contact [runs, minutes]."""
        return self.of("worn", "rougher") < LITTLE

    def smoothing(self) -> Array:
        """`film.smoothing` of the rougher body of each run, from the roughness of its solid at the end."""
        smoothed, worn = self.of("smoothed", "rougher"), self.of("worn", "rougher")
        return -np.log(smoothed[:, -1]) / worn[:, -1]


def main() -> None:
    page = Page("regression/coverage", "The regression level: coverage of tracks and smoothing by wear")
    rubbed = Rubbed(solved(joined(run(f"rubbed_{name}", rubbed_points(name), {}, observe_rubbed) for name in SCENES)))
    shipped, fresh = FittedSharing(), rubbed.fresh
    page.say(
        f"{rubbed.columns['load'].size} runs of two hours on the scenes' own grids: as shipped, at two fifths of the load, and with a film of .3 of the roughness, "
        f"looked at after {', '.join(map(str, RUBBING))} minutes. The spread V of the exposures is fitted to the growth of both tracks that follows from the coverage by the law, with the solved area. "
        f"Fitted where less than {LITTLE:g} of the composite roughness is worn: wear then brings other parts into contact, and the coverage is larger than the curve's."
    )
    page.header("constant", "fitted", "half width", "shipped")
    laws = {}
    for body in BODIES:
        name = f"exposure_spread_{body}"

        def law(spread: float, name: str = name) -> FittedSharing:
            return replace(shipped, **{name: float(spread)})

        found, widths, _ = fitted(
            lambda x, body=body, law=law: rubbed.misfit(law(x[0]), body)[fresh], [getattr(shipped, name)]
        )
        laws[body] = law(found[0])
        page.row(name, f"{found[0]:.4g}", f"{widths[0]:.2g}", f"{getattr(shipped, name):.4g}")
    page.say("Growth over the full thickness, about the solved one:")
    page.header("body", "scatter", "largest error", "with more wear")
    for body in BODIES:
        off = rubbed.misfit(laws[body], body)
        scatter = float(np.sqrt(np.mean(off[fresh] ** 2)))
        page.row(body, f"{scatter:.3f}", f"{np.abs(off[fresh]).max():.3f}", f"{np.abs(off).max():.3f}")
        page.verdict(
            f"growth of the {body} body within {WITHIN:g} rms of the solved one", f"{scatter:.3f}", scatter <= WITHIN
        )
    page.say("Growth over the full thickness, solved and by the shipped constants:")
    films = {body: rubbed.grown(shipped, body) for body in BODIES}
    page.header("run", "body", *(f"{minute} min" for minute in RUBBING))
    for k, name in enumerate(rubbed.columns["scene"]):
        for body in BODIES:
            deep, fast = rubbed.of("growth", body)[k], films[body][k]
            page.row(
                f"`{name}`, {rubbed.columns['load'][k]:.3g} N, lambda {rubbed.columns['lambda'][k]:.2g}",
                body,
                *(f"{a:.2f} / {b:.2f}" for a, b in zip(deep, fast, strict=True)),
            )
    smoothing = np.sort(rubbed.smoothing())
    page.say(
        f"Smoothing by wear (`film.smoothing`), from the roughness of the rougher body's solid after two hours: {smoothing[0]:.2g} to {smoothing[-1]:.2g}, "
        f"median {np.median(smoothing):.2g}, shipped {Regression.smoothing:.2g}. It is faster at first, and slower the more is worn."
    )
    page.write()


if __name__ == "__main__":
    main()
