"""Tribofilm and friction of ZDDP after two hours beside what others measured on a ball-on-disc rig."""

from .model import Comparison, Kind, Outcome, Row, exactly
from .thesis import two_hours


def run() -> Outcome:
    """Compare the shipped case of that rig, on the regression level."""
    found = two_hours("mtm_zddp")
    return Outcome(
        (
            Row(
                "film of the ball after 2 h", "nm", exactly(150.0), 1e9 * found.end("tribofilm_1"), 5.0,
                'half of the last printed digit of "typically 150 nm"',
            ),
            Row(
                "friction coefficient after 2 h", "", (0.09, 0.14), found.end("friction_coefficient"), 0.0,
                "range of primary ZDDPs", not_judged="the scene's boundary friction is taken from these measurements",
            ),
        )
    )  # fmt: skip


COMPARISON = Comparison(
    "ZDDP films on a ball-on-disc rig",
    Kind.MEASURED,
    "Primary, secondary and mixed alkyl ZDDPs; the numbers are those of the abstracts, oils and conditions are not the "
    "scene's, so that this is an order. The scene's growth was fitted by others to another test on such a rig. Scene "
    "`mtm_zddp`, regression level.",
    "Dawczyk, Morgan, Russo & Spikes, Tribol. Lett. 67 (2019), doi:10.1007/s11249-019-1148-9; Zhang, Ueda, Campen & "
    "Spikes, Tribol. Lett. 69 (2021)",
    run,
)
