"""Operating points and the duty of a scene."""

from dataclasses import dataclass, fields

from ..errors import OperatingPointError
from ..quantities import TABLE, input_parameter, out_of_range, parameter


@dataclass(frozen=True)
class OperatingPoint:
    """The inputs of one step."""

    load: float = input_parameter("load")
    speed_1: float = input_parameter("speed_1")
    speed_2: float = input_parameter("speed_2")
    temperature: float = input_parameter("temperature")
    spin: float = input_parameter("spin", default=0.0)
    body_temperature_1: float | None = input_parameter("body_temperature_1", default=None)  # None: the oil's
    body_temperature_2: float | None = input_parameter("body_temperature_2", default=None)
    radius_x: float | None = input_parameter("radius_x", default=None)  # None: the scene's
    radius_y: float | None = input_parameter("radius_y", default=None)

    @property
    def entrainment_speed(self) -> float:
        """u_e = (u1 + u2) / 2 [m/s]."""
        return 0.5 * (self.speed_1 + self.speed_2)

    @property
    def sliding_speed(self) -> float:
        """u_s = u1 - u2 [m/s]."""
        return self.speed_1 - self.speed_2

    @property
    def slides(self) -> bool:
        """True if the bodies slide anywhere in the contact."""
        return self.speed_1 != self.speed_2 or self.spin != 0.0

    @property
    def bodies(self) -> tuple[float, float]:
        """Bulk temperatures [K]; the oil's where none are given."""
        one, two = self.body_temperature_1, self.body_temperature_2
        return self.temperature if one is None else one, self.temperature if two is None else two

    @property
    def inlet_temperature(self) -> float:
        """Temperature [K] of the oil that the bodies draw in: the mean of their own."""
        one, two = self.bodies
        return 0.5 * (one + two)

    def check(self) -> None:
        """Raise OperatingPointError with one sentence for each value that cannot be used."""
        values = vars(self)
        if all(values[name] is None or least <= values[name] <= most for name, least, most in _RANGES):
            return  # the common case, at a fraction of the cost
        sentences = list(out_of_range(self, ""))
        if sentences:
            raise OperatingPointError(" ".join(sentences))


_RANGES = tuple((f.name, f.metadata["least"], f.metadata["most"]) for f in fields(OperatingPoint))


@dataclass(frozen=True)
class Step:
    """A change of the duty at a time; what is not given keeps the value of `[operation]`."""

    time: float = parameter("s", "time of the change", least=0.0, most=1e9)
    load: float | None = input_parameter("load", default=None)
    speed_1: float | None = input_parameter("speed_1", default=None)
    speed_2: float | None = input_parameter("speed_2", default=None)
    temperature: float | None = input_parameter("temperature", default=None)
    spin: float | None = input_parameter("spin", default=None)
    body_temperature_1: float | None = input_parameter("body_temperature_1", default=None)
    body_temperature_2: float | None = input_parameter("body_temperature_2", default=None)
    radius_x: float | None = input_parameter("radius_x", default=None)
    radius_y: float | None = input_parameter("radius_y", default=None)


@dataclass(frozen=True)
class Operation:
    """The duty shipped with a scene: its point of reference, how long, and its changes if there are any."""

    load: float = parameter("N", "normal load", above=0.0, most=TABLE["load"].maximum)
    speed_1: float = input_parameter("speed_1")
    speed_2: float = input_parameter("speed_2")
    temperature: float = input_parameter("temperature")
    duration: float = parameter("s", "test time", above=0.0, most=1e9)
    interval: float = parameter("s", "communication step: time between two rows of the result", above=0.0, most=1e9)
    largest_load: float = parameter(
        "N", "largest load of the duty; 0: the load above", least=0.0, most=1e6, default=0.0
    )
    steps: tuple[Step, ...] = parameter("", "changes of the duty, in the order of time", default=())
    file: str = parameter("", "CSV of the duty, instead of steps", default="")
    spin: float = input_parameter("spin", default=0.0)
    body_temperature_1: float | None = input_parameter("body_temperature_1", default=None)
    body_temperature_2: float | None = input_parameter("body_temperature_2", default=None)
    radius_x: float | None = input_parameter("radius_x", default=None)  # None: the geometry's
    radius_y: float | None = input_parameter("radius_y", default=None)

    @property
    def point(self) -> OperatingPoint:
        """The operating point of reference."""
        return OperatingPoint(**{f.name: getattr(self, f.name) for f in fields(OperatingPoint)})
