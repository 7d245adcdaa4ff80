"""Load shared between solids and oil of rough bodies: curves fitted to deterministic solutions."""

from collections.abc import Callable
from dataclasses import dataclass, field, fields
from math import inf
from typing import ClassVar, NamedTuple

from ..quantities import parameter
from .elementary import Numbers, exp, expm1, log1p, maximum, minimum, sqrt
from .equations import Equations

_FLATTENING = 0.2  # reference of the constants: about that of the shipped circles
# films and flattening beyond which no solid carries anything: no power of them may overflow
_THICKEST, _MOST = 1e30, 1e60
_AMID, _EVENED = 0.45, 1.15  # flattening at which oil keeps `oil_kept`, and scale of its change with flattening
_FURTHER = 1.25  # times the largest numbers of the fit, beyond which they count no more
_YIELDING = 10.0  # hardness over the pressure at which asperities begin to yield, chosen
_ALL_WAVES = 2.3  # their rms slope over that of the longest wave alone, see `asperity_layer`
_FLAT = 1e-12  # square of the inverse flattening of bodies without any roughness


def rms_slope(rq_1: Numbers, length_1: Numbers, rq_2: Numbers, length_2: Numbers) -> Numbers:
    """Return the rms gradient of the composite roughness of two bodies, from rms roughness and correlation length [m].

    A surface with the autocorrelation rq^2 exp(-(r/l)^2) has the rms gradient 2 rq / l.
    """
    return 2.0 * sqrt((rq_1 / length_1) ** 2 + (rq_2 / length_2) ** 2)


def flattening_of(mean_pressure: Numbers, reduced_modulus: float, slope: Numbers) -> Numbers:
    """Return the mean Hertz pressure over that which presses the roughness flat, p_m / (E* slope).

    E* = reduced_modulus / 2.

    The number that decides the real area of dry contact: Persson, J. Chem. Phys. 115 (2001) 3840,
    doi:10.1063/1.1388626.
    """
    return mean_pressure / (0.5 * reduced_modulus * slope)


def layer_height(floor: Numbers, rms: Numbers) -> Numbers:
    """Return the height [m] to which roughness below the grid reaches, of the rms height `rms` [m] of both bodies.

    It stands on the floor [m], where solids touch.
    """
    return floor + rms


def sliding_ratio(sliding: float, entrainment: float) -> float:
    """Return sliding over entrainment speed, absolute; inf where nothing is entrained."""
    return abs(sliding / entrainment) if entrainment != 0.0 else inf


def flattening_together(flattening: Numbers, below: Numbers, weight: float) -> Numbers:
    """Return the flattening by both slopes, that of roughness below the grid `weight` times as steep."""
    return 1.0 / sqrt(1.0 / flattening**2 + (weight / below) ** 2 + _FLAT)


class Widths(NamedTuple):
    """Half widths of 95 % of the deterministic solutions about the law, on points that it was not fitted to.

    Of W_c it is load [W_c + least exp(-2 Z)]^3/4 (1 - W_c)^1/2; of h_c, relative, film (1 + Z)^-film_fall but at least
    film_least; of the oil's friction, relative, [plastic (1 - n) + newtonian n] [1 + rough exp(-2 Z)], which grows with
    the sliding speed to n.
    """

    load: float
    least: float
    film: float
    film_fall: float
    film_least: float
    plastic: float
    newtonian: float
    rough: float

    def of_load(self, load_ratio: float, clearance: float) -> float:
        """Return the half width of contact_load_ratio, absolute."""
        touching = (load_ratio + self.least * exp(-2.0 * clearance)) ** 0.75
        return float(self.load * touching * sqrt(1.0 - load_ratio))

    def of_film(self, clearance: float) -> float:
        """Return the half width of h_c, relative."""
        return max(self.film * (1.0 + clearance) ** -self.film_fall, self.film_least)

    def of_oil(self, clearance: float, slope: float) -> float:
        """Return the half width of the oil's friction, relative.

        `slope` is d ln(friction) / d ln(sliding speed).
        """
        newtonian = minimum(maximum(slope, 0.0), 1.0)
        widest = self.plastic + (self.newtonian - self.plastic) * newtonian
        return float(widest * (1.0 + self.rough * exp(-2.0 * clearance)))


class Parting(NamedTuple):
    """What parts the solids, at any slip."""

    film: Numbers  # of the oil between asperities, before it is eased
    yielding: Numbers  # factor on it
    apart: Numbers  # Z^2


