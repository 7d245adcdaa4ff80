"""Constants of nature, exact by the definition of the SI since 2019."""

BOLTZMANN = 1.380649e-23  # J/K
PLANCK = 6.62607015e-34  # J s
