"""The table of inputs and outputs of a contact: name, symbol, unit, text, range, conventions of sign and averaging.

FMUs, result files, tables and checks read it. `parameter` does the same for the fields of a scene.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import Field, dataclass, field, fields, is_dataclass, replace
from typing import Any, Literal

CELSIUS = 273.15  # K, of 0 degC

Role = Literal["input", "output", "diagnostic"]
Kind = Literal["Real", "Integer", "Boolean"]
# level: each instant has it (`deterministic.observed`), and the output is its smoothed mean over blocks; slope: the
# surfaces have it, and its change per block gives the error of time steps; rate: so has its rate of change
Trend = Literal["", "level", "slope", "rate"]

LEVELS = ("regression", "deterministic", "auto", "map")  # fidelity levels by number: 1, 2, 3, 4
UNSOLVED = frozenset({"regression", "map"})  # levels that solve no contact: an accuracy chooses nothing there

# What is measured in a unit, in the words of the Modelica standard library, where nothing else is said
_MEASURED_IN = {
    "J": "Energy",
    "K": "ThermodynamicTemperature",
    "N": "Force",
    "N m": "Torque",
    "N m s/rad": "RotationalDampingConstant",
    "N m/rad": "RotationalSpringConstant",
    "N.s/m": "TranslationalDampingConstant",
    "N/m": "TranslationalSpringConstant",
    "Pa": "Pressure",
    "Pa s": "DynamicViscosity",
    "W": "Power",
    "W/(m K)": "ThermalConductivity",
    "kg m2": "MomentOfInertia",
    "kg/m3": "Density",
    "m": "Length",
    "m/s": "Velocity",
    "m3": "Volume",
    "m3/s": "VolumeFlowRate",
    "rad": "Angle",
    "rad/s": "AngularVelocity",
    "rad/s2": "AngularAcceleration",
    "s": "Time",
}
DIFFERENCE = "TemperatureDifference"


def measured(unit: str, said: str = "") -> str:
    """Return the kind of physical quantity of a variable: the given one, else that of its unit, else empty."""
    return said or _MEASURED_IN.get(unit, "")


@dataclass(frozen=True)
class Quantity:
    """One input or output of a contact, in SI."""

    name: str
    symbol: str
    unit: str
    text: str
    role: Role = "output"
    nominal: float = 1.0
    minimum: float = -math.inf
    maximum: float = math.inf
    display: str = ""  # the unit people read, convertible to `unit`
    kind: Kind = "Real"
    relative: bool = False  # a temperature difference, not a temperature
    levels: tuple[str, ...] = LEVELS  # fidelity levels that have it; others keep its last value, or zero
    trend: Trend = ""  # how the deterministic level follows it from block to block, see `Trend`
    error: str = ""  # output that states the half width of its error: relative, or absolute where it says so

    @property
    def quantity(self) -> str:
        """Kind of physical quantity."""
        return measured(self.unit, DIFFERENCE if self.relative else "")


def _pair(
    name: str, symbol: str, unit: str, text: str, *, own_error: str = "", **rest: Any
) -> tuple[Quantity, Quantity]:
    """Return a quantity of each body; `own_error`: output of each body that states its error, without the number."""
    first, second = (
        Quantity(
            f"{name}_{i}",
            symbol and f"{symbol}_{i}",
            unit,
            f"{text}, body {i}",
            **(rest | ({"error": f"{own_error}_{i}"} if own_error else {})),
        )
        for i in (1, 2)
    )
    return first, second


_FIELDS = ("deterministic",)  # levels that have fields
_BLOCKS = ("deterministic", "auto")  # levels that have blocks

# fmt: off
INPUTS: tuple[Quantity, ...] = (
    Quantity("load", "W", "N", "normal load", "input", 50.0, 0.0, 1e5),
    Quantity("speed_1", "u_1", "m/s", "surface speed of body 1 along x, relative to the contact", "input", 1.0, -100, 100),
    Quantity("speed_2", "u_2", "m/s", "surface speed of body 2 along x, relative to the contact", "input", 1.0, -100, 100),
    Quantity("temperature", "T", "K", "oil temperature", "input", 350.0, 230.0, 500.0, "degC"),
    Quantity("spin", "omega", "rad/s", "angular velocity of body 1 relative to body 2 about the axis from x to y", "input", 100.0, -1e5, 1e5),
    *_pair("body_temperature", "T_b", "K", "bulk temperature, used where heat.bulk is 'inputs'", role="input",
           nominal=350.0, minimum=230.0, maximum=900.0, display="degC"),
    Quantity("radius_x", "R_x", "m", "combined radius of curvature along x", "input", 0.01, 1e-6, 100.0, "mm"),
    Quantity("radius_y", "R_y", "m", "combined radius of curvature along y", "input", 0.01, 1e-6, 100.0, "mm"),
)

OUTPUTS: tuple[Quantity, ...] = (
    Quantity("friction_force", "F", "N", "friction force on body 1 along +x", nominal=1.0, trend="level", error="error_friction"),
    Quantity("friction_coefficient", "mu", "1", "|friction_force| / load, 0 at zero load", nominal=0.1, minimum=0.0, error="error_friction"),
    Quantity("rolling_resistance", "F_r", "N",
             "integral of (h/2) dp/dx over the mean fluid film, its inlet included; the force on each surface is the opposite along +x; not in power_loss", nominal=0.1, trend="level", error="error_rolling"),
    Quantity("friction_solid", "F_s", "N", "part of friction_force where solids touch", nominal=1.0, trend="level"),
    Quantity("friction_fluid", "F_f", "N", "part of friction_force in the oil film", nominal=1.0, trend="level"),
    Quantity("spin_torque", "M_s", "N m", "friction torque on body 1 about the axis from x to y", nominal=1e-3, trend="level"),
    Quantity("power_loss", "P", "W", "-friction_force (speed_1 - speed_2) - spin_torque spin", nominal=1.0, minimum=0.0, trend="level"),
    *(Quantity(f"dfriction_d{name}", f"dF/d{symbol}", unit, f"derivative of friction_force by {text}; at a held film, or total where film.model is 'regression'", nominal=nominal)
      for name, symbol, unit, nominal, text in (
          ("speed_1", "u_1", "N.s/m", 1.0, "speed_1"),
          ("speed_2", "u_2", "N.s/m", 1.0, "speed_2"),
          ("load", "W", "1", 0.1, "load"),
          ("temperature", "T", "N/K", 0.01, "the temperature of oil and bodies together"))),
    *_pair("wear_rate", "dV/dt", "m3/s", "wear volume of the step divided by the step; at a step of 0 the rate now", nominal=1e-17, minimum=0.0, display="um3/s"),
    *_pair("wear_volume", "V", "m3", "wear volume of the whole track", nominal=1e-14, minimum=0.0, display="um3", error="error_wear"),
    *_pair("wear_depth", "w", "m", "mean wear depth over the track |y| < b", nominal=1e-8, minimum=0.0, display="nm", trend="rate", error="error_wear"),
    Quantity("h_c", "h_c", "m", "central film thickness: mean gap over the inner 2/3 of Hertz's contact, r < 2a/3, or such an ellipse or strip", nominal=1e-8, minimum=0.0, display="nm", trend="level", error="error_film"),
    Quantity("h_central", "h_central", "m", "gap at the centre of the contact: one node, of a rough contact no film thickness", nominal=1e-8, minimum=0.0, display="nm", trend="level"),
    Quantity("h_min", "h_min", "m", "smallest gap", nominal=1e-9, minimum=0.0, display="nm", levels=_FIELDS, trend="level"),
    Quantity("lambda_ratio", "lambda", "1", "h_c / composite rms roughness over the same area, at most 1000; of rough, deformed bodies: not the lambda of handbooks; no error is stated, as none is known of the roughness", minimum=0.0, trend="level"),
    *_pair("tribofilm", "h_t", "m", "mean tribofilm thickness over the track |y| < b, all nodes", nominal=1e-8, minimum=0.0, display="nm", trend="slope", own_error="error_tribofilm"),
    *_pair("tribofilm_roughness", "Rq_t", "m", "rms deviation of the tribofilm thickness over |y| < 2b/3", nominal=1e-8, minimum=0.0, display="nm"),
    *_pair("tribofilm_grown", "h_g", "m", "tribofilm grown so far, mean over the track |y| < b", nominal=1e-8, minimum=0.0, display="nm"),
    *_pair("tribofilm_removed", "h_r", "m", "tribofilm removed so far, likewise: tribofilm_grown - tribofilm", nominal=1e-8, minimum=0.0, display="nm"),
    *_pair("oxide", "x", "m", "mean thickness over the track |y| < b of the oxide that no tribofilm covers", nominal=1e-9, minimum=0.0, display="nm"),
    *_pair("roughness", "Rq", "m", "rms roughness over |y| < 2b/3, free of the groove's shape", nominal=1e-8, minimum=0.0, display="nm", trend="slope"),
    Quantity("contact_area_ratio", "A_c", "1", "real contact area / Hertz area", minimum=0.0, trend="level"),
    Quantity("contact_load_ratio", "W_c", "1", "load carried by the solids / load", minimum=0.0, maximum=1.0, trend="level", error="error_load_ratio"),
    Quantity("pressure_max", "p_max", "Pa", "largest pressure", nominal=1e9, minimum=0.0, display="GPa", levels=_FIELDS, trend="level"),
    Quantity("flash_temperature_rise", "dT_f", "K", "mean rise of the surfaces over the bulk temperatures in the real contact", relative=True, trend="level"),
    Quantity("von_mises_max", "sigma_v", "Pa", "largest von Mises stress below the surfaces, mean over the instants of a pass; where stress.model asks for it, as all that lies below", nominal=1e9, minimum=0.0, display="GPa"),
    Quantity("von_mises_depth", "z_v", "m", "depth of the layer where it is largest", nominal=1e-5, minimum=0.0, display="um"),
    Quantity("near_surface_share", "S_s", "1", "share of the risk of fatigue, the integral of sqrt(J2,a)^(31/3) over both bodies, down to stress.near_surface", minimum=0.0, maximum=1.0),
    Quantity("dang_van_ratio", "R_D", "1", "largest Dang Van stress of a load cycle on the tracks over stress.torsion_limit", minimum=0.0),
    Quantity("crossland_ratio", "R_C", "1", "largest Crossland stress of a load cycle on the tracks over stress.torsion_limit", minimum=0.0),
    *_pair("damage", "D", "1", "mean over the track |y| < b of the largest fatigue damage under a point; the material fails at 1", nominal=0.1, minimum=0.0, error="error_damage"),
    *_pair("micropitted_area", "A_p", "1", "share of the track |y| < b that fatigue has broken out", nominal=0.1, minimum=0.0, maximum=1.0),
    *_pair("profile_loss", "l_p", "m", "mean depth worn and broken out over the track |y| < b", nominal=1e-7, minimum=0.0, display="nm"),
    Quantity("contact_temperature_max", "T_max", "K", "largest temperature of the surfaces: mean of the hottest 1 % of Hertz's area", nominal=350.0, minimum=0.0, display="degC", trend="level"),
    Quantity("scuffing_ratio", "S", "1", "(contact_temperature_max - temperature of the oil) / (critical temperature - temperature of the oil), 0 to 1000; 0 without a law of scuffing", minimum=0.0, trend="level"),
    *_pair("temperature", "T", "K", "bulk temperature", nominal=350.0, minimum=0.0, display="degC"),
    Quantity("heat_flow_1", "Q_1", "W", "heat that the contact puts into the body, body 1", nominal=1.0, trend="level"),
    Quantity("heat_flow_2", "Q_2", "W", "heat that the contact puts into the body, body 2", nominal=1.0, trend="level"),
    Quantity("approach", "delta", "m", "approach of the bodies from first touching of the undeformed, smooth shapes", nominal=1e-6, display="um", trend="level"),
    Quantity("valid", "", "", "false: the last input could not be used; state and outputs stand as they were", kind="Boolean"),
    Quantity("fidelity_used", "", "", "fidelity level that gave the outputs: 1 regression, 2 deterministic, 3 auto, 4 map, 0 none yet", kind="Integer", minimum=0, maximum=4),
    Quantity("range_flags", "", "", "sum of the RangeFlag values raised (see RangeFlag)", kind="Integer", minimum=0),
    Quantity("iterations", "", "", "film iterations in the last step", kind="Integer", minimum=0, levels=_FIELDS),
    Quantity("suggested_step", "dt", "s", "time until the stored contact is due to be solved again", nominal=60.0, minimum=0.0),
    *_pair("load_cycles", "N", "1", "passes of a surface point through the contact", role="diagnostic", nominal=1e4, minimum=0.0),
    Quantity("lambda_conventional", "lambda_HD", "1",
             "central film of the smooth bodies by formula (points: Hamrock and Dowson, lines: Dowson and Toyoda) / composite rms roughness, at most 1000: the lambda of handbooks", role="diagnostic", minimum=0.0, levels=_FIELDS, trend="level"),
    Quantity("contact_area_ratio_disc", "A_c_disc", "1", "share of the inner area r < 2a/3 in solid contact", role="diagnostic", minimum=0.0, maximum=1.0, levels=_FIELDS, trend="level"),
    Quantity("contact_load_ratio_disc", "W_c_disc", "1", "share of the load on the inner area r < 2a/3 that solids carry", role="diagnostic", minimum=0.0, maximum=1.0, levels=_FIELDS, trend="level"),
    *_pair("tribofilm_covered", "h_t_cov", "m", "mean tribofilm thickness over the track's nodes with more than 1 nm", role="diagnostic", nominal=1e-8, minimum=0.0, display="nm", levels=_FIELDS),
    *_pair("tribofilm_upper", "h_t_up", "m", "mean tribofilm thickness over the track's nodes above 80 % of the thickest", role="diagnostic", nominal=1e-8, minimum=0.0, display="nm", levels=_FIELDS),
    *_pair("roughness_ra", "Ra", "m", "arithmetic mean roughness over |y| < 2b/3, free of the groove's shape", role="diagnostic", nominal=1e-8, minimum=0.0, display="nm", levels=_FIELDS),
    *_pair("coverage", "C", "1", "share of the track |y| < b with a tribofilm above 1 nm", role="diagnostic", minimum=0.0, maximum=1.0),
    *_pair("roughness_raw", "Rq_raw", "m", "rms roughness over |y| < 2b/3, groove included", role="diagnostic", nominal=1e-8, minimum=0.0, display="nm", levels=_FIELDS),
    Quantity("error_friction", "", "1", "half width (95 %) of friction_coefficient's error by all causes, relative", role="diagnostic", minimum=0.0),
    Quantity("error_rolling", "", "1", "half width (95 %) of rolling_resistance's error by all causes, relative", role="diagnostic", minimum=0.0),
    Quantity("error_film", "", "1", "half width (95 %) of h_c's error by all causes, relative", role="diagnostic", minimum=0.0),
    Quantity("error_load_ratio", "", "1", "half width (95 %) of contact_load_ratio's error by all causes, absolute", role="diagnostic", minimum=0.0),
    *_pair("error_tribofilm", "", "1", "half width (95 %) of the mean tribofilm's error by all causes, relative", role="diagnostic", minimum=0.0),
    Quantity("error_wear", "", "1", "half width (95 %) of the wear depths' error by all causes, relative, the larger one", role="diagnostic", minimum=0.0),
    Quantity("error_damage", "", "1", "half width (95 %) of the damages' error by time steps, sampling or curves, relative, the larger one; above 1, a factor of 1 + it either way", role="diagnostic", minimum=0.0),
    Quantity("unconverged", "", "1", "share of the last block's film solutions that did not converge", role="diagnostic", minimum=0.0, maximum=1.0, levels=_FIELDS),
    Quantity("blocks_dry", "", "1", "solved blocks so far that dry contact pressures drove", role="diagnostic", minimum=0.0, levels=_BLOCKS),
    Quantity("blocks_mixed", "", "1", "solved blocks so far that mixed lubrication pressures drove", role="diagnostic", minimum=0.0, levels=_BLOCKS),
    Quantity("blocks_fallback", "", "1", "solved blocks so far in which the dry solution had to stand in for a mixed one", role="diagnostic", minimum=0.0, levels=_BLOCKS),
)

# fmt: on

OF_CALLER = {"valid", "fidelity_used"}  # outputs that the core leaves to its caller, who chooses what is solved and how

OF_CORE = tuple(q for q in OUTPUTS if q.name not in OF_CALLER)

TABLE: dict[str, Quantity] = {q.name: q for q in (*INPUTS, *OUTPUTS)}

STATED = {q.name: q.error for q in OUTPUTS if q.error}  # outputs whose error is an output, and which one
ABSOLUTE = frozenset({"error_load_ratio"})  # errors in the unit of their output; the others are relative to it


def parameter(
    unit: str,
    text: str,
    *,
    above: float | None = None,
    least: float | None = None,
    most: float | None = None,
    default: Any = ...,
    choices: tuple[str, ...] = (),
    shapes_arrays: bool = False,
    quantity: str = "",
) -> Any:
    """Return a dataclass field with its SI unit, text and allowed range.

    `above` excludes its bound, `least` and `most` include theirs. `shapes_arrays` marks what decides the size of an
    array (such a field cannot become a tunable FMU parameter). `quantity` says what is measured, where the unit alone
    does not: see `measured`.
    """
    metadata = {
        "unit": unit,
        "text": text,
        "above": above,
        "least": least,
        "most": most,
        "choices": choices,
        "shapes_arrays": shapes_arrays,
        "quantity": measured(unit, quantity),
    }
    return field(metadata=metadata) if default is ... else field(default=default, metadata=metadata)


def input_parameter(name: str, *, text: str = "", default: Any = ...) -> Any:
    """Return a dataclass field for one of `INPUTS`, with its unit, text (or another one) and range from the table."""
    q = TABLE[name]
    return parameter(q.unit, text or q.text, least=q.minimum, most=q.maximum, default=default)


def out_of_range(record: Any, path: str) -> Iterator[str]:
    """Yield one sentence for each field of a dataclass (and of those in it) whose value is not allowed."""
    for f in fields(record):
        value, name = getattr(record, f.name), f"{path}.{f.name}" if path else f.name
        if is_dataclass(value):
            yield from out_of_range(value, name)
        elif isinstance(value, tuple):
            for i, item in enumerate(value):
                yield from out_of_range(item, f"{name}[{i}]")
        elif f.metadata.get("choices"):
            if value not in f.metadata["choices"]:
                yield f"{name} = {value!r} is not one of {', '.join(f.metadata['choices'])}."
        elif isinstance(value, (int, float)) and not isinstance(value, bool) and "unit" in f.metadata:
            yield from _number_sentence(name, value, f.metadata)


def numbers(record: Any, path: str = "") -> Iterator[tuple[str, float | int, "Field[Any]"]]:
    """Every number of a dataclass and of those in it that changes no array's shape: dotted name, value and field."""
    for f in fields(record):
        value, name = getattr(record, f.name), f"{path}.{f.name}" if path else f.name
        if is_dataclass(value):
            yield from numbers(value, name)
        elif isinstance(value, (int, float)) and not f.metadata["shapes_arrays"]:
            yield name, value, f


