"""Chapter 6: film, contact and roughness, with and without tribofilm."""

import numpy as np

from benchmarks.thesis.cases import Get, Run
from benchmarks.thesis.rows import (
    Claim,
    Experiment,
    Finding,
    Measure,
    cannot,
    crossing_text,
    crossover,
    formula_contact,
    nm,
    peak,
    takeovers,
    time_above,
    two_hours,
    values,
    viscosity_for,
)
from contact_core.reference import hamrock_dowson

WHITE = Experiment("correlation length of one node", {"A": "A_white"})
THIN = Experiment("viscosity for λ = 0.04", {"A": "A_thin"})
NO_FILM = Experiment("without tribofilm", {"A": "A_bare"})
SET_A = Experiment("set A instead of B", {"B": "A", "B_bare": "A_bare"})
CLOCK = Experiment("dose by the clock", {"A": "A_clock"})
RUBBED = "boundary lubrication (blocks driven by dry contacts), wear by u_1 - u_2"
SLIDING = Experiment(RUBBED, {"A": "A_sliding", "B": "B_sliding", "B_bare": "B_bare_sliding"})
BOTH = (WHITE, THIN, CLOCK, SLIDING)
PAIR = (SET_A, SLIDING)


def _hump(name: str) -> Measure:
    def measure(get: Get) -> Finding:
        run = two_hours(get("A"))
        minute, height = peak(run, name)
        rise = height / float(run[name][0]) - 1.0
        text = f"peak at {minute:.0f} min, {100 * rise:.0f} % above the start"
        if np.any(np.abs(takeovers(run) - minute) <= 3.0):
            return Finding(f"{text}, where another driver takes over")
        return Finding(text, 2.5 <= minute <= 20.0 and rise > 0.02)

    return measure


def _to_18(get: Get) -> Finding:
    end = two_hours(get("A")).end("h_c")
    return Finding(nm(end), 0.7 * 18e-9 < end < 1.3 * 18e-9)


def _to_smooth(get: Get) -> Finding:
    smooth, end = get("A_smooth").end("h_c"), two_hours(get("A")).end("h_c")
    return Finding(f"{nm(end)} against {nm(smooth)}", 0.7 < end / smooth < 1.3)


def _to_formula(get: Get) -> Finding:
    film, end = float(hamrock_dowson(formula_contact("azam_case_a"))[0]), two_hours(get("A")).end("h_c")
    return Finding(f"{nm(end)} against {nm(film)}", 0.7 < end / film < 1.3)


def _levels_off(get: Get) -> Finding:
    run = two_hours(get("A"))
    top, late, end = peak(run, "h_c")[1], run.at("h_c", 100.0), run.end("h_c")
    share = (late - end) / (top - end) if top > end else float("nan")
    return Finding(f"{100 * share:.0f} %", bool(abs(share) < 0.1))


def _start_lambda(get: Get) -> Finding:
    start = float(get("A")["lambda_conventional"][0])
    return Finding(f"{start:.3f}; true λ {float(get('A')['lambda_ratio'][0]):.2f}", 0.03 < start < 0.05)


def _lambda_for() -> str:
    contact = formula_contact("azam_case_a")
    centre, least = hamrock_dowson(contact)
    return (
        f"Hamrock and Dowson's films of the printed inputs are {nm(centre)} (centre) and {nm(least)} (least), with a "
        f"composite Rq of 127.6 nm λ = {centre / 127.6e-9:.3f} and {least / 127.6e-9:.3f}; 0.04 at the centre needs "
        f"{1e3 * viscosity_for(0.04 * 127.6e-9, 'azam_case_a'):.2f} mPa s instead of 4"
    )


def _still_falls(get: Get) -> Finding:
    run = two_hours(get("A"))
    late = [run.at("lambda_ratio", minute) for minute in (60.0, 90.0, 120.0)]
    return Finding(f"{values(late, 1.0)} at 60, 90, 120 min", late[0] > late[1] > late[2])


def _slows_down(get: Get) -> Finding:
    run = two_hours(get("A"))
    first = run.at("lambda_ratio", 20.0) - run.at("lambda_ratio", 60.0)
    last = run.at("lambda_ratio", 80.0) - run.at("lambda_ratio", 120.0)
    return Finding(f"{first:.3f} in 20 to 60 min, {last:.3f} in 80 to 120 min", first > 0.0 and last < first)


