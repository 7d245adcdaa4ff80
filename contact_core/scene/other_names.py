"""Other names that the field, or an earlier version, has for the keys of a scene, and what stands in their place."""

import logging
import re
from collections.abc import Mapping
from typing import Any, NamedTuple

_log = logging.getLogger(__name__)
# models of film in earlier versions, and the film.correction of the regression level that they stand for
_FORMER = {"auto": "blocks", "map": "map"}


class Meant(NamedTuple):
    """The meaning of another name of a key."""

    sentence: str
    keys: tuple[str, ...]  # of the same table, that the sentence asks for


_RADIUS = "combined radius 1 / (1/R_1 + 1/R_2), of a ball on a flat that of the ball"
_SPEEDS = Meant(
    "Give 'speed_1' and 'speed_2' [m/s], those of both surfaces through the contact: u_e (1 + SRR / 2) and "
    "u_e (1 - SRR / 2) at an entrainment speed u_e and a slide-to-roll ratio SRR.",
    ("speed_1", "speed_2"),
)
_MODULUS = Meant(
    "Give 'reduced_modulus' [Pa], E' = 2 / [(1 - v1^2)/E1 + (1 - v2^2)/E2], or set = 'steel' for steel on steel.",
    ("reduced_modulus",),
)
_SHEET = "'viscosity_40' and 'viscosity_100' [mm2/s] and 'density' [kg/m3] of its data sheet"
_VISCOSITY = Meant(
    f"Give the table [lubricant.viscosity] with {_SHEET}; or, of a dynamic viscosity, model = 'roelands' with "
    "'viscosity' [Pa s], 'reference_temperature', 'pressure_coefficient' and 'temperature_coefficient'.",
    ("viscosity",),
)
_COEFFICIENT = Meant(
    "The pressure coefficient of viscosity is 'pressure_coefficient' [GPa^-1] in [lubricant.viscosity].", ()
)
_WITH_HEAT = Meant(f"How viscosity falls with temperature follows from {_SHEET}.", ())
_INPUTS = Meant("Load, speeds, temperature and duration are keys of [operation].", ())
_BODIES = Meant(
    "Bodies are described by [solids] (moduli), [geometry] (radii), and [surface_1] and [surface_2] (roughness).", ()
)
_SURFACES = Meant("Roughness is 'rq' of each body, in [surface_1] and [surface_2].", ())