def with_numbers(record: Any, values: Mapping[str, float | int], path: str = "") -> Any:
    """Return the dataclass with some of its `numbers` changed, unchecked."""
    changes = {}
    for f in fields(record):
        value, name = getattr(record, f.name), f"{path}.{f.name}" if path else f.name
        if is_dataclass(value):
            changes[f.name] = with_numbers(value, values, name)
        elif name in values:
            changes[f.name] = values[name]
    return replace(record, **changes)


def value_out_of_range(q: Quantity, value: float) -> Iterator[str]:
    """Yield a sentence if a value of an input or output is not allowed."""
    least, most = (bound if math.isfinite(bound) else None for bound in (q.minimum, q.maximum))
    yield from _number_sentence(q.name, value, {"unit": q.unit, "text": q.text, "least": least, "most": most})


_LARGEST_MEASURED = {"friction_coefficient": 10.0}  # assumed
_BEYOND = 1e4  # assumed: times the nominal value of an output without a bound of its own


def measured_range(q: Quantity) -> tuple[float, float]:
    """Return the least and the largest value that an instrument can measure: others are marks, such as -9 or 1e30."""
    most = q.maximum if math.isfinite(q.maximum) else _LARGEST_MEASURED.get(q.name, _BEYOND * q.nominal)
    return max(q.minimum, -most), most


def _number_sentence(name: str, value: float, limits: Mapping[str, Any]) -> Iterator[str]:
    above, least, most, unit = (limits.get(key) for key in ("above", "least", "most", "unit"))
    inside = (above is None or value > above) and (least is None or value >= least) and (most is None or value <= most)
    if math.isfinite(value) and inside:
        return
    bounds = [
        "" if math.isfinite(value) else "finite",
        f"above {above:g}" if above is not None else f"at least {least:g}" if least is not None else "",
        f"at most {most:g}" if most is not None else "",
    ]
    unit = f" {unit}" if unit else ""
    yield f"{name} = {value:g}{unit} ({limits['text']}) must be {' and '.join(b for b in bounds if b)}{unit}."
