"""contact.c of a scene, compiled and called beside Python's `advance`."""

import ctypes
import hashlib
import random
import re
import subprocess
from pathlib import Path

from contact_core import ContactError, OperatingPoint, Outputs, Scene, advance, initial_state
from fmu_src.native import files, program
from fmu_src.native.build import FOLDER

FLAGS = ("-std=c99", "-ffp-contract=off", "-fno-math-errno", "-fPIC", "-shared")
STEPS = (0.0, 1e-3, 1.0, 60.0, 1800.0)  # s
LONG = 1.0  # s: where bodies warm up, Python takes many parts of a longer step
_TEXT = 512
_DIFFERENCES = ("friction_fluid", "error_friction", "suggested_step", "spin_torque")


class NativeContact:
    """The functions of contact.h, with their structs as Python dictionaries."""

    def __init__(self, scene: Scene, folder: Path, *compiler: str) -> None:
        """Write the sources of a scene into a folder and compile them, by gcc -O1 unless another command is given."""
        self.sources = {name: text.decode() for name, text in files.contact(scene).items()}
        for name, text in self.sources.items():
            (folder / name).write_text(text, encoding="utf-8")
        library = folder / "contact.so"
        units = [str(folder / name) for name in self.sources if name.endswith(".c")]
        command = [
            *(compiler or ("gcc", "-O1")),
            *FLAGS,
            f"-I{FOLDER}",
            f"-I{folder}",
            *units,
            "-o",
            str(library),
            "-lm",
        ]
        subprocess.run(command, check=True, capture_output=True, text=True)
        self._library = ctypes.CDLL(str(library))
        structs = re.findall(r"typedef struct \{(.*?)\} contact_(\w+);", self.sources["contact.h"], re.DOTALL)
        found = {name: re.findall(r"double (\w+)(?:\[(\d+)\])?;", body) for body, name in structs}
        self.names = {name: [member for member, _ in members] for name, members in found.items()}
        self.inputs, self.state, self.outputs = (
            (ctypes.c_double * sum(int(size or 1) for _, size in found[name]))()
            for name in ("inputs", "state", "outputs")
        )
        self._message = ctypes.create_string_buffer(_TEXT)

    def initialise(self, inputs: dict[str, float]) -> str:
        """Return why fresh surfaces were refused, or an empty text."""
        return self._called("initialise", inputs, self.state, self.outputs)

    def step(self, inputs: dict[str, float], dt: float) -> str:
        """Return why a step was refused, or an empty text."""
        return self._called("step", inputs, ctypes.c_double(dt), self.state, self.outputs)

    def derivatives(self, inputs: dict[str, float]) -> str:
        """Return why derivatives were refused, or an empty text."""
        return self._called("derivatives", inputs, self.state, self.outputs)

    def _called(self, name: str, inputs: dict[str, float], *operands: object) -> str:
        self.inputs[:] = [inputs[each] for each in self.names["inputs"]]
        refused = getattr(self._library, f"contact_{name}")(self.inputs, *operands, self._message)
        said = self._message.value.decode()
        assert bool(refused) == bool(said)
        return said

    @property
    def found(self) -> dict[str, float]:
        """The outputs by name."""
        return dict(zip(self.names["outputs"], self.outputs, strict=True))


def duty(scene: Scene, rng: random.Random) -> tuple[dict[str, float], float]:
    """Return random inputs of a scene about its operating point, and a step [s]."""
    op, geometry = scene.operation, scene.geometry
    speed = (op.speed_1 or op.speed_2) * 10.0 ** rng.uniform(-1.5, 0.6)
    given = {
        "load": 0.0 if rng.random() < 0.05 else op.load * 10.0 ** rng.uniform(-1.0, 0.25),
        "speed_1": speed,
        "speed_2": speed * rng.choice((1.0, 0.99, 0.5, 0.0, -0.2, 1.3)),
        "temperature": op.temperature + (0.0 if scene.tribofilm.refusal(0.0) else rng.uniform(-30.0, 30.0)),
        "spin": 0.0 if rng.random() < 0.7 else op.spin or 20.0,
        "body_temperature_1": op.temperature + (0.0 if scene.tribofilm.refusal(0.0) else rng.uniform(-20.0, 20.0)),
        "body_temperature_2": op.temperature,
        "radius_x": geometry.radius_x * (rng.uniform(0.7, 1.3) if "radius_y" in geometry.lacks else 1.0),
        "radius_y": getattr(geometry, "radius_y", 0.0),
    }
    dt = rng.choice(STEPS)
    if scene.heat.bulk.stores_heat:
        dt = min(dt, LONG)
    return {name: given[name] for name in given if name not in geometry.lacks}, dt


def differences(scene: Scene, contact: NativeContact, runs: int, steps: int, seed: int = 1) -> dict[str, float]:
    """Return the largest relative difference to Python of each output, over steps of random size and inputs.

    Both must refuse the same steps. Derivatives are those of the state after a step: in Python, outputs of a step of 0.
    """
    rng, worst = random.Random(seed), dict.fromkeys(contact.names["outputs"], 0.0)
    for _ in range(runs):
        state = initial_state(scene)
        for count in range(steps):
            inputs, dt = duty(scene, rng)
            said = contact.step(inputs, dt) if count else contact.initialise(inputs)
            point = OperatingPoint(**inputs)
            try:
                state, outputs = advance(scene, point, state, dt if count else 0.0)
            except ContactError as error:
                assert said, f"{inputs}, {dt} s: Python alone refused: {error}"
                if count == 0:
                    break
                continue
            assert not said, f"{inputs}, {dt} s: C alone refused: {said}"
            assert not contact.derivatives(inputs)
            _, after = advance(scene, point, state, 0.0)
            for name, value in contact.found.items():
                expected = float(getattr(after if name in program.SLOPES else outputs, name))
                scale = max(abs(expected), _scale(name, inputs, outputs), 1e-300)
                wrong = 0.0 if value == expected else abs(value - expected) / scale
                worst[name] = wrong if not wrong <= worst[name] else worst[name]
    return worst


def tolerance(name: str) -> float:
    """Return the relative difference that rounding may make of an output.

    Some outputs are differences of nearly equal numbers, or follow from them.
    """
    if name in program.SLOPES:
        return 1e-2
    return 1e-6 if name in _DIFFERENCES else 1e-9


def _scale(name: str, inputs: dict[str, float], outputs: Outputs) -> float:
    """Return the size of what an output is a small difference of: for a derivative, friction over the input."""
    if name.startswith("tribofilm_removed"):
        return float(getattr(outputs, name.replace("removed", "grown")))
    if name not in program.SLOPES:
        return 0.0
    friction = outputs.friction_force
    if "speed" in name:
        sliding = abs(inputs["speed_1"] - inputs["speed_2"])
        return abs(friction) / max(min(abs(inputs["speed_1"]), sliding), 1e-6)
    return abs(friction) / (inputs["temperature"] if name.endswith("temperature") else max(inputs["load"], 1e-3))


def bits(contact: NativeContact, scene: Scene, steps: int, seed: int = 1) -> str:
    """Return a digest of the outputs of random steps."""
    rng, found = random.Random(seed), hashlib.sha256()
    inputs, _ = duty(scene, rng)
    contact.initialise(inputs)
    for _ in range(steps):
        inputs, dt = duty(scene, rng)
        contact.step(inputs, dt)
        contact.derivatives(inputs)
        found.update(bytes(contact.outputs))
    return found.hexdigest()
