"""Chapter 7: wear of ball and disc."""

import numpy as np

from benchmarks.thesis.cases import SRR, Get, Run, centre_depth, scar_half_width, srr_name
from benchmarks.thesis.rows import (
    Claim,
    Experiment,
    Finding,
    Measure,
    inside,
    rank_correlation,
    rising,
    spread,
    two_hours,
    values,
)

PLUS = tuple(srr for srr in SRR if srr > 0.0)
MINUS = tuple(srr for srr in SRR if srr < 0.0)[::-1]


def _depths(get: Get, body: int, srrs: tuple[float, ...]) -> list[float]:
    return [two_hours(get(srr_name(srr))).end(f"wear_depth_{body}") for srr in srrs]


def _centres(get: Get, body: int, srrs: tuple[float, ...]) -> list[float]:
    return [centre_depth(two_hours(get(srr_name(srr))), body) for srr in srrs]


def _ratio(get: Get) -> Finding:
    run = two_hours(get("A"))
    ratio = run.end("wear_depth_1") / run.end("wear_depth_2")
    cycles = run.end("load_cycles_1") / run.end("load_cycles_2")
    depths = values([run.end("wear_depth_1"), run.end("wear_depth_2")])
    return Finding(f"{ratio:.2f} ({depths} nm); load cycles {cycles:.2f}", abs(ratio / 3.8 - 1.0) < 0.15)


def _rises(body: int, srrs: tuple[float, ...]) -> Measure:
    def measure(get: Get) -> Finding:
        depths = _depths(get, body, srrs)
        return Finding(f"{values(depths)} nm at {values(srrs, 1.0)} %", rising(depths))

    return measure


def _narrow(body: int, srrs: tuple[float, ...]) -> Measure:
    def measure(get: Get) -> Finding:
        depths = _depths(get, body, srrs)
        return Finding(f"{values(depths)} nm; spread {100 * spread(depths):.0f} %", spread(depths) < 0.1)

    return measure


def _centre_order(get: Get) -> Finding:
    depths = _centres(get, 1, SRR)
    return Finding(f"{values(depths, digits=4)} nm at {values(SRR, 1.0)} %", rising(depths))


def _wider(get: Get) -> Finding:
    widths = [scar_half_width(two_hours(get(srr_name(srr))), 1) for srr in (-10.0, 10.0)]
    return Finding(f"half width {values(widths, 1e6)} µm at -10, +10 %", widths[1] > widths[0])


def _difference(get: Get) -> Finding:
    low, high = _centres(get, 1, (-10.0, 10.0))
    return Finding(f"{1e9 * (high - low):.3g} nm", 150e-9 < high - low < 350e-9)


def _disc_without_order(get: Get) -> Finding:
    depths = _centres(get, 2, SRR)
    rank = rank_correlation(depths, SRR)
    return Finding(f"rank correlation {rank:.2f}; {values(depths)} nm at {values(SRR, 1.0)} %", abs(rank) < 0.8)


def _rq_by_rows(run: Run, rows: np.ndarray) -> float:
    heights = run.map("heights_2")[rows]
    return float((heights - heights.mean(axis=1, keepdims=True)).std())


def _disc_smoothed(get: Get) -> Finding:
    run = two_hours(get("A"))
    within, beyond = _rq_by_rows(run, inside(run, 2.0 / 3.0)), _rq_by_rows(run, ~inside(run, 1.25))
    return Finding(f"Rq {values([within, beyond])} nm within, beyond", within < 0.8 * beyond)


def _disc_signs(get: Get) -> Finding:
    sizes = (0.5, 2.0)
    pairs = [_depths(get, 2, (size, -size)) for size in sizes]
    text = "; ".join(f"±{size:g} %: {values(pair)} nm" for size, pair in zip(sizes, pairs, strict=True))
    return Finding(f"{text} (+, -)", all(plus > minus for plus, minus in pairs))


CLAIMS = (
    Claim("7-3/7-4", "ball wears almost 4 times as deep as the disc", "A: mean depths, ratio 3.8 ± 15 %", _ratio, (Experiment("without tribofilm", {"A": "A_bare"}),)),
    Claim("7-3", "ball, positive SRR: more wear at higher SRR", "A, 2 h: mean depth rises", _rises(1, PLUS)),
    Claim("7-3", "ball, negative SRR: curves hardly apart", "A, 2 h: spread of the mean depth < 10 %", _narrow(1, MINUS)),
    Claim("7-4", "disc, negative SRR: more wear at more negative SRR", "A, 2 h: mean depth rises", _rises(2, MINUS)),
    Claim("7-4", "disc, positive SRR: curves merge", "A, 2 h: spread of the mean depth < 10 %", _narrow(2, PLUS)),
    Claim("7-5", "ball: wear least at -10 %, most at +10 %, the rest in order", "A, 2 h: depth at y = 0 (mean over x) rises from -10 to +10 %", _centre_order, (Experiment("mean depth over the track, which samples more of it", measure=_rises(1, SRR)),)),
    Claim("7-5", "track of the ball wider at higher SRR", "A: half width at +10 % above that at -10 %", _wider),
    Claim("7-6", "difference of about 250 nm at the centre of the ball", "A: depth at +10 less that at -10 %, 150 to 350 nm", _difference),
    Claim("7-7", "disc: no order of the profiles with SRR", "A: rank correlation of the depth at y = 0 with SRR between -0.8 and 0.8", _disc_without_order),
    Claim("7-7", "disc smoother in the track than beside it", "A, -2 %: Rq (rows' means left out) within 2a/3 < 0.8 of that beyond 1.25 a", _disc_smoothed, (Experiment("without tribofilm", {"A": "A_bare"}),)),
    Claim("7-8", "ball: maps darken from -10 to +10 %", "A: mean depth rises from -10 to +10 %", _rises(1, SRR)),
    Claim("7-9", "disc: more wear at +0.5, +2 than at -0.5, -2 %", "A: mean depth", _disc_signs),
)  # fmt: skip
