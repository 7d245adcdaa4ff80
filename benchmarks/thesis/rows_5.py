"""Chapter 5: growth of the tribofilm."""

import numpy as np

from benchmarks.thesis.cases import SNAPSHOTS, SRR, Get, Run, srr_name
from benchmarks.thesis.rows import (
    Claim,
    Experiment,
    Finding,
    Measure,
    cannot,
    inside,
    nm,
    overshoot,
    peak,
    rising,
    spread,
    two_hours,
    values,
)
from contact_core import Scene
from contact_core.reference import ghanbarzadeh_thickness

LENGTH = Experiment("dose by contact length instead of the clock", {"A": "A_length"})
CLOCK = Experiment("dose by the clock", {"A": "A_clock"})
BOUNDARY = "boundary lubrication (blocks driven by dry contacts)"
DRY = Experiment(BOUNDARY, {"A": "A_dry"})
SLIDING = Experiment(f"{BOUNDARY}, wear by u_1 - u_2", {srr_name(srr): srr_name(srr, "A_sliding") for srr in SRR})
WHITE = Experiment("correlation length of one node", {"A": "A_white"})


def in_the_track(get: Get) -> Finding:
    run = get("A")
    film = [(name, run.map(name)) for name in ("film_1_20", "film_2_20")]
    shares = [f[inside(run, 1.2, name)].sum() / f.sum() for name, f in film]
    return Finding(f"ball {100 * shares[0]:.1f} %, disc {100 * shares[1]:.1f} %", min(shares) >= 0.95)


def _coverage_grows(get: Get) -> Finding:
    covers = [[get("A").at(f"coverage_{i}", minute) for minute in SNAPSHOTS] for i in (1, 2)]
    text = f"disc {values(covers[1], 1.0)}; ball {values(covers[0], 1.0)}"
    return Finding(text, rising(covers[1]))


def _mean_grows(get: Get) -> Finding:
    films = [[get("A").at(f"tribofilm_{i}", minute) for minute in SNAPSHOTS] for i in (1, 2)]
    return Finding(f"disc {values(films[1])} nm; ball {values(films[0])} nm", rising(films[1]))


def _patchy(get: Get) -> Finding:
    run = get("A")
    film = run.map("film_2_20")[inside(run, field="film_2_20")]
    ratio = float(film.std() / film.mean())
    return Finding(f"{ratio:.2f}", ratio > 0.25)


def _full_cover(get: Get) -> Finding:
    run = two_hours(get("A"))
    covered = run["coverage_1"] >= 0.95
    minute = float(run.t[np.argmax(covered)]) if covered.any() else float("nan")
    return Finding(f"{minute:.0f} min; {run.end('coverage_1'):.2f} at the end", bool(minute <= 10.0))


def _overshoot_ball(get: Get) -> Finding:
    run = two_hours(get("A"))
    minute, height = peak(run, "tribofilm_covered_1")
    ratio = overshoot(run, "tribofilm_covered_1")
    return Finding(f"{ratio:.2f}: {nm(height)} at {minute:.0f} min, {nm(run.end('tribofilm_covered_1'))}", ratio >= 1.2)


def _overshoot_all_nodes(get: Get) -> Finding:
    run = two_hours(get("A"))
    ratio = overshoot(run, "tribofilm_1")
    return Finding(f"{ratio:.2f}", ratio >= 1.2)


def _ball_in_20(get: Get) -> Finding:
    minute, _ = peak(two_hours(get("A")), "tribofilm_covered_1")
    return Finding(f"{minute:.0f} min", 8.0 <= minute <= 25.0)


def _low_cover(get: Get) -> Finding:
    run = two_hours(get("A"))
    means = [run.mean(f"coverage_{i}") for i in (1, 2)]
    return Finding(f"disc {means[1]:.2f}, ball {means[0]:.2f}", means[1] < means[0] - 0.05)


def _disc_thicker(kind: str) -> Measure:
    def measure(get: Get) -> Finding:
        run = two_hours(get("A"))
        means = [run.mean(f"{kind}_{i}") for i in (1, 2)]
        return Finding(f"disc {nm(means[1])}, ball {nm(means[0])}", means[1] > means[0])

    return measure


def _first_to_peak(run: Run, name: str) -> float:
    return float(run.t[np.argmax(run[name] >= 0.9 * run[name].max())])


