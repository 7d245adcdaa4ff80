"""Viscosities of three named oils beside those of their data sheets."""

import numpy as np

from contact_core.quantities import CELSIUS
from contact_core.scene import Lubricant
from contact_core.scene.toml import build

from .model import Cause, Outcome, Row, exactly, relative

# kinematic viscosity at 40 and 100 degC [mm2/s], density at 15.6 degC [kg/m3]: Arana et al. 2019, table 2
OILS = {"m100": ((96.0, 10.6), 882.0), "pao100": ((94.1, 14.0), 840.0), "n100": ((97.9, 8.61), 900.0)}
EXPANSION = 7e-4  # 1/K, of mineral oils
CLASS = 0.1  # half width of an ISO viscosity class, ISO 3448
# half of the last digit of C [1e3 K] and D [K] of the constants printed in table 3
LAST_C, LAST_D = 5.0, 0.5


def run() -> Outcome:
    """Compare dynamic viscosities at atmospheric pressure."""
    rows = []
    for name, (kinematic, density) in OILS.items():
        law = build(Lubricant, {"set": name}, "lubricant").viscosity
        for nu, celsius in zip(kinematic, (40.0, 100.0), strict=True):
            kelvin = celsius + CELSIUS
            sheet = nu * density * (1.0 - EXPANSION * (celsius - 15.6)) * 1e-3  # mPa s
            low, found, high = (
                1e3 * float(law(np.zeros(1), np.array([t]))[0]) for t in (kelvin - 0.5, kelvin, kelvin + 0.5)
            )
            # eta = K exp(C / (T + D)): the slope over T is that over D
            offset, steep = kelvin + law.vogel_offset, abs(np.log(high / low))
            printed = float(np.hypot(LAST_C / offset, LAST_D * steep))
            rows.append(
                Row(
                    f"{name} at {celsius:g} degC", "mPa s", exactly(sheet), found, relative(sheet, 0.01),
                    "kinematic viscometry, ISO 3104: below 1 %",
                    relative(found, printed),
                    Cause(
                        "the constants are a fit to high-pressure viscometry (Mann 1995), not to this data sheet; the "
                        "class ISO VG 100 allows samples 10 % either way, so two may be 20 % apart",
                        sheet * (1.0 - 2.0 * CLASS - printed), sheet * (1.0 + 2.0 * CLASS + printed),
                    ),
                )
            )  # fmt: skip
    return Outcome(tuple(rows))
