"""Constants of nature, exact by the definition of the SI since 2019 where nothing else is said."""

BOLTZMANN = 1.380649e-23  # J/K
PLANCK = 6.62607015e-34  # J s
ELEMENTARY_CHARGE = 1.602176634e-19  # C
VACUUM_PERMITTIVITY = 8.8541878128e-12  # F/m, measured: CODATA 2018
