"""Closed forms, as library code: what solvers are tested against and what engineers compare with.

    hertz         dry contact of smooth bodies: points, lines
    point_films   film of smooth point contacts by formula
    line_films    film of smooth line contacts
    oil           what heat and shear of the oil make of a film
    evolution     tribofilm and wear over time
    heat          temperature under moving sources

SI throughout, and scipy's parts are loaded at their first use.
"""

from .evolution import archard_depth, ghanbarzadeh_thickness, load_cycles
from .heat import jaeger_band, jaeger_circle, tian_kennedy_circle
from .hertz import Hertz, HertzLine, hertz_line, hertz_point
from .line_films import SmoothLine, dowson_line, moes_line, moes_line_film
from .oil import bair_thinning_factor, inlet_shear_factor
from .point_films import SmoothContact, hamrock_dowson, moes_film, nijenbanning_venner_moes, nvm_film

__all__ = [
    "Hertz",
    "HertzLine",
    "SmoothContact",
    "SmoothLine",
    "archard_depth",
    "bair_thinning_factor",
    "dowson_line",
    "ghanbarzadeh_thickness",
    "hamrock_dowson",
    "hertz_line",
    "hertz_point",
    "inlet_shear_factor",
    "jaeger_band",
    "jaeger_circle",
    "load_cycles",
    "moes_film",
    "moes_line",
    "moes_line_film",
    "nijenbanning_venner_moes",
    "nvm_film",
    "tian_kennedy_circle",
]
