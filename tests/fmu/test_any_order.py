"""Any sequence of calls that FMI's state machine allows, with any input: no crash, no NaN, no lost state."""

import math
import os
import sys

import pytest
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import Bundle, RuleBasedStateMachine, consumes, initialize, invariant, precondition, rule

from benchmarks.hosts.native_host import ERROR, OK, WARNING, NativeHost

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the processes are looked at as Linux shows them")

WILD = st.one_of(
    st.sampled_from([0.0, -0.0, 5e-324, 1e-9, 1e9, 1.7e308, math.nan, math.inf, -math.inf, -1.0]),
    st.floats(allow_nan=True, allow_infinity=True),
)
INPUTS = {
    "load": st.one_of(st.floats(0.0, 120.0), WILD),
    "speed_1": st.one_of(st.floats(-1.0, 1.0), WILD),
    "speed_2": st.one_of(st.floats(-1.0, 1.0), WILD),
    "temperature": st.one_of(st.floats(340.0, 360.0), WILD),
    "spin": st.one_of(st.floats(-10.0, 10.0), WILD),
    "body_temperature_1": st.one_of(st.floats(340.0, 360.0), WILD),
    "body_temperature_2": st.one_of(st.floats(340.0, 360.0), WILD),
    "radius_x": st.one_of(st.floats(5e-3, 2e-2), WILD),
    "radius_y": st.one_of(st.floats(5e-3, 2e-2), WILD),
}
STEPS = st.one_of(st.sampled_from([0.0, 1e-6, 1e-3, 1.0, 60.0, 3600.0]), WILD)
GOOD = {"load": 40.0, "speed_1": 0.1, "speed_2": 0.09, "temperature": 353.15, "spin": 0.0, "fidelity": 1}
GOOD |= {"body_temperature_1": 353.15, "body_temperature_2": 353.15, "radius_x": 9e-3, "radius_y": 9e-3}
EXAMPLES = int(os.environ.get("TRIBOFMU_TEST_SEQUENCES", "40"))  # 5000 in .ci/full
PARAMETERS = st.sampled_from(["wear.bare", "boundary_friction.bare", "plasticity.hardness", "surface_1.rq"])