class Films(NamedTuple):
    """h_c / sigma of a contact that is dry, and of one that is not: `larger` times `both`."""

    dry: Numbers
    larger: Numbers
    both: Numbers

    def ratio(self, load_ratio: Numbers) -> Numbers:
        """Return h_c / sigma where the solids carry `load_ratio` of the load."""
        return load_ratio * self.dry + (1.0 - load_ratio) * self.larger * self.both


@dataclass(frozen=True)
class FittedSharing:
    """W_c, A_c, h_c and the exposure of both bodies as functions of a few numbers, for circles and ellipses.

    clearance   Z, film of the smooth bodies by the formula of their shape / composite rms roughness,
    layers      f, that film / the height to which roughness below the grid reaches, see `layer_height`,
    flattening  s, see `flattening_of`, of the roughness on the grid,
    below       s_m, the same of one wave of the longest length and the rms height of what is below the grid,
    slip        sliding over entrainment speed, see `sliding_ratio`: asperities that slide past each other lift more
                oil between them than those that oil moves along with,
    pressed     Hertz's largest pressure over the hardness: asperities that yield are not pressed flat by the oil.

    `equations` states them. The constants were fitted over the ranges `FITTED`; `HALF_WIDTHS` are those of their 95 %
    intervals (`regression.curves` of the benchmarks of revision 869ed0dc).
    """

    name: ClassVar[str] = "fitted"
    source: ClassVar[str] = (
        "form of W_c: Zhou & Hoeprich, J. Tribol. 113 (1991) 590, doi:10.1115/1.2920664; "
        "constants: fitted to solved contacts"
    )
    equations: ClassVar[Equations] = Equations(
        (
            "W_c = exp[−B f^C (5 s)^m (5 s_m)^l e − b Z^2],   e = (1 + Σ)^v (1 + 10 Π)^{−y}",
            "A_c = {1 − exp[−A (s^{−2} + 5.29 s_m^{−2})^{−1/2}]} W_c^D",
            "h_c/σ = W_c g + (1 − W_c) [(E Z/ρ)^n + j^n]^{1/n}",
            "g = (G/k) ln[1 + k (5 s)^{−1.5}] + H Z/f,   j = max[F (5 s)^{−0.75}, g]",
        ),
        "Z: film of the smooth bodies by the formula of their shape over composite roughness; f: that film over "
        "film.floor and the microroughness of both bodies together; s: mean Hertz pressure over what would press flat "
        "the roughness on the grid, sm: the longest wave below it; Σ: sliding over entrainment speed; Π: Hertz's "
        "largest pressure over the hardness; s, sm and Σ count at most as 1.25 times the largest of the fit; "
        "ρ: density of the oil under Hertz's mean pressure, over that without pressure.",
        symbols={
            "B": "load_factor", "C": "load_exponent", "m": "load_flattening", "l": "load_below", "v": "load_slip",
            "y": "load_yield", "b": "load_parted", "A": "area_factor", "D": "area_exponent", "G": "film_dry",
            "k": "film_parted", "H": "film_layer", "F": "film_mixed", "E": "film_factor", "n": "film_exponent",
            "Z": "film of the smooth bodies by formula over composite rms roughness [1]",
            "f": "that film over the height to which roughness below the grid reaches [1]",
            "s": "flattening of the roughness on the grid [1]",
            "s_m": "flattening of the longest wave below the grid [1]",
            "Π": "Hertz's largest pressure over the hardness [1]",
            "ρ": "density of the oil under Hertz's mean pressure, over that at p = 0 [1]",
        },
    )  # fmt: skip
    FITTED: ClassVar[dict[str, tuple[float, float]]] = {
        "clearance": (0.003, 47.0),
        "layers": (0.014, 94.0),
        "flattening": (0.0679, 5.4),
        "below": (0.118, 1.63),
        "slip": (0.0013, 2.0),  # solved to 1.6; at 2 a body rests
        "pressed": (0.072, 0.51),
    }
    WIDTHS: ClassVar[Widths] = Widths(0.29, 0.08, 0.25, 1.0, 0.08, 0.11, 0.16, 2.0)
    CHOSEN: ClassVar[frozenset[str]] = frozenset({"load_yield", "oil_pressure_power", "oil_steepness"})
    HALF_WIDTHS: ClassVar[dict[str, float]] = {
        "load_factor": 0.022,
        "load_exponent": 0.075,
        "load_flattening": 0.064,
        "load_below": 0.11,
        "load_slip": 0.25,
        "load_parted": 0.28,
        "area_factor": 0.013,
        "area_exponent": 0.019,
        "film_dry": 0.044,
        "film_parted": 0.25,
        "film_layer": 0.073,
        "film_mixed": 0.064,
        "film_factor": 0.048,
        "film_exponent": 0.23,
        "oil_pressure_excess": 0.18,
        "oil_pressure_decay": 0.094,
        "oil_kept": 0.034,
        "oil_spread": 0.056,
        "exposure_rougher": 0.43,
        "exposure_exponent": 0.18,
        "exposure_smoother": 1.5,
        "exposure_dry_rougher": 0.032,
        "exposure_dry_smoother": 0.19,
        "exposure_spread_rougher": 0.017,
        "exposure_spread_smoother": 0.053,
    }

    load_factor: float = parameter("", "B", above=0.0, most=100.0, default=0.267)
    load_exponent: float = parameter("", "C", above=0.0, most=10.0, default=0.944)
    load_flattening: float = parameter("", "m, power of s beside f", above=0.0, most=10.0, default=0.561)
    load_below: float = parameter("", "l, power of s_m", least=0.0, most=10.0, default=0.292)
    load_slip: float = parameter("", "v, power of the sliding", least=0.0, most=5.0, default=1.05)
    load_yield: float = parameter("", "y, power of what yields", least=0.0, most=5.0, default=0.0)
    load_parted: float = parameter("", "b, of asperities that part", least=0.0, most=1e3, default=0.517)
    area_factor: float = parameter("", "A, of the dry contact's area", above=0.0, most=100.0, default=2.47)
    area_exponent: float = parameter("", "D", above=0.0, most=10.0, default=0.871)
    film_dry: float = parameter("", "G, h_c of the dry contact / roughness", least=0.0, most=10.0, default=0.322)
    film_parted: float = parameter("", "k, how fast lightly pressed bodies part", above=0.0, most=100.0, default=0.378)
    film_layer: float = parameter(
        "",
        "H, part of the height of roughness below the grid that dry bodies keep",
        least=0.0,
        most=10.0,
        default=0.529,
    )
    film_mixed: float = parameter(
        "", "F, h_c that oil between asperities keeps / roughness", least=0.0, most=10.0, default=0.564
    )
    film_factor: float = parameter("", "E, h_c / film of smooth bodies", above=0.0, most=10.0, default=0.899)
    film_exponent: float = parameter("", "n", least=0.1, most=20.0, default=1.37)
    oil_pressure_excess: float = parameter(
        "", "K, of the pressure at which oil carries load / Hertz's", least=0.0, most=100.0, default=1.02
    )
    oil_pressure_decay: float = parameter(
        "", "d, how fast thicker films bring it down", least=0.0, most=100.0, default=0.316
    )
    oil_pressure_power: float = parameter("", "q, the more so of rougher bodies", least=0.0, most=5.0, default=1.0)
    oil_steepness: float = parameter("", "w, how much more steep roughness raises it", least=0.0, most=5.0, default=1.0)
    oil_kept: float = parameter(
        "", "c, friction of oil whose pressure is uneven, over that of even one", above=0.0, most=1.0, default=0.867
    )
    oil_spread: float = parameter(
        "", "S, how far thick films spread the load beyond Hertz's contact", least=0.0, most=100.0, default=0.225
    )
    exposure_rougher: float = parameter(
        "", "k in exposed = 1 - exp(-k A_c^m) of the rougher body", above=0.0, most=1e3, default=1.08
    )
    exposure_exponent: float = parameter("", "m, of the rougher body", above=0.0, most=10.0, default=0.78)
    exposure_smoother: float = parameter(
        "", "k in exposed = 1 - exp(-k A_c) of the smoother body", above=0.0, most=1e4, default=10.3
    )
    exposure_dry_rougher: float = parameter(
        "", "k of the rougher body in blocks driven dry, m = 1", above=0.0, most=1e3, default=1.35
    )
    exposure_dry_smoother: float = parameter(
        "", "k of the smoother body in blocks driven dry", above=0.0, most=1e3, default=3.16
    )
    exposure_spread_rougher: float = parameter(
        "", "V, variance of the exposure over that of all or nothing, rougher body", above=0.0, most=0.99, default=0.708
    )
    exposure_spread_smoother: float = parameter("", "V of the smoother body", above=0.0, most=0.99, default=0.801)

    def parting(
        self, clearance: Numbers, layers: Numbers, flattening: Numbers, below: Numbers, pressed: Numbers
    ) -> Parting:
        """Return what parts the solids, at any slip.

        Oil between the asperities takes the load from what is below the grid; as Z grows, the asperities part.
        """
        flattest, lowest = (_FURTHER * self.FITTED[name][1] for name in ("flattening", "below"))
        flat = minimum(flattening, flattest) / _FLATTENING
        fine = minimum(below, lowest) / _FLATTENING
        yielding = (1.0 + _YIELDING * pressed) ** -self.load_yield
        film = minimum(layers, _THICKEST) ** self.load_exponent * (flat**self.load_flattening * fine**self.load_below)
        return Parting(film, yielding, minimum(clearance, _THICKEST) ** 2)

    def load_ratio_at(self, slip: Numbers, parting: Parting) -> Numbers:
        """Return W_c at a slip."""
        fastest = _FURTHER * self.FITTED["slip"][1]
        ease = (1.0 + minimum(slip, fastest)) ** self.load_slip * parting.yielding
        film, apart = minimum(parting.film * ease, _MOST), minimum(parting.apart, _MOST)
        return exp(-self.load_factor * film - self.load_parted * apart)

    def dry_area(self, flattening: Numbers, below: Numbers) -> Numbers:
        """Return A_c where the solids carry all of the load; elsewhere it is W_c^D times that."""
        return -expm1(-self.area_factor * flattening_together(flattening, below, _ALL_WAVES))

    def films(self, dense: Numbers, flattening: Numbers, layer: Numbers) -> Films:
        """Return h_c / sigma of solids that carry everything, and of oil that does, at Z / rho = `dense`.

        `layer` is Z / f, the height to which roughness below the grid reaches over sigma.
        """
        flat = (flattening / _FLATTENING) ** -0.75
        dry = self.film_dry * log1p(self.film_parted * (flat * flat)) / self.film_parted + self.film_layer * layer
        mixed = maximum(self.film_mixed * flat, dry)
        film = self.film_factor * dense
        larger = maximum(film, mixed)  # in front, because powers of large numbers overflow
        ratio = minimum(film, mixed) / larger
        return Films(dry, larger, (1.0 + ratio**self.film_exponent) ** (1.0 / self.film_exponent))

    def oil_pressure(self, clearance: Numbers, flattening: Numbers, thick_x: Numbers, thick_y: Numbers) -> Numbers:
        """Return the pressure at which oil carries load, over Hertz's.

        It is [1 + K t^-w exp(-d Z t^-q)] / sqrt[(1 + S X) (1 + S Y)], with t = s / 0.2.

        Between rough bodies the oil carries its load in spots, on the part (1 - W_c) / `oil_pressure` of Hertz's area;
        at the pressure of a load spread over all that the solids leave, it would be too thin to shear. A film h that is
        thick beside the depth of Hertz's contact, X = h R_x / a^2 and Y = h R_y / b^2, 0 for lines, carries the load on
        a larger area than Hertz's.
        """
        steep = _FLATTENING / flattening
        fall = self.oil_pressure_decay * clearance * steep**self.oil_pressure_power
        raised = 1.0 + self.oil_pressure_excess * steep**self.oil_steepness * exp(-fall)
        return raised / sqrt((1.0 + self.oil_spread * thick_x) * (1.0 + self.oil_spread * thick_y))

    def kept(self, flattening: Numbers) -> Numbers:
        """Return the friction of oil over that under even pressure.

        It is `oil_kept` amid the flattenings of the fit; what is pressed flat leaves the pressure even.
        """
        return self.oil_kept ** exp((_AMID - flattening) / _EVENED)

    def covers(
        self, clearance: float, layers: float, flattening: float, below: float, slip: float, pressed: float
    ) -> bool:
        """Return True if the point lies within those of the fit.

        Or has a film across which no layer reaches, rolls, or is so hard that nothing yields.
        """
        ends = self.FITTED | {"layers": (self.FITTED["layers"][0], inf)}
        ends |= {name: (0.0, self.FITTED[name][1]) for name in ("slip", "pressed")}
        point = clearance, layers, flattening, below, slip, pressed
        return all(low <= here <= high for here, (low, high) in zip(point, ends.values(), strict=True))

    def nearest(self, flattening: float) -> float:
        """Return the nearest flattening in the range of validity of the curves.

        It is that of the fit, and roughness that is pressed flatter than there.
        """
        return max(flattening, self.FITTED["flattening"][0])

    def exposed(self, area_ratio: Numbers, *, rougher: bool, dry: bool = False) -> Numbers:
        """Return the share of a body's points within Hertz's width that touch the other body in one pass.

        1 - exp(-k A_c^q), with k and q of the rougher or the smoother body.

        `dry`: where dry contact drives the blocks (control.driver).
        """
        if dry:
            return -expm1(-(self.exposure_dry_rougher if rougher else self.exposure_dry_smoother) * area_ratio)
        if rougher:
            return -expm1(-self.exposure_rougher * area_ratio**self.exposure_exponent)
        return -expm1(-self.exposure_smoother * area_ratio)

    def coverage(self, exposed: Numbers, growth: Numbers, *, rougher: bool) -> Numbers:
        """Return the coverage of a body: its mean growth over the growth where it is rubbed, by exposure.

        C = [C_0^n + (1 - C_0^n) g^n]^(1/n), C_0 = m / [m + V (1 - m)], n = 2 / (1 - V), m being the mean exposure and g
        the mean growth.

        `exposed` is the mean exposure, 0 to 1, and `growth` the mean growth over its full thickness.

        Some points are rubbed hard and some hardly at all. Exposures m of variance V m (1 - m) begin with a coverage
        of m / [m + V (1 - m)]; points rubbed little follow as the others fill up. That growth is the closed form of
        exposures of a beta distribution, to 11 %; for V = 1, all or nothing, the coverage stays m.
        """
        spread = self.exposure_spread_rougher if rougher else self.exposure_spread_smoother
        first, power = exposed / (exposed + spread * (1.0 - exposed)), 2.0 / (1.0 - spread)
        larger = maximum(first, growth)  # in front, because powers of small numbers vanish
        later = (1.0 - first**power) * (growth / larger) ** power
        return larger * ((first / larger) ** power + later) ** (1.0 / power)