def _disc_quicker(get: Get) -> Finding:
    run = two_hours(get("A"))
    ball, disc = (_first_to_peak(run, f"tribofilm_covered_{i}") for i in (1, 2))
    return Finding(f"disc {disc:.0f} min, ball {ball:.0f} min", disc <= ball)


def _disc_overshoot(kind: str) -> Measure:
    def measure(get: Get) -> Finding:
        run = two_hours(get("A"))
        ball, disc = (overshoot(run, f"{kind}_{i}") for i in (1, 2))
        return Finding(f"disc {disc:.2f}, ball {ball:.2f}", disc < ball)

    return measure


def _final_films(get: Get) -> Finding:
    ends = [two_hours(get(srr_name(srr))).end("tribofilm_covered_1") for srr in SRR]
    return Finding(f"{values(ends)} nm; spread {100 * spread(ends):.0f} %", spread(ends) <= 0.1)


def _overshoot_with_srr(get: Get) -> Finding:
    ratios = [overshoot(two_hours(get(srr_name(srr))), "tribofilm_covered_1") for srr in SRR]
    holds = ratios[0] > 1.01 * ratios[3] and ratios[-1] > 1.01 * ratios[4]
    return Finding(values(ratios, 1.0), holds)


def _below_closed_form(name: str) -> Measure:
    def measure(get: Get) -> Finding:
        run = two_hours(get("A"))
        scene = Scene.from_toml("azam_case_a")
        law = scene.tribofilm
        curve = ghanbarzadeh_thickness(
            60.0 * run.t, scene.operation.temperature, law.full_thickness, law.rate_factor,
            law.removal_thickness, law.removal_rate,
        )  # fmt: skip
        mean, other = float(run[name].mean()), float(curve.mean())
        alike = float(np.corrcoef(run[name], curve)[0, 1])
        text = f"{nm(mean)} against {nm(other)}; correlation {alike:.2f}"
        return Finding(text, mean < other and alike > 0.8)

    return measure


def _lower_with_srr(get: Get) -> Finding:
    means = [two_hours(get(srr_name(srr))).mean("tribofilm_covered_1") for srr in SRR if srr > 0.0]
    holds = rising([-mean for mean in means])
    return Finding(f"{values(means, digits=4)} nm; spread {100 * spread(means):.1f} %", holds)


def _without_removal(name: str) -> Measure:
    def measure(get: Get) -> Finding:
        plain, other = two_hours(get("A_srr+2")), two_hours(get(name))
        ratios = [overshoot(run, "tribofilm_covered_1") for run in (plain, other)]
        return Finding(f"{ratios[0]:.2f} with, {ratios[1]:.2f} without", ratios[1] < 1.02 < 1.1 < ratios[0])

    return measure


def _below(name: str) -> Measure:
    def measure(get: Get) -> Finding:
        means = [two_hours(get(case)).mean("tribofilm_covered_1") for case in ("A_srr+2", name)]
        return Finding(f"{nm(means[0])}, without removal {nm(means[1])}", means[0] < means[1])

    return measure


def _slow_rise(get: Get) -> Finding:
    run = two_hours(get("B"))
    minute = _first_to_peak(run, "tribofilm_covered_1")
    text = f"90 % of the peak at {minute:.0f} min; {nm(run.end('tribofilm_covered_1'))} at the end"
    return Finding(text, minute > 30.0)


def _no_overshoot(get: Get) -> Finding:
    ratio = overshoot(two_hours(get("B")), "tribofilm_covered_1")
    return Finding(f"{ratio:.2f}", ratio < 1.1)


def _at(celsius: float) -> Measure:
    said = Scene.from_toml("mtm_zddp").tribofilm.refusal(celsius + 273.15)
    return cannot(f"refused: {said.split('. ')[0]}" if said else "—")


def _whole_domain(measure: Measure) -> tuple[Experiment, ...]:
    """As section 5.8 says: the mean over all nodes of the simulation cell, those beside the track too."""
    text = "mean over all nodes of the domain, as section 5.8 says"
    clock = Experiment(f"{SLIDING.text}, dose by the clock; {text}", {"A": "A_sliding_clock"}, measure)
    return Experiment(text, measure=measure), clock


