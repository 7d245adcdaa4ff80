"""Effect of heat and shear of the oil on the film thickness."""

FILM_OF_VISCOSITY = 0.67  # power of the viscosity in the film of smooth bodies (Hamrock & Dowson)


def inlet_shear_factor(
    viscosity: float,
    temperature_coefficient: float,
    entrainment_speed: float,
    slide_roll_ratio: float,
    conductivity: float,
    pressure_max: float,
    reduced_modulus: float,
) -> float:
    """Return the film thickness with shear heating of the inlet over the isothermal one; 0.01 to 1.

    (1 - 13.2 (p_H / E') Q^0.42) / [1 + 0.213 (1 + 2.23 |SRR|^0.83) Q^0.64], Q = eta0 beta u_e^2 / k, with viscosity
    eta0 [Pa s] and its temperature_coefficient beta = -d ln(eta)/dT [1/K] at the inlet, conductivity k of the oil
    [W/(m K)], slide_roll_ratio (u1 - u2) / u_e, Hertz pressure p_H [Pa] and E' [Pa]. Beyond any contact, where the
    numerator would vanish, it is 0.01.
    Source: Gupta, Cheng, Zhu, Forster & Schrand, Tribol. Trans. 35 (1992) 269, doi:10.1080/10402009208982117.
    """
    heat = viscosity * temperature_coefficient * entrainment_speed**2 / conductivity
    film = 1.0 - 13.2 * pressure_max / reduced_modulus * heat**0.42
    factor = film / (1.0 + 0.213 * (1.0 + 2.23 * abs(slide_roll_ratio) ** 0.83) * heat**0.64)
    return max(factor, 0.01)


def bair_thinning_factor(
    newtonian_film: float,
    entrainment_speed: float,
    viscosity: float,
    critical_stress: float,
    exponent: float,
    slide_roll_ratio: float = 0.0,
) -> float:
    """Return the central film thickness of a Carreau oil over the newtonian_film h_N [m]; 0 to 1.

    {1 + 0.79 [(1 + S) u_e eta0 / (h_N G)]^[1 / (1 + 0.2 S)]}^[-3.6 (1 - n)^1.7], viscosity eta0 [Pa s] at p = 0,
    critical_stress G [Pa] and exponent n of Carreau's law, S = |u1 - u2| / u_e; fitted for n from 0.3 to 0.8.
    Source: Bair, Proc. IMechE J 219 (2005) 69.
    """
    slip = abs(slide_roll_ratio)
    shear = (1.0 + slip) * abs(entrainment_speed) * viscosity / (newtonian_film * critical_stress)
    return float((1.0 + 0.79 * shear ** (1.0 / (1.0 + 0.2 * slip))) ** (-3.6 * (1.0 - exponent) ** 1.7))
