"""Native FMUs of components: their C, and the Python that it was written from."""

import math
import random
import shutil
import zipfile
from pathlib import Path

import fmpy
import pytest
from built import Built
from fmpy.fmi2 import FMU2Slave
from fmpy.validation import validate_fmu

from contact_core.errors import SceneError
from fmu_src.flavours import Flavour
from fmu_src.native import build as native_build
from system_models.machines.ball_bearing.geometry import BEARING_209
from system_models.machines.ball_bearing.part import BallBearing
from system_models.machines.gear_pair.geometry import FZG_C
from system_models.machines.gear_pair.mesh import GearMesh
from system_models.machines.gear_pair.shafts import GearShafts
from system_models.parts.brake import Brake
from system_models.parts.build import build
from system_models.parts.part import Part, Values, start_values
from system_models.parts.shaft import Shaft
from system_models.parts.speed_source import SpeedSource
from system_models.parts.thermal import Link, Node, ThermalNetwork, Thermostat
from system_models.parts.timetable import Entry, Signal, Timetable

pytestmark = [pytest.mark.fmu, pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")]

ROUNDING = 1e-10  # of a value, at least a thousandth of its nominal
BY_PART = {"BallBearing": 1e-7}  # of a light load beside large ones, of which an equilibrium leaves 1e-10
HOUSE = ThermalNetwork(
    nodes=(Node("oil", 2500.0, 330.0), Node("housing", 9000.0, 300.0)),
    links=(Link("oil", "housing", 60.0), Link("housing", "ambient", 12.0)),
    thermostats=(Thermostat("oil", 350.0, gain=1000.0, heating=3000.0, cooling=500.0),),
)
PARTS: tuple[Part, ...] = (
    Brake(),
    SpeedSource(ramp=40.0),
    Shaft(inertia=0.02, coupling=1.0, damping=0.1, initial_speed=10.0),
    GearShafts(pair=FZG_C, inertia_1=0.2, inertia_2=0.3, stiffness=2e8, coupling=2000.0, start_speed=200.0),
    GearMesh(pair=FZG_C, stations=5),
    HOUSE,
    BallBearing(dimensions=BEARING_209, levels=3),
    Timetable((Signal("speed", "rad/s", (Entry(0.0, 1.0), Entry(3.0, 2.0), Entry(40.0, -1.0))),)),
)


@pytest.fixture(autouse=True)
def gcc(monkeypatch: pytest.MonkeyPatch) -> None:
    """Build with gcc: zig takes seconds to start."""
    monkeypatch.setattr(native_build, "default_compiler", lambda: "gcc")


class Running:
    """A native FMU after initialisation."""

    def __init__(self, part: Part, built: Built) -> None:
        self.file = built.fmu(part, "native", here=True)
        description = fmpy.read_model_description(str(self.file))
        self.references = {v.name: v.valueReference for v in description.modelVariables}
        self.fmu = FMU2Slave(
            guid=description.guid,
            unzipDirectory=str(built.unpacked(part, "native", here=True)),
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="part",
        )
        self.fmu.instantiate()
        self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()
        self.time = 0.0

    def set(self, inputs: Values) -> None:
        """Set inputs."""
        self.fmu.setReal([self.references[name] for name in inputs], list(inputs.values()))

    def step(self, size: float) -> None:
        """Make a step."""
        self.fmu.doStep(self.time, size)
        self.time += size

    def apart(self, part: Part, expected: Values) -> float:
        """The largest difference from outputs."""
        found = dict(zip(expected, self.fmu.getReal([self.references[name] for name in expected]), strict=True))
        sizes = {q.name: max(abs(expected[q.name]), 1e-3 * (q.nominal or 1.0)) for q in part.responses}
        left = {"residual": math.inf}  # what rounding leaves
        return max(abs(found[name] - value) / left.get(name, sizes[name]) for name, value in expected.items())


def near(part: Part, generator: random.Random) -> dict[str, float]:
    """Inputs about those of the start."""
    start, nominals = start_values(part), {q.name: q.nominal or 1.0 for q in part.inputs}
    return {name: value + 0.1 * nominals[name] * generator.uniform(-1.0, 1.0) for name, value in start.items()}


@pytest.mark.parametrize("part", PARTS, ids=lambda part: part.name)
def test_a_component_in_c_answers_as_its_python(part: Part, built: Built) -> None:
    """At the start, with new inputs before a step, and after steps from a millisecond to some minutes."""
    running, generator = Running(part, built), random.Random(1)
    inputs = start_values(part)
    state = part.initial(inputs)
    worst = running.apart(part, part.outputs(state, inputs))
    for _ in range(40):
        inputs, size = near(part, generator), 10.0 ** generator.uniform(-3.0, 2.5)
        running.set(inputs)
        worst = max(worst, running.apart(part, part.outputs(state, inputs)))
        running.step(size)
        state = part.advance(state, inputs, size)
        worst = max(worst, running.apart(part, part.outputs(state, inputs)))
    running.fmu.terminate()
    running.fmu.freeInstance()
    assert worst < BY_PART.get(part.name, ROUNDING)


def test_a_thermostat_in_c_leaves_its_limits_at_the_same_moment(built: Built) -> None:
    """A cold start, heated as much as possible and then held, in one step: its energy tells when."""
    running = Running(HOUSE, built)
    inputs = start_values(HOUSE)
    state = HOUSE.advance(HOUSE.initial(inputs), inputs, 3600.0)
    running.step(3600.0)
    expected = HOUSE.outputs(state, inputs)
    assert expected["heater_energy_oil"] < 0.9 * 3000.0 * 3600.0
    assert running.apart(HOUSE, expected) < ROUNDING
    running.fmu.freeInstance()


def test_a_native_component_is_a_valid_fmu_without_python(built: Built) -> None:
    """Neither a script nor an interpreter is in it."""
    file = built.fmu(Brake(), "native", here=True)
    with zipfile.ZipFile(file) as archive:
        names = archive.namelist()
        assert not [name for name in names if name.startswith("resources/") or name.endswith(".py")]
        assert "sources/contact.c" in names
        assert b'needsExecutionTool="false"' in archive.read("modelDescription.xml")
    assert validate_fmu(str(file)) == []


@pytest.mark.parametrize("flavour", ["native", "isolated"])
def test_a_component_gives_the_same_by_both_versions_of_fmi(flavour: Flavour, built: Built) -> None:
    """Description, library and build description are of the model's name and of that version."""
    files = [built.fmu(Brake(), flavour, fmi=fmi, here=True) for fmi in (2, 3)]
    assert [validate_fmu(str(file)) for file in files] == [[], []]
    starts = {"torque_setpoint": 20.0, "speed": 3.0}
    two, three = (
        fmpy.simulate_fmu(str(file), stop_time=1.0, output_interval=0.1, start_values=starts) for file in files
    )
    assert two.dtype.names == three.dtype.names
    assert two.tobytes() == three.tobytes()
    assert two["power"][-1] != 0.0
    if flavour == "native":
        with zipfile.ZipFile(files[1]) as archive:
            assert b'modelIdentifier="Brake"' in archive.read("sources/buildDescription.xml")


def test_a_component_is_not_embedded_in_fmi_3(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"There is no FMU of FMI 3\.0 with flavour = 'embedded'"):
        build(Brake(), tmp_path / "brake.fmu", "embedded", fmi=3)


def test_a_state_saved_before_outputs_were_asked_for_gives_the_same_ones(built: Built) -> None:
    """An input has been set, its outputs are behind: a state keeps that."""
    running = Running(Brake(), built)
    running.set({"torque_setpoint": 20.0, "speed": 3.0})
    running.step(1.0)
    running.set({"speed": 100.0})
    state = running.fmu.getFMUstate()
    reference = [running.references["power"]]
    power = running.fmu.getReal(reference)
    running.set({"speed": 7.0})
    running.fmu.setFMUstate(state)
    assert running.fmu.getReal(reference) == power
    running.fmu.freeFMUState(state)
    running.fmu.freeInstance()
