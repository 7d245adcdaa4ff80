"""The outputs of the core, and flags for answers that are less sure than usual."""

from dataclasses import dataclass
from enum import IntFlag


class RangeFlag(IntFlag):
    """Why an answer is less sure than usual, in words by `text`; `Outputs.range_flags` is the sum of what applies."""

    text: str

    def __new__(cls, value: int, text: str = "") -> "RangeFlag":
        """Keep the sentence beside the number."""
        flag = int.__new__(cls, value)
        flag._value_, flag.text = value, text
        return flag

    LAMBDA_CAPPED = 1, "no roughness or no load: lambda_ratio stands at its cap or at zero"
    TRIBOFILM_TEMPERATURE = 2, "outside the temperatures at which the constants of the tribofilm hold"
    INLET_UNRESOLVED = 4, "the grid is too coarse for the film in the inlet: the film is a number of this grid"
    NOT_CONVERGED = 8, "over a tenth of the block's film solutions missed the tolerance and were used as they were"
    FALLBACK = 16, "the dry solution stood in for a film solution in part of the block"
    DOMAIN_EDGE = 32, "the contact or the wear scar reaches the edge of the grid"
    FEW_NODES = 64, "fewer than 8 nodes across the Hertz contact at this load"
    SLOW_BODY = 128, "the slower body shows a block only part of its track: its film and wear are uneven along it"
    STIFF_WEAR = 256, "blocks are longer than wear stays stable for: fine roughness and A_c are less sure"
    OUTSIDE_FIT = 512, "outside the points to which the curves of the fast level were fitted"
    OTHER_LEVEL = 1024, "outputs that only the deterministic level can tell stand as it last left them, or at zero"


@dataclass(frozen=True)
class Outputs:
    """The output quantities of `quantities.OUTPUTS` that the core computes, in SI."""

    friction_force: float = 0.0
    friction_coefficient: float = 0.0
    rolling_resistance: float = 0.0
    friction_solid: float = 0.0
    friction_fluid: float = 0.0
    spin_torque: float = 0.0
    dfriction_dspeed_1: float = 0.0
    dfriction_dspeed_2: float = 0.0
    dfriction_dload: float = 0.0
    dfriction_dtemperature: float = 0.0
    power_loss: float = 0.0
    wear_rate_1: float = 0.0
    wear_rate_2: float = 0.0
    wear_volume_1: float = 0.0
    wear_volume_2: float = 0.0
    wear_depth_1: float = 0.0
    wear_depth_2: float = 0.0
    h_c: float = 0.0
    h_central: float = 0.0
    h_min: float = 0.0
    lambda_ratio: float = 0.0
    tribofilm_1: float = 0.0
    tribofilm_2: float = 0.0
    tribofilm_roughness_1: float = 0.0
    tribofilm_roughness_2: float = 0.0
    roughness_1: float = 0.0
    roughness_2: float = 0.0
    contact_area_ratio: float = 0.0
    contact_load_ratio: float = 0.0
    pressure_max: float = 0.0
    flash_temperature_rise: float = 0.0
    temperature_1: float = 0.0
    temperature_2: float = 0.0
    heat_flow_1: float = 0.0
    heat_flow_2: float = 0.0
    approach: float = 0.0
    range_flags: int = 0
    iterations: int = 0
    suggested_step: float = 0.0
    load_cycles_1: float = 0.0
    load_cycles_2: float = 0.0
    coverage_1: float = 0.0
    coverage_2: float = 0.0
    tribofilm_covered_1: float = 0.0
    tribofilm_covered_2: float = 0.0
    tribofilm_upper_1: float = 0.0
    tribofilm_upper_2: float = 0.0
    roughness_ra_1: float = 0.0
    roughness_ra_2: float = 0.0
    roughness_raw_1: float = 0.0
    roughness_raw_2: float = 0.0
    lambda_conventional: float = 0.0
    contact_area_ratio_disc: float = 0.0
    contact_load_ratio_disc: float = 0.0
    error_friction: float = 0.0
    error_film: float = 0.0
    error_tribofilm: float = 0.0
    error_wear: float = 0.0
    unconverged: float = 0.0
    blocks_dry: float = 0.0
    blocks_mixed: float = 0.0
    blocks_fallback: float = 0.0
