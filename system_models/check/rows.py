"""Outputs of runs, side by side. Every comparison is of bits."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from ctypes import c_void_p

from .instance import Fmu, Instance, Row
from .variables import is_real

STEPS = 3


def rows_of(fmu: Fmu, instance: Instance, first: int = 0) -> list[Row]:
    """Return outputs after initialisation and after each of a few steps; inputs move on from number `first`."""
    rows = [instance.row()]
    for number in range(first, first + STEPS):
        instance.step(inputs=fmu.stimulus(number))
        rows.append(instance.row())
    return rows


def rows_alone(fmu: Fmu, first: int = 0) -> list[Row]:
    """Return the same of a new instance, which is freed."""
    with fmu.started() as instance:
        return rows_of(fmu, instance, first)


def reals_of(fmu: Fmu, instance: Instance) -> Row:
    """Return the Real outputs alone: others may show what is wrong."""
    row = instance.row()
    return {v.name: row[v.name] for v in fmu.outputs if is_real(v)}


def difference(rows: list[Row], expected: list[Row]) -> str:
    """Return the first output that differs, with both values, or nothing."""
    for number, (row, wanted) in enumerate(zip(rows, expected, strict=True)):
        for name in wanted:
            if row[name] != wanted[name]:
                return f"{name} is {_shown(row[name])} instead of {_shown(wanted[name])} after {number} step(s)"
    return ""


def _shown(text: str) -> str:
    try:
        return repr(float.fromhex(text))
    except ValueError:
        return text


@contextmanager
def again(fmu: Fmu, steps: int = 0) -> Iterator[Callable[[], Instance]]:
    """Yield a function that returns an instance at its start values: set back, or reset where it cannot be.

    It has made so many steps. After a fatal status it is a new one.
    """
    with ExitStack() as lives:

        def begun() -> tuple[Instance, tuple[c_void_p, float] | None]:
            instance = lives.enter_context(fmu.started())
            for _ in range(steps):
                instance.step()
            return instance, instance.save() if fmu.capabilities.canGetAndSetFMUstate else None

        instance, saved = begun()

        def get() -> Instance:
            nonlocal instance, saved
            if instance.fatal:
                instance, saved = begun()
            elif saved is not None:
                instance.restore(saved)
            else:
                instance.reset()
                instance.initialise()
                for _ in range(steps):
                    instance.step()
            return instance

        yield get
        if saved is not None and not instance.fatal:
            instance.forget(saved)
