"""The first mass of the two-mass oscillator under a held force, as a slave of pythonfmu."""

import cmath
from xml.etree.ElementTree import Element, SubElement

from pythonfmu import Fmi2Causality, Fmi2Initial, Fmi2Slave, Fmi2Variability, Real

UNITS = {"m": "kg", "k": "N/m", "d": "N.s/m", "x0": "m", "v0": "m/s", "F": "N", "x": "m", "v": "m/s"}
BASE_UNITS = {
    "kg": {"kg": "1"},
    "m": {"m": "1"},
    "m/s": {"m": "1", "s": "-1"},
    "N": {"kg": "1", "m": "1", "s": "-2"},
    "N/m": {"kg": "1", "s": "-2"},
    "N.s/m": {"kg": "1", "s": "-1"},
}
NOMINALS = {"F": 10.0, "x": 1.0, "v": 1.0}


class python_mass(Fmi2Slave):  # noqa: N801, the name of the FMU
    """m x'' + d x' + k x = F, exact for a force held over the step."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.m, self.k, self.d, self.x0, self.v0 = 1.0, 10.0, 0.1, 1.0, 0.0
        self.F = 0.0
        self.moving = False
        self.now = {"x": self.x0, "v": self.v0}
        for name in ("m", "k", "d", "x0", "v0"):
            kind = {"causality": Fmi2Causality.parameter, "variability": Fmi2Variability.fixed}
            self.register_variable(Real(name, start=getattr(self, name), **kind))
        self.register_variable(Real("F", start=0.0, causality=Fmi2Causality.input))
        for name in ("x", "v"):
            self.register_variable(
                Real(
                    name,
                    causality=Fmi2Causality.output,
                    initial=Fmi2Initial.calculated,
                    getter=lambda name=name: self.now[name] if self.moving else getattr(self, f"{name}0"),
                    setter=lambda value, name=name: self.now.update({name: value}),
                )
            )

    def exit_initialization_mode(self):
        self.now = {"x": self.x0, "v": self.v0}
        self.moving = True

    def do_step(self, current_time, step_size):
        decay = -self.d / (2.0 * self.m)
        omega = cmath.sqrt(decay**2 - self.k / self.m)
        fast, slow = decay + omega, decay - omega
        x, v = self.now["x"] - self.F / self.k, self.now["v"]
        a, b = (v - slow * x) / (fast - slow), (fast * x - v) / (fast - slow)
        a, b = a * cmath.exp(fast * step_size), b * cmath.exp(slow * step_size)
        self.now = {"x": (a + b).real + self.F / self.k, "v": (fast * a + slow * b).real}
        return True

    def to_xml(self, *arguments) -> Element:
        """Adds what pythonfmu leaves out: units, nominals, dependencies and the initial unknowns."""
        root = super().to_xml(*arguments)
        definitions = Element("UnitDefinitions")
        for unit, base in BASE_UNITS.items():
            SubElement(SubElement(definitions, "Unit", name=unit), "BaseUnit", base)
        root.insert([child.tag for child in root].index("CoSimulation") + 1, definitions)
        for variable in root.iter("ScalarVariable"):
            name = variable.get("name")
            variable.find("Real").set("unit", UNITS[name])
            if name in NOMINALS:
                variable.find("Real").set("nominal", str(NOMINALS[name]))
        structure = root.find("ModelStructure")
        for unknown in structure.find("Outputs"):
            unknown.set("dependencies", "")
        initial = structure.find("InitialUnknowns")
        if initial is None:
            initial = SubElement(structure, "InitialUnknowns")
        initial.clear()
        places = {variable.get("name"): str(i + 1) for i, variable in enumerate(root.iter("ScalarVariable"))}
        for name in ("x", "v"):
            SubElement(initial, "Unknown", index=places[name], dependencies=places[f"{name}0"])
        return root