def _less_pronounced(get: Get) -> Finding:
    run = two_hours(get("A"))
    ranges = [float(np.ptp(run[name]) / run[name].mean()) for name in ("lambda_ratio", "h_c")]
    return Finding(f"λ {ranges[0]:.2f}, h_c {ranges[1]:.2f}", ranges[0] < ranges[1])


def _area_hump(name: str) -> Measure:
    def measure(get: Get) -> Finding:
        run = two_hours(get("A"))
        minute, top = peak(run, name)
        start, end = float(run[name][0]), run.end(name)
        text = f"{start:.3f}, {top:.3f} at {minute:.0f} min, {end:.3f}"
        return Finding(text, 5.0 <= minute <= 30.0 and top > 1.02 * start and end < 0.98 * top)

    return measure


def _load_ratio_falls(name: str) -> Measure:
    def measure(get: Get) -> Finding:
        run = two_hours(get("A"))
        start, (minute, top), end = float(run[name][0]), peak(run, name), run.end(name)
        return Finding(f"{start:.3f}, {top:.3f} at {minute:.0f} min, {end:.3f}", top < 1.02 * start and end < start)

    return measure


def _boundary(judged: int) -> Measure:
    """By the load ratio of r < 2a/3 (0) or of the whole contact (1)."""

    def measure(get: Get) -> Finding:
        starts = [float(get("A")[name][0]) for name in ("contact_load_ratio_disc", "contact_load_ratio")]
        return Finding(f"{starts[0]:.2f} (whole contact {starts[1]:.2f})", starts[judged] > 0.8)

    return measure


def _higher(*names: str, film: str = "B", bare: str = "B_bare", most: float = 0.95) -> Measure:
    """With film above without, for at least a share of the time."""

    def measure(get: Get) -> Finding:
        one, other = two_hours(get(film)), two_hours(get(bare))
        shares = [time_above(one, other, name) for name in names]
        ratios = [one.end(name) / other.end(name) for name in names]
        text = f"{values([100 * s for s in shares], 1.0)} % of the time; ratio at the end {values(ratios, 1.0)}"
        return Finding(text, min(shares) >= most)

    return measure


def _considerably(get: Get) -> Finding:
    one, other = two_hours(get("B")), two_hours(get("B_bare"))
    names = ("roughness_1", "roughness_ra_1", "roughness_2", "roughness_ra_2")
    ratios = [one.end(name) / other.end(name) for name in names]
    return Finding(f"{values(ratios, 1.0)} (ball Rq, Ra, disc Rq, Ra)", min(ratios) > 1.05)


def _considerably_raw(get: Get) -> Finding:
    one, other = two_hours(get("B")), two_hours(get("B_bare"))
    ratios = [one.end(f"roughness_raw_{i}") / other.end(f"roughness_raw_{i}") for i in (1, 2)]
    return Finding(f"{values(ratios, 1.0)} (ball Rq, disc Rq)", min(ratios) > 1.05)


def _ways_of_roughness(name: str) -> Measure:
    def measure(get: Get) -> Finding:
        run = two_hours(get("A"))
        ball, disc = ([float(run[f"{name}_{i}"][0]), run.end(f"{name}_{i}")] for i in (1, 2))
        return Finding(f"ball {values(ball)} nm, disc {values(disc)} nm", ball[1] > ball[0] and disc[1] < disc[0])

    return measure


def _lower_conventional(get: Get) -> Finding:
    one, other = two_hours(get("B")), two_hours(get("B_bare"))
    share = time_above(other, one, "lambda_conventional")
    means = [run.mean("lambda_conventional") for run in (one, other)]
    return Finding(f"{100 * share:.0f} % of the time; mean {means[0]:.4f}, without {means[1]:.4f}", share >= 0.95)


def _ends_higher(name: str) -> Measure:
    def measure(get: Get) -> Finding:
        one, other = two_hours(get("B")), two_hours(get("B_bare"))
        pairs = [(one.end(f"{name}_{i}"), other.end(f"{name}_{i}")) for i in (1, 2)]
        text = "; ".join(f"{body} {values(pair)} nm" for body, pair in zip(("ball", "disc"), pairs, strict=True))
        return Finding(f"{text} (with, without)", all(one > other for one, other in pairs))

    return measure


