"""Closed forms and formulas, to test solvers against and to compare with.

    hertz         dry contact of smooth bodies: points, lines
    point_films   film of smooth point contacts by formula
    line_films    film of smooth line contacts
    starvation    film of contacts that are short of oil
    rolling       rolling resistance of smooth contacts, slip of dry ones
    profiles      of rollers
    oil           film factors for heat and shear of the oil
    evolution     tribofilm over time
    heat          temperature under moving sources
    constants     of nature

SI throughout, and scipy's parts are loaded at their first use.
"""

from .evolution import ghanbarzadeh_thickness
from .heat import jaeger_circle, tian_kennedy_circle
from .hertz import Hertz, HertzLine, hertz_line, hertz_point
from .line_films import SmoothLine, dowson_line, line_film, moes_line, moes_line_film
from .oil import FILM_OF_VISCOSITY, bair_thinning_factor, inlet_shear_factor
from .point_films import SmoothContact, hamrock_dowson, moes_film, nijenbanning_venner_moes, nvm_film
from .profiles import logarithmic_drop, rounded_drop
from .rolling import rolling_beyond_line, rolling_beyond_point, rolling_line, rolling_point, slipping_share
from .starvation import film_behind_meniscus, supplied_film
