"""Scenes on coarse grids that use every law and option once: name, shipped scene, what is changed, operating point."""

SMALL = {"film.points": "17", "surface_1.correlation_length": "32 um", "surface_2.correlation_length": "32 um"}
LINE = {
    "film.points": "33",
    "film.width": "0.2 mm",
    "surface_1.correlation_length": "50 um",
    "surface_2.correlation_length": "50 um",
    "film.tolerance": "1e-2",
    "control.mixed_instants": "2",
}
ROLLER = LINE | {
    "geometry.model": "roller",
    "geometry.face_width": "1.2 mm",
    "geometry.profile.model": "logarithmic",
    "geometry.profile.depth": "1 um",
    "film.width": "0 m",
    "operation.load": "300 N",
}
ROUNDED = ROLLER | {
    "geometry.profile.model": "rounded",
    "geometry.profile.straight": "1 mm",
    "geometry.profile.radius": "20 mm",
}
del ROUNDED["geometry.profile.depth"]
ELLIPSE = SMALL | {"geometry.radius_y": "30 mm", "film.width": "1 mm"}
SMOOTH = {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm"}
WARM = {"tribofilm.beyond_fit": "extrapolate"}
FILM = {"lubricant.cavitation": "mass_conserving", "lubricant.supply.model": "film"}
BULK = {
    "heat.bulk.model": "lumped",
    "heat.bulk.heat_capacity_1": "20 J/K",
    "heat.bulk.heat_capacity_2": "60 J/K",
    "heat.bulk.conductance_1": "0.5 W/K",
    "heat.bulk.conductance_2": "1 W/K",
}
CARREAU = {
    "lubricant.rheology.model": "carreau",
    "lubricant.rheology.critical_stress": "5 MPa",
    "lubricant.rheology.exponent": "0.5",
    "lubricant.rheology.limiting_coefficient": "0.047",
}
BARUS = {
    "lubricant.viscosity.model": "barus",
    "lubricant.viscosity.viscosity": "4 mPa s",
    "lubricant.viscosity.pressure_coefficient": "14 GPa^-1",
    "lubricant.viscosity.temperature_coefficient": "0.03 K^-1",
    "lubricant.viscosity.reference_temperature": "80 degC",
    "lubricant.density.model": "none",
}
ASTM = {
    "lubricant.viscosity.model": "astm_d341",
    "lubricant.viscosity.viscosity_40": "46 mm2/s",
    "lubricant.viscosity.viscosity_100": "6.8 mm2/s",
    "lubricant.viscosity.density": "870 kg/m3",
    "lubricant.viscosity.pressure_coefficient": "20 GPa^-1",
    "lubricant.viscosity.reference_temperature": "40 degC",
}
OILS = ("azam_oil", "m100", "pao100", "n100", "fva3", "minr", "paor", "pagd")
TRIBOFILMS = (
    "zddp_80c",
    "zhang_spikes_80c_ethylhexyl",
    "zhang_spikes_80c_octyl",
    "zhang_spikes_80c_cyclohexylethyl",
    "gosvami",
    "combined_80c",
)
CHOICES = (
    {"tribofilm.dose": "contact_length"},
    {"tribofilm.nodes": "stressed"},
    {"wear.sliding": "surface_speed"},
    {"plasticity.indentation": "total"},
    {"control.driver": "mixed"},
    {"control.driver": "dry"},
    {"control.inputs": "transient"},
    {"film.criterion": "lumped", "film.floor": "0.47 nm"} | {f"surface_{i}.microroughness.rms": "0 nm" for i in (1, 2)},
    {"film.fft": "scipy"},
    {"heat.model": "none"},
    {"heat.model": "field"},
    {"heat.inlet_shear": "gupta"},
    {"tribofilm.model": "none"},
    {"wear.model": "none"},
    {"lubricant.supply.model": "meniscus", "lubricant.supply.distance": "0.2 mm"},
    {"lubricant.cavitation": "mass_conserving"},
    SMOOTH,
)
POINTS = {
    "at rest": {"speed_1": 0.0, "speed_2": 0.0},
    "pure rolling": {"speed_1": 0.1, "speed_2": 0.1},
    "backward": {"speed_1": -0.1025, "speed_2": -0.0975},
    "opposite": {"speed_1": 0.2, "speed_2": -0.1},
    "without load": {"load": 0.0},
    "spinning": {"spin": 50.0},
    "fast": {"speed_1": 2.1, "speed_2": 1.9},
}

Variant = tuple[str, dict[str, str], dict[str, float]]


def _variants() -> dict[str, Variant]:
    found: dict[str, Variant] = {
        "coarse": ("mtm_zddp", SMALL, {}),
        "line": ("fzg_flank", LINE, {}),
        "line of one row": ("fzg_flank", LINE | SMOOTH | {"film.width": "0 m", "film.points": "129"}, {}),
        "line, starved": ("fzg_flank", LINE | FILM | {"lubricant.supply.thickness": "0.2 um"}, {}),
        "line, heat field and thinned oil": (
            "fzg_flank",
            LINE | {"heat.model": "field", "lubricant.flow": "local", "heat.inlet_shear": "gupta"},
            {},
        ),
        "roller, logarithmic": ("fzg_flank", ROLLER, {}),
        "roller, rounded": ("fzg_flank", ROUNDED, {}),
        "ellipse": ("mtm_zddp", ELLIPSE, {}),
        "ellipse, other radii": ("mtm_zddp", ELLIPSE, {"radius_x": 9e-3, "radius_y": 28e-3}),
        "ellipse, spinning, starved": (
            "mtm_zddp",
            ELLIPSE | FILM | {"lubricant.supply.thickness": "50 nm"},
            {"spin": 20.0},
        ),
        "bodies with their own temperatures": (
            "azam_case_a",
            SMALL | WARM | {"heat.bulk.model": "inputs"},
            {"body_temperature_1": 361.0, "body_temperature_2": 365.0},
        ),
        "bodies that warm up": ("azam_case_a", SMALL | WARM | BULK | {"heat.model": "field"}, {}),
        "tribofilm andersson_90c": ("azam_case_a", SMALL | {"tribofilm.set": "andersson_90c"}, {}),
        "tribofilm beyond its fit": ("azam_case_a", SMALL | WARM | {"tribofilm.set": "zddp_80c"}, {}),
        "carreau": ("azam_case_a", SMALL | CARREAU, {}),
        "carreau, thinned oil": ("azam_case_a", SMALL | CARREAU | {"lubricant.flow": "local"}, {}),
        "barus": ("mtm_zddp", SMALL | BARUS, {}),
        "astm_d341": ("azam_case_a", SMALL | ASTM | {"heat.model": "field"}, {}),
    }
    found |= {f"oil {name}": ("azam_case_a", SMALL | {"lubricant.set": name}, {}) for name in OILS}
    found |= {f"tribofilm {name}": ("mtm_zddp", SMALL | {"tribofilm.set": name}, {}) for name in TRIBOFILMS}
    for choice in CHOICES:
        told = ", ".join(f"{key}={value}" for key, value in choice.items())
        found[told] = ("mtm_zddp", SMALL | choice, {})
    found |= {name: ("mtm_zddp", SMALL | {"tribofilm.nodes": "contacts"}, point) for name, point in POINTS.items()}
    return found


VARIANTS = _variants()