class Calls(RuleBasedStateMachine):
    """One instance in a C host; every rule is a call of FMI, made where FMI allows it."""

    host: NativeHost
    fmu: object
    embedded: bool  # pythonfmu's binary answers OK, whatever the slave says
    states = Bundle("states")
    steps: list[int]  # that could not and that could be computed, of all runs

    def __init__(self):
        super().__init__()
        self.instance = self.fmu.instance(0)
        assert self.instance.created.status == OK
        self.phase = "new"
        self.kept = {}
        self.slots = 0

    def teardown(self):
        for slot in self.kept:  # none twice, which ends pythonfmu's host
            self.called("freestate", slot)
        self.instance.free()

    def called(self, *words):
        answer = self.instance.ask(*words)
        assert answer.status == OK, (words, answer.log)
        return answer

    def told(self, status):
        """Status of a refused call."""
        return OK if self.embedded else status

    @initialize(started=st.sampled_from([True, True, True, False]))
    def start(self, started):
        """Most runs begin with steps."""
        if started:
            self.begin()
            self.end_initialisation()
            self.instance.set(**GOOD)
            assert self.instance.step(1.0) == OK
            assert self.instance.outputs()["valid"]

    @precondition(lambda self: self.phase == "new")
    @rule()
    def begin(self):
        self.called("setup", 0.0)
        self.called("enter")
        self.phase = "initialising"

    @precondition(lambda self: self.phase == "stepping")
    @rule(gap=st.sampled_from([-1.0, 1e-3, 1.0, math.nan, math.inf]), dt=STEPS)
    def step_from_elsewhere(self, gap, dt):
        """A step that leaves out time, or repeats it, changes nothing."""
        before = self.seen()
        rounding = 1e-6 * (abs(dt) if math.isfinite(dt) else 0.0) + 1e-12 * abs(self.instance.time)
        if not abs(gap) <= 2.0 * rounding:
            assert self.instance.ask("step", self.instance.time + gap, dt).status == self.told(ERROR)
            assert dict(self.seen()) == dict(before) | {"valid": 0}

    @precondition(lambda self: self.phase == "initialising")
    @rule()
    def end_initialisation(self):
        assert self.instance.ask("exit").status == (OK if self.instance.outputs()["valid"] else self.told(WARNING))
        self.phase = "stepping"

    @rule(name=st.sampled_from(sorted(INPUTS)), data=st.data())
    def set_input(self, name, data):
        value = data.draw(INPUTS[name])
        assert self.instance.set(**{name: value}) == [OK]
        (found,) = self.instance.get(name)
        assert found == value or math.isnan(value)

    @precondition(lambda self: self.phase != "stepping")
    @rule(name=PARAMETERS, value=WILD)
    def set_parameter(self, name, value):
        assert self.instance.set(**{name: value}) == [OK]

    @precondition(lambda self: self.phase != "stepping")
    @rule(path=st.sampled_from(["", "/nowhere/50%s", "ü", "x" * 5000]))
    def set_initial_state(self, path):
        assert self.instance.set(initial_state=path) == [OK]
        assert self.instance.get("initial_state") == [path]

    @rule(level=st.integers(-1, 2))
    def set_fidelity(self, level):
        assert self.instance.set(fidelity=1 if level == 2 else level) == [OK]

    @precondition(lambda self: self.phase == "stepping")
    @rule(dt=STEPS, good=st.booleans())
    def step(self, dt, good):
        if good:
            self.instance.set(**GOOD)
        before = self.instance.outputs()
        answer = self.instance.ask("step", self.instance.time, dt)
        after = self.instance.outputs()
        assert answer.status == (OK if after["valid"] else self.told(WARNING)), answer.log
        Calls.steps[after["valid"]] += 1
        if not after["valid"]:
            assert after == before | {"valid": 0}
        (self.instance.time,) = self.instance.get("time")

    @rule(target=states)
    def save(self):
        self.slots += 1
        self.called("save", self.slots)
        self.kept[self.slots] = (self.phase, self.seen())
        return self.slots

    @rule(state=states)
    def restore(self, state):
        self.called("restore", state)
        self.phase, expected = self.kept[state]
        assert self.seen() == expected
        if self.phase == "stepping":  # and goes on as it did before
            ends = []
            for _ in range(2):
                self.called("restore", state)
                self.instance.set(**GOOD)
                status = self.instance.step(1.0)
                assert status == (OK if self.instance.outputs()["valid"] else self.told(WARNING))
                ends.append(self.seen())
            assert ends[0] == ends[1]

    @rule(target=states, state=states)
    def copy_by_bytes(self, state):
        self.slots += 1
        file = self.folder / "state"
        self.called("serialize", state, file)
        self.called("deserialize", self.slots, file)
        self.kept[self.slots] = self.kept[state]
        return self.slots

    @rule(state=states, at=st.floats(0.0, 1.0), bit=st.integers(0, 7))
    def restore_a_damaged_copy(self, state, at, bit):
        file, before = self.folder / "damaged", self.seen()
        self.called("serialize", state, file)
        data = bytearray(file.read_bytes())
        data[min(int(at * len(data)), len(data) - 1)] ^= 1 << bit
        file.write_bytes(data)
        self.called("deserialize", 0, file)
        assert self.instance.ask("restore", 0).status == self.told(ERROR)
        self.called("freestate", 0)
        assert dict(self.seen()) == dict(before) | {"valid": 0}

    @rule(state=consumes(states))
    def forget(self, state):
        del self.kept[state]
        self.called("freestate", state)

    @precondition(lambda self: self.phase != "new")
    @rule(really=st.integers(0, 9))
    def reset(self, really):
        """One time of ten, as little can happen before the next steps."""
        if not really:
            self.called("reset")
            self.phase = "new"

    @precondition(lambda self: self.phase == "stepping")
    @rule(state=states)
    def terminate_and_restore(self, state):
        self.called("terminate")
        self.restore(state)

    @precondition(lambda self: self.phase == "stepping")
    @rule(reference=st.sampled_from([9999, 2**32 - 1]))
    def ask_for_nothing(self, reference):
        assert self.instance.ask("getr", reference).status == self.told(ERROR)

    def seen(self):
        return tuple(self.instance.outputs().items())

    @invariant()
    def no_output_is_nan(self):
        found = self.instance.outputs()
        assert all(math.isfinite(value) for value in found.values()), found


def test_any_sequence_of_calls(flavour, native_program, native_environment, quick_folder, tmp_path):
    with NativeHost(native_program, native_environment) as host:
        Calls.steps, Calls.embedded = [0, 0], flavour == "embedded"
        Calls.host, Calls.fmu, Calls.folder = host, host.load(quick_folder), tmp_path
        machine = Calls.TestCase()
        machine.settings = settings(
            max_examples=EXAMPLES // (5 if Calls.embedded else 1),
            stateful_step_count=20,
            deadline=None,
            suppress_health_check=list(HealthCheck),
        )
        machine.runTest()
    assert host.code == 0 or Calls.embedded  # a limit of pythonfmu's binary: see test_limits_of_pythonfmu.py
    assert min(Calls.steps) > (1 if Calls.embedded else 5)  # of a fifth of the sequences