def _refitted(**values: float) -> Callable[[type], type]:
    """Return a decorator that gives the constants of a class's base other values."""

    def refitted(cls: type) -> type:
        for f in fields(cls.__base__):  # type: ignore[arg-type]
            if f.name in values:
                cls.__annotations__[f.name] = f.type
                setattr(cls, f.name, field(default=values[f.name], metadata=f.metadata))
        return cls

    return refitted


@dataclass(frozen=True)
@_refitted(
    load_factor=0.134, load_exponent=1.45, load_flattening=1.42, load_below=0.0, load_slip=1.43, load_yield=0.796,
    load_parted=0.704, area_factor=2.34, area_exponent=0.853, film_dry=0.902, film_parted=2.67, film_layer=1.06,
    film_mixed=0.391, film_factor=0.919, film_exponent=1.4, oil_pressure_excess=3.45, oil_pressure_decay=0.56,
    oil_pressure_power=0.0, oil_steepness=1.71, oil_kept=0.884, oil_spread=1.12,
)  # fmt: skip
class LineSharing(FittedSharing):
    """The law of `FittedSharing` with the constants of lines and rollers, fitted to the roughness of gear flanks."""

    name: ClassVar[str] = "fitted_lines"
    FITTED: ClassVar[dict[str, tuple[float, float]]] = {
        "clearance": (0.035, 13.6),
        "layers": (0.465, 116.0),
        "flattening": (0.0321, 0.85),
        "below": (0.0169, 1.22),
        "slip": (0.003, 5.0),
        "pressed": (0.014, 0.71),
    }
    CHOSEN: ClassVar[frozenset[str]] = frozenset({"load_below", "oil_pressure_power"})
    HALF_WIDTHS: ClassVar[dict[str, float]] = {
        "load_factor": 0.045,
        "load_exponent": 0.15,
        "load_flattening": 0.16,
        "load_slip": 0.21,
        "load_yield": 0.25,
        "load_parted": 0.25,
        "area_factor": 0.046,
        "area_exponent": 0.023,
        "film_dry": 0.27,
        "film_parted": 1.2,
        "film_layer": 0.57,
        "film_mixed": 0.081,
        "film_factor": 0.12,
        "film_exponent": 0.3,
        "oil_pressure_excess": 2.2,
        "oil_pressure_decay": 0.41,
        "oil_steepness": 0.39,
        "oil_kept": 0.066,
        "oil_spread": 4.0,
        "exposure_rougher": FittedSharing.exposure_rougher,  # all of it: it is that of circles
    }
    WIDTHS: ClassVar[Widths] = Widths(0.47, 0.08, 0.21, 0.2, 0.16, 0.31, 0.36, 0.5)


LAWS: tuple[type[FittedSharing], ...] = (FittedSharing, LineSharing)