def _disc_crosses(name: str) -> Measure:
    def measure(get: Get) -> Finding:
        one, other = two_hours(get("B")), two_hours(get("B_bare"))
        minute = crossover(one, other, name)
        return Finding(f"with film {crossing_text(minute)}", bool(20.0 <= minute <= 60.0))

    return measure


def _pressure_crosses(get: Get) -> Finding:
    minute = crossover(two_hours(get("B")), two_hours(get("B_bare")), "pressure_max")
    return Finding(f"with film {crossing_text(minute)}", bool(30.0 <= minute <= 75.0))


def _pressure_higher(get: Get) -> Finding:
    one, other = two_hours(get("B")), two_hours(get("B_bare"))
    ends = [run.mean("pressure_max", 100.0) / float(run["pressure_hertz"]) for run in (one, other)]
    return Finding(f"{ends[0]:.2f}, without {ends[1]:.2f} (mean of the last 20 min)", ends[0] > ends[1])


def _pressure_steadier(get: Get) -> Finding:
    def change(run: Run) -> float:
        return abs(run.mean("pressure_max", 100.0) / float(run["pressure_max"][:6].mean()) - 1.0)

    changes = [change(two_hours(get(name))) for name in ("B", "B_bare")]
    text = f"{100 * changes[0]:.0f} %, without {100 * changes[1]:.0f} %"
    return Finding(text, changes[0] < changes[1])


def _pressure_falls(get: Get) -> Finding:
    run = two_hours(get("B"))
    start, end = 1e-9 * float(run["pressure_max"][0]), 1e-9 * run.mean("pressure_max", 100.0)
    return Finding(f"{start:.2f} GPa, {end:.2f} GPa", start > 5.5 and 2.0 < end < 5.9)


def _all_fall(get: Get) -> Finding:
    texts, falls = [], []
    for name in ("contact_area_ratio_disc", "contact_load_ratio_disc"):
        for case in ("B", "B_bare"):
            run = two_hours(get(case))
            start, end = float(run[name][0]), run.end(name)
            texts.append(f"{start:.2f} → {end:.2f}")
            falls.append(end < start)
    return Finding(f"A_c {texts[0]}, without {texts[1]}; W_c {texts[2]}, without {texts[3]}", all(falls))


AREA, LOAD = "contact_area_ratio_disc", "contact_load_ratio_disc"
WHOLE_AREA = Experiment("whole contact instead of r < 2a/3", measure=_area_hump("contact_area_ratio"))
WHOLE_LOAD = Experiment("whole contact instead of r < 2a/3", measure=_load_ratio_falls("contact_load_ratio"))


def _raw(measure: Measure) -> Experiment:
    return Experiment("roughness with the groove's shape in it", measure=measure)


def _steel(measure: Measure) -> Experiment:
    return Experiment("roughness of the steel under the film", measure=measure)


LESS = Experiment(
    f"{RUBBED} with K of 3e-6 and 3e-7 (the thesis prints none for this set), roughness of the steel under the film",
    {"B": "B_less", "B_bare": "B_bare_less"},
    _disc_crosses("roughness_steel_2"),
)

