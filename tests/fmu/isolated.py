"""Isolated FMUs in a host in C: one with a faulty model, and the steps of compared runs."""

from collections.abc import Iterator
from pathlib import Path

from benchmarks.hosts.native_host import OK, Fmu, Instance, NativeHost, plain_environment

# What the load does to a faulty model.
FAULTS = {
    1001.0: ("raise ValueError('bad 50%')", "ValueError: bad 50%"),
    1002.0: ("raise SystemExit(3)", "SystemExit: 3"),
    1003.0: ("raise KeyboardInterrupt", "KeyboardInterrupt"),
    1004.0: ("raise MemoryError", "MemoryError"),
    1005.0: ("ctypes.string_at(0)", "killed by signal 11 (Segmentation fault).\nFatal Python error"),
    1006.0: ("os._exit(7)", "ended with exit status 7"),
    1007.0: ("os.kill(os.getpid(), 9)", "killed by signal 9"),
    1008.0: ("os.read(os.pipe()[0], 1)", "no answer within 3.75 s"),  # nothing will be written
    1009.0: ("ctypes.PyDLL(None).pause()", "no answer within 3.75 s"),  # does not let go of the interpreter
    1010.0: ("slave.advance = None", "TypeError: 'NoneType' object is not callable"),  # within the slave's own guard
    1011.0: ("slave.advance = interrupted", "The step was interrupted"),
}
ENDLESS = (1008.0, 1009.0)
UNSAVED = 2000.0  # the load at which a faulty model cannot be saved
SCRIPT = """
import ctypes, os
from fmu_src.runtime import slave
from contact_core import advance

def interrupted(*arguments):
    raise KeyboardInterrupt

class MixedContact(slave.ContactSlave):
    def do_step(self, time, step):
        slave.advance = advance
        load = self.values[self._references["load"]]{faults}
        return super().do_step(time, step)

    def _get_fmu_state(self):
        if self.values[self._references["load"]] == {unsaved}:
            raise MemoryError
        return super()._get_fmu_state()
"""
STEPS = [(1.0, {"load": 40.0}), (2.0, {}), (0.5, {"speed_1": 0.2, "load": 60.0})]


def running(program: Path) -> Iterator[NativeHost]:
    """A host that must end by itself without a fault after any test."""
    with NativeHost(program, plain_environment()) as host:
        yield host
    assert host.code == 0


def rows(instance: Instance) -> list[dict[str, object]]:
    """Outputs of the steps of compared runs."""
    found = []
    for dt, inputs in STEPS:
        assert instance.step(dt, **inputs) == OK
        found.append(instance.outputs())
    return found


def started(host: NativeHost, folder: Path, number: int = 0) -> Instance:
    return stepped(host.load(folder), number)


def stepped(fmu: Fmu, number: int) -> Instance:
    """An instance after its first step."""
    instance = fmu.instance(number)
    assert instance.created.status == OK, instance.log
    assert set(instance.initialise()) == {OK}
    assert instance.step(1.0, load=50.0) == OK
    return instance