# table without its number, names apart by spaces; a name in other capitals is found, too
_TABLES: dict[str, tuple[tuple[str, Meant], ...]] = {
    "": (
        ("oil lube lubrication fluid", Meant("The oil is described by [lubricant].", ())),
        ("surface surfaces roughness ra topography", _SURFACES),
        ("condition conditions operating_conditions operating operating_point duty test speed", _INPUTS),
        ("body bodies body_1 body_2 material materials steel ball disc disk flat roller", _BODIES),
        ("contact radius r", Meant("The contact's shape is described by [geometry].", ())),
        ("friction", Meant("Friction of touching solids is described by [boundary_friction].", ())),
        ("grid mesh solver numerics", Meant("The grid is described by [film], the time steps by [control].", ())),
    ),
    "geometry": (
        (
            "r radius rx r_x r1 r_1 radius1 radius_1 ball_radius curvature combined_radius reduced_radius "
            "effective_radius equivalent_radius r_eff",
            Meant(f"Did you mean 'radius_x'? It is the {_RADIUS}.", ("radius_x",)),
        ),
        ("d diameter ball_diameter", Meant(f"Give 'radius_x', half of it: the {_RADIUS}.", ("radius_x",))),
        ("ry r_y", Meant(f"Did you mean 'radius_y'? It is the {_RADIUS}, across the motion.", ("radius_y",))),
        ("l length width", Meant("The length of a line contact is 'face_width' of model = 'line' or 'roller'.", ())),
    ),
    "control": (
        ("dry_above", Meant("Mixed lubrication drives every block, however much the solids carry. Leave it out.", ())),
    ),
    "operation": (
        ("u1 u_1 v1 v_1 speed1 velocity1 velocity_1", Meant("Did you mean 'speed_1'?", ("speed_1",))),
        ("u2 u_2 v2 v_2 speed2 velocity2 velocity_2", Meant("Did you mean 'speed_2'?", ("speed_2",))),
        (
            "speed velocity u v ue u_e um u_m us u_s srr sr entrainment entrainment_speed rolling_speed mean_speed "
            "sliding_speed slide_roll_ratio slide_to_roll slide_to_roll_ratio slip rpm",
            _SPEEDS,
        ),
        ("f fn f_n w force normal_force normal_load", Meant("Did you mean 'load'?", ("load",))),
        (
            "p p0 p_0 ph p_h p_max pmax pressure hertz_pressure max_pressure contact_pressure",
            Meant("Give 'load' [N]; Hertz's pressure follows, and a run says it before it starts.", ("load",)),
        ),
        ("T temp t_oil oil_temp oil_temperature bulk_temperature inlet_temperature", Meant(
            "Did you mean 'temperature'?", ("temperature",)
        )),
        ("t time hours stop_time test_time end end_time", Meant("Did you mean 'duration'?", ("duration",))),
        ("steps_file csv duty table", Meant("A duty's CSV is 'file'; the command takes it as --duty, too.", ())),
    ),
    "surface": (
        ("rms sigma roughness sq r_q s_q rms_roughness", Meant("Did you mean 'rq', the rms roughness?", ("rq",))),
        ("ra sa r_a s_a", Meant("Give 'rq', the rms roughness: of Gaussian heights 1.25 Ra.", ("rq",))),
        ("rz sz r_z", Meant("Give 'rq', the rms roughness of the same profile: it does not follow from Rz.", ("rq",))),
        ("wavelength lambda lc l_c", Meant("Did you mean 'correlation_length'?", ("correlation_length",))),
    ),
    "solids": (
        (
            "e e1 e2 e_1 e_2 e_prime e_star modulus young youngs_modulus young_modulus elastic_modulus nu nu1 nu2 v "
            "poisson poisson_ratio poissons_ratio poisson_ratio_1 poisson_ratio_2 material",
            _MODULUS,
        ),
        ("h hardness", Meant("'hardness' belongs to [plasticity].", ())),
    ),
    "film": (("n nodes grid resolution mesh", Meant("Did you mean 'points', nodes along x and y?", ())),),
    "lubricant": (
        ("eta eta0 eta_0 mu nu oil name grade iso_vg kinematic_viscosity dynamic_viscosity base_oil", _VISCOSITY),
        ("alpha pvc pressure_viscosity pressure_viscosity_coefficient", _COEFFICIENT),
        ("vi viscosity_index beta", _WITH_HEAT),
        ("temperature t", Meant("The oil's temperature is 'temperature' in [operation].", ())),
    ),
    "lubricant.viscosity": (
        ("v40 nu40 nu_40 kv40 kv_40 iso_vg vg", Meant("Did you mean 'viscosity_40' [mm2/s]?", ("viscosity_40",))),
        ("v100 nu100 nu_100 kv100 kv_100", Meant("Did you mean 'viscosity_100' [mm2/s]?", ("viscosity_100",))),
        ("alpha pvc pressure_viscosity pressure_viscosity_coefficient", Meant(
            "Did you mean 'pressure_coefficient' [GPa^-1]?", ("pressure_coefficient",)
        )),
        ("rho", Meant("Did you mean 'density'?", ("density",))),
        ("vi viscosity_index", _WITH_HEAT),
        ("beta", Meant("'temperature_coefficient' belongs to model = 'roelands' or 'barus'.", ())),
        ("eta eta0 eta_0 mu nu dynamic_viscosity", Meant(
            f"Give {_SHEET}; or 'viscosity' [Pa s] with model = 'roelands' or 'barus'.", ()
        )),
    ),
}  # fmt: skip


def meant(path: str, key: str) -> Meant | None:
    """Return what a key that the table at a dotted path does not have stands for; None if that is not known."""
    table = _TABLES.get(re.sub(r"\.steps\[\d+\]$|_[12]$", "", path), ())
    named = [(names.split(), said) for names, said in table]
    for name in (key, key.lower().replace("-", "_").replace("'", "")):
        for names, said in named:
            if name in names:
                return said
    return None


def with_correction(table: Mapping[str, Any]) -> dict[str, Any]:
    """Return a scene's table with film.correction in place of a model that earlier versions had for it."""
    film = table.get("film")
    former = film.get("model") if isinstance(film, Mapping) else film
    if not isinstance(former, str) or former not in _FORMER:
        return dict(table)
    rest = film if isinstance(film, Mapping) else {}
    return {**table, "film": {**rest, "model": "regression", "correction": _correction_of(former)}}


def current(overrides: Mapping[str, str]) -> dict[str, str]:
    """Return overrides with film.correction in place of a model that earlier versions had for it."""
    found: dict[str, str] = {}
    for key, value in overrides.items():
        if key in ("film", "film.model") and value in _FORMER:
            found |= {"film.model": "regression", "film.correction": _correction_of(value)}
        else:
            found[key] = value
    return found


def _correction_of(former: str) -> str:
    """Return the film.correction that a former model of film stands for, with a note."""
    correction = _FORMER[former]
    _log.warning("film.model = '%s' is film.model = 'regression' with film.correction = '%s'.", former, correction)
    return correction