CLAIMS = (
    Claim("6-4", "hump of h_c in the first 5 to 10 min", "A: peak between 2.5 and 20 min, > 2 % above the start", _hump("h_c"), (NO_FILM, *BOTH)),
    Claim("6-4", "decay to 18 nm at 2 h", "A: 12.6 to 23.4 nm", _to_18, (*BOTH, NO_FILM)),
    Claim("6-4", "18 nm: about the smooth contact's film", "A: within 30 % of the smooth contact's h_c on the same grid", _to_smooth, (Experiment("smooth contact's film by Hamrock and Dowson's formula", measure=_to_formula), Experiment("smooth contact solved with fitted flow", {"A_smooth": "A_smooth_fitted"}), *BOTH, NO_FILM)),
    Claim("6-4", "asymptotic value reached", "A: < 10 % of the whole fall is left to the last 20 min", _levels_off, BOTH),
    Claim("5, 6-5", "λ starts at 0.04", "A: λ with the formula's film 0.03 to 0.05", _start_lambda, (THIN,), "", _lambda_for()),
    Claim("6-5", "slight rise of λ in the first 5 to 10 min", "A: peak between 2.5 and 20 min, > 2 % above the start", _hump("lambda_ratio"), (NO_FILM, *BOTH)),
    Claim("6-5", "λ changes less than h_c", "A: (max - min) / mean of λ below that of h_c", _less_pronounced, BOTH),
    Claim("6-5", "λ still falls at 2 h", "A: falls from 60 to 90 to 120 min", _still_falls, BOTH),
    Claim("6-5", "λ falls ever more slowly", "A: less in 80 to 120 than in 20 to 60 min", _slows_down, BOTH),
    Claim("6-6", "A_c rises for 10 to 20 min, then falls", "A, r < 2a/3: peak between 5 and 30 min, > 2 % above both ends", _area_hump(AREA), (WHOLE_AREA, NO_FILM, *BOTH)),
    Claim("6-6", "W_c falls throughout, no hump", "A, r < 2a/3: never > 2 % above the start, lower at the end", _load_ratio_falls(LOAD), (WHOLE_LOAD, NO_FILM, *BOTH)),
    Claim("6-6", "boundary regime at the start", "A, r < 2a/3: W_c > 0.8", _boundary(0), (Experiment("129 nodes, white on them", {"A": "A_129"}), Experiment("129 nodes, white on them, whole contact", {"A": "A_129"}, _boundary(1)), WHITE, THIN)),
    Claim("6-7", "ball rougher with film throughout", "B: Rq higher with film for ≥ 95 % of the time", _higher("roughness_1"), (_raw(_higher("roughness_raw_1")), _steel(_higher("roughness_steel_1")), *PAIR)),
    Claim("6-8", "conventional λ lower with film", "B: for ≥ 95 % of the time", _lower_conventional, PAIR),
    Claim("6-9", "Rq and Ra of both bodies considerably higher with film", "B, end: all four > 5 % higher", _considerably, (_raw(_considerably_raw), *PAIR)),
    Claim("6-5, 6-9", "roughness of the disc falls, of the ball rises", "A: end against start", _ways_of_roughness("roughness"), (_raw(_ways_of_roughness("roughness_raw")), *BOTH)),
    Claim("6-10", "h_c higher with film", "B: for ≥ 95 % of the time", _higher("h_c"), PAIR),
    Claim("6-11", "true λ higher with film throughout", "B: for ≥ 95 % of the time", _higher("lambda_ratio"), PAIR),
    Claim("6-12", "polar additive lowers the contact ratio (Luo and Liu)", "—", cannot("—"), (), "An experiment with other oils in a static contact at 0.292 GPa; the thesis ran no case of it."),
    Claim("6-13", "both bodies rougher with film at the end", "B: Rq of both", _ends_higher("roughness"), (_raw(_ends_higher("roughness_raw")), _steel(_ends_higher("roughness_steel")), *PAIR)),
    Claim("6-13", "disc smoother with film for the first 40 min", "B: Rq crosses between 20 and 60 min", _disc_crosses("roughness_2"), (_raw(_disc_crosses("roughness_raw_2")), _steel(_disc_crosses("roughness_steel_2")), LESS, *PAIR)),
    Claim("6-14", "p_max from 6 GPa to between 6 and 2 GPa", "B: > 5.5 GPa at the start, 2 to 5.9 GPa at the end", _pressure_falls, PAIR),
    Claim("6-14", "p_max / p_H higher with film at the end", "B", _pressure_higher, PAIR),
    Claim("6-14", "curves cross at about 50 min", "B: between 30 and 75 min", _pressure_crosses, PAIR),
    Claim("6-14", "p_max steadier with film", "B: change from the first 5 to the last 20 min smaller with film", _pressure_steadier, PAIR),
    Claim("6-15", "A_c larger with film", "B, r < 2a/3: for ≥ 80 % of the time", _higher(AREA, most=0.8), PAIR),
    Claim("6-15", "W_c larger with film", "B, r < 2a/3: for ≥ 80 % of the time", _higher(LOAD, most=0.8), PAIR),
    Claim("6-15", "A_c and W_c fall with and without film", "B, r < 2a/3: all four lower at the end", _all_fall, PAIR),
)  # fmt: skip