CLAIMS = (
    Claim("5-6", "film forms in the rubbing track only", "A, 20 min: ≥ 95 % of the film's volume within 1.2 a", in_the_track),
    Claim("5-7", "covered area grows at 1, 5, 10, 20 min", "A, disc: coverage rises", _coverage_grows, (LENGTH, CLOCK, DRY, WHITE)),
    Claim("5-7", "mean thickness grows at 1, 5, 10, 20 min", "A, disc: mean over the track rises", _mean_grows, (LENGTH, CLOCK, DRY, WHITE)),
    Claim("5-7", "patchy pads", "A, disc, 20 min: std / mean of the thickness in the track > 0.25", _patchy, (LENGTH,)),
    Claim("5-8", "ball: full coverage very quickly", "A: coverage ≥ 0.95 within 10 min", _full_cover, (LENGTH, CLOCK, DRY, WHITE)),
    Claim("5-8", "ball: strong overshoot", "A: peak / end of the covered nodes' mean ≥ 1.2", _overshoot_ball, (LENGTH, CLOCK, DRY, Experiment("mean over all nodes", measure=_overshoot_all_nodes))),
    Claim("5-8", "ball: film established in about 20 min", "A: peak between 8 and 25 min", _ball_in_20, (LENGTH, CLOCK, DRY)),
    Claim("5-9", "disc: coverage low", "A: coverage, mean over time, at least 0.05 below the ball's", _low_cover, (LENGTH, CLOCK, DRY, WHITE)),
    Claim("5-8/5-9", "disc: mean higher than the ball's", "A: covered nodes, mean over time", _disc_thicker("tribofilm_covered"), (LENGTH, CLOCK, DRY, WHITE, Experiment("mean over nodes above 80 % of the thickest", measure=_disc_thicker("tribofilm_upper")))),
    Claim("5-9", "disc: established more quickly", "A: 90 % of the peak reached not later than on the ball", _disc_quicker, (LENGTH, CLOCK, DRY, WHITE)),
    Claim("5-9", "disc: overshoot less prominent", "A: peak / end of the covered nodes' mean below the ball's", _disc_overshoot("tribofilm_covered"), (LENGTH, CLOCK, DRY, WHITE, Experiment("mean over all nodes", measure=_disc_overshoot("tribofilm")))),
    Claim("5-10", "final mean nearly independent of SRR", "A, ball, -10 to +10 %: spread (max - min) / mean ≤ 10 %", _final_films),
    Claim("5-10", "overshoot larger at larger SRR", "A, ball, -10 to +10 %: peak / end larger at ±10 than at ±0.5 %, by more than 1 %", _overshoot_with_srr, (SLIDING,)),
    Claim("5-11", "same course as Ghanbarzadeh's, lower", "A, ball, covered nodes: mean over time below that of the closed form (always rubbed), correlation > 0.8", _below_closed_form("tribofilm_covered_1"), (LENGTH, CLOCK, DRY, WHITE, *_whole_domain(_below_closed_form("film_1")))),
    Claim("5-12", "lower film at higher positive SRR", "A, ball, +0.5, 2, 5, 10 %: mean over time falls", _lower_with_srr, (SLIDING,), "Compare the spread with the scatter of the surfaces below."),
    Claim("5-12/5-13", "overshoot; none in Andersson's, who has no removal", "A, +2 %, ball: peak / end > 1.1, and < 1.02 with Andersson's law", _without_removal("A_andersson"), (SLIDING, Experiment("our law without its removal", measure=_without_removal("A_no_removal")),), "C5 and C6 of Andersson's law are assumed."),
    Claim("5-12/5-13", "lower than Andersson's", "—", lambda get: Finding(_below("A_no_removal")(get).text), (), "His constants C5 and C6 are not printed; the numbers are ours with and without removal."),
    Claim("5-14", "80 °C: steady growth over a longer period", "B, ball: 90 % of the peak after 30 min", _slow_rise),
    Claim("5-14", "80 °C: overshoot not produced", "B, ball: peak / end < 1.1", _no_overshoot),
    Claim("5-14", "80 °C: within the scatter of the experiment", "—", cannot("—"), (), "The measured points are printed as a plot only."),
    Claim("5-14", "60 °C", "—", _at(60.0), (), "The thesis prints no h_max, x, C3, C4 for 60 °C."),
    Claim("5-14", "100 °C", "—", _at(100.0), (), "The thesis prints no h_max, x, C3, C4 for 100 °C."),
)  # fmt: skip
