"""The models on which a co-simulation master is tested do what their descriptions say."""

import ctypes
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from built import Built
from comparison import approx
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2Discard, fmi2Error, fmi2LastSuccessfulTime, fmi2Terminated
from fmpy.fmi3 import FMU3Slave, fmi3Error
from fmpy.validation import validate_fmu
from memory import allocated
from scipy.linalg import expm

from benchmarks.models import MODELS, build, exact
from benchmarks.models.description import Variant, describe, inlet, output

PREDEFINED = [(n, fmi) for n in sorted(set(MODELS) - {"linear"}) for fmi in (2, 3) if (n, fmi) != ("arrays", 2)]


class Running:
    """One initialised instance; variables by name."""

    def __init__(self, path: Path, folder: Path, start: dict[str, Any] | None = None, **options: Any) -> None:
        description = fmpy.read_model_description(str(path))
        unpacked = folder / path.stem
        if not unpacked.exists():
            fmpy.extract(str(path), str(unpacked))
        self.fmi = int(description.fmiVersion[0])
        self.variables = {v.name: v for v in description.modelVariables}
        self.messages: list[str] = []
        kind = FMU2Slave if self.fmi == 2 else FMU3Slave
        self.fmu = kind(
            guid=description.guid,
            unzipDirectory=str(unpacked),
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="model",
        )
        if self.fmi == 3:
            options["logMessage"] = lambda *arguments: self.messages.append(arguments[-1].decode())
        self.fmu.instantiate(**options)
        self.initialise(start or {})

    def initialise(self, start: dict[str, Any]) -> None:
        self.set(**start)
        if self.fmi == 2:
            self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()
        self.time = 0.0

    def _call(self, action: str, name: str):
        kind = self.variables[name].type
        return getattr(self.fmu, action + kind), self.variables[name].valueReference

    def set(self, **values: Any) -> None:
        for name, value in values.items():
            call, reference = self._call("set", name)
            call([reference], [value])

    def get(self, name: str) -> Any:
        call, reference = self._call("get", name)
        value = call([reference])[0]
        return value.decode() if isinstance(value, bytes) else value

    def step(self, h: float) -> Any:
        result = self.fmu.doStep(self.time, h)
        self.time += h
        return result

    def slopes(self, orders: tuple[int, ...], **values: tuple[float, ...]) -> None:
        for name, numbers in values.items():
            references = [self.variables[name].valueReference] * len(orders)
            self.fmu.setRealInputDerivatives(references, orders, numbers)

    def bytes(self) -> bytes:
        state = self._state("get")()
        data = self._state("serialize")(state)
        self._state("free")(state)
        return bytes(data)

    def restore(self, data: bytes, time: float) -> None:
        state = self._state("deSerialize" if self.fmi == 2 else "deserialize")(data)
        self._state("set")(state)
        self._state("free")(state)
        self.time = time

    def _state(self, action: str):
        odd = self.fmi == 2 and action in ("serialize", "deSerialize")
        return getattr(self.fmu, f"{action}FMU{'state' if odd else 'State'}")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("models")


@pytest.fixture
def run(built: Built, folder: Path) -> Iterator[Any]:
    """Starts instances: run(name, fmi, start, instantiate={...}, **variant)."""
    started: list[Running] = []

    def start(name: str, fmi: int = 2, start: dict[str, Any] | None = None, **more: Any) -> Running:
        options = more.pop("instantiate", {})
        started.append(Running(build(name, built.models, fmi, **more), folder, start, **options))
        return started[-1]

    yield start
    for running in started:
        running.fmu.freeInstance()


@contextmanager
def refused(status: int) -> Iterator[None]:
    with pytest.raises(FMICallException) as caught:
        yield
    assert caught.value.status == status


@pytest.mark.parametrize(("name", "fmi"), PREDEFINED)
def test_fmpy_finds_no_problem_in_a_description(name, fmi, tmp_path):
    for variant in (Variant(fmi), Variant(fmi, rollback=False, dependencies=False)):
        (tmp_path / "modelDescription.xml").write_bytes(describe(name, "token", MODELS[name](), variant))
        assert validate_fmu(str(tmp_path)) == []


def test_a_built_file_is_found_again_and_variants_are_kept_apart(folder):
    first = build("gain", folder)
    stamp = first.stat().st_mtime_ns
    assert build("gain", folder) == first and first.stat().st_mtime_ns == stamp
    assert build("gain", folder, start={"a": 2.0}) != first
    assert validate_fmu(str(first)) == []
    with pytest.raises(ValueError, match="volume"):
        build("gain", folder, start={"volume": 2.0})


@pytest.mark.parametrize("fmi", [2, 3])
def test_a_linear_system_is_exact(fmi, run):
    """Against one matrix exponential by scipy; in FMI 2 the inputs are parabolas, in FMI 3 they are held."""
    rng = np.random.default_rng(7)
    A, B, C = rng.normal(size=(4, 4)) - 2.0 * np.eye(4), rng.normal(size=(4, 2)), rng.normal(size=(3, 4))
    D = np.array([[0.0, 0.0], [1.5, 0.0], [0.5, -1.0]])
    x = rng.normal(size=4)
    names = [inlet(f"u{i}", "1") for i in range(2)] + [output(f"y{i}", "1") for i in range(3)]
    matrices = {key: value.tolist() for key, value in {"A": A, "B": B, "C": C, "D": D, "starts": x}.items()}
    model = run("linear", fmi, variables=tuple(names), **matrices)
    for h in (0.7, 0.7, 1e-4, 2.0, 0.7):
        u, du, ddu = rng.normal(size=(3, 2)) * (1.0 if fmi == 2 else np.array([[1.0], [0.0], [0.0]]))
        model.set(u0=u[0], u1=u[1])
        if fmi == 2:
            model.slopes((1, 2), u0=(du[0], ddu[0]), u1=(du[1], ddu[1]))
        model.step(h)
        enlarged = np.zeros((10, 10))
        enlarged[:4, :4], enlarged[:4, 4:6], enlarged[4:8, 6:] = A, B, np.eye(4)
        x = (expm(h * enlarged) @ np.concatenate([x, u, du, ddu]))[:4]
        end = u + h * du + 0.5 * h**2 * ddu
        assert [model.get(f"y{i}") for i in range(3)] == approx(C @ x + D @ end, rel=1e-13, abs=1e-13)
        references = [model.variables[f"y{i}"].valueReference for i in range(3)]
        call = model.fmu.getRealOutputDerivatives if fmi == 2 else model.fmu.getOutputDerivatives
        slopes = C @ (A @ x + B @ end) + D @ (du + h * ddu)
        assert call(references, [1, 1, 1]) == approx(slopes, rel=1e-12, abs=1e-12)
    model.set(u0=3.0, u1=-2.0)
    assert model.get("y2") == approx(C[2] @ x + D[2] @ [3.0, -2.0], rel=1e-12)
    knowns = [model.variables[f"u{i}"].valueReference for i in range(2)]
    assert model.fmu.getDirectionalDerivative(references, knowns, [1.0, 10.0]) == approx(D @ [1.0, 10.0])


def test_slopes_hold_for_one_step_and_only_where_the_model_interpolates(run):
    models = [run("point_mass", interpolates=flag, start={"F0": 0.0}) for flag in (True, False)]
    for model in models:
        model.set(F=1.0)
        model.slopes((1,), F=(6.0,))
        model.step(1.0)
    assert [model.get("v") for model in models] == approx([-4e3, -1e3])
    models[0].step(1.0)
    assert models[0].get("v") == approx(-4e3 - 7e3)


def test_unmoved_neighbours_see_the_forces_of_the_whole(run):
    """The parts' matrices against the whole's: starting accelerations of both couplings."""
    h, step = 1e-6, {"mass_1_displacement": ("x_other", "v_other"), "mass_2_displacement": ("x_other", "v_other")}
    whole = exact.two_mass([h])[0]
    first, spring = run("mass_1_force"), run("mass_2_spring")
    spring.set(x1=1.0)
    first.set(F=spring.get("F"))
    pairs = [(first, spring), tuple(run(name) for name in step)]
    pairs[1][1].set(x_other=1.0)
    for one, two in pairs:
        one.step(h)
        two.step(h)
        assert [one.get("v"), two.get("v")] == approx(whole[2:], rel=1e-5)


def test_the_quarter_car_comes_to_rest_on_the_road(run):
    """Gauss-Seidel with small steps against the exact solution: the couplings have the right signs."""
    t, h = 0.2, 1e-4
    wheel, chassis = run("wheel_force"), run("chassis_spring")
    other_wheel, other = run("wheel_displacement"), run("chassis_displacement")
    for _ in range(round(t / h)):
        wheel.set(F=chassis.get("F"))
        wheel.step(h)
        chassis.set(x_wheel=wheel.get("x"), v_wheel=wheel.get("v"))
        chassis.step(h)
        other_wheel.set(x_other=other.get("x"), v_other=other.get("v"))
        other_wheel.step(h)
        other.set(x_other=other_wheel.get("x"), v_other=other_wheel.get("v"))
        other.step(h)
    whole = exact.quarter_car([t])[0]
    assert [wheel.get("x"), chassis.get("x")] == approx(whole[:2], rel=5e-3)
    assert [other_wheel.get("x"), other.get("x")] == approx(whole[:2], rel=5e-3)
    assert exact.quarter_car([20.0])[0, :2] == approx([0.1, 0.1], abs=1e-8)


@pytest.mark.parametrize("fmi", [2, 3])
def test_a_restored_model_repeats_its_step_bitwise(fmi, run):
    model = run("mass_2_spring", fmi)
    model.set(x1=0.3, v1=-1.0)
    model.step(0.1)
    before, saved = model.get("F"), model.bytes()
    model.step(0.37)
    after = model.get("x"), model.get("v"), model.get("F")
    model.restore(saved, 0.1)
    assert model.get("F") == before and model.bytes() == saved
    model.step(0.37)
    assert (model.get("x"), model.get("v"), model.get("F")) == after
    fresh = run("mass_2_spring", fmi)
    fresh.restore(saved, 0.1)
    fresh.step(0.37)
    assert (fresh.get("x"), fresh.get("v"), fresh.get("F")) == after


def test_a_state_set_keeps_the_slopes_that_were_set_before_it_was_saved(run):
    model = run("point_mass", start={"F0": 0.0})
    model.slopes((1, 2), F=(2.0, 6.0))
    saved = model.bytes()
    speeds = []
    for _ in range(2):
        model.restore(saved, 0.0)
        model.step(1.0)
        speeds.append(model.get("v"))
    assert speeds[0] == speeds[1] == approx(-2e3)


@pytest.mark.parametrize("fmi", [2, 3])
def test_without_rollback_no_state_is_given(fmi, run):
    model = run("mass_1_force", fmi, rollback=False)
    with refused(fmi2Error if fmi == 2 else fmi3Error):
        model.bytes()


def test_a_model_can_be_reset_and_many_live_side_by_side(run):
    models = [run("mass_1_force") for _ in range(20)]
    for i, model in enumerate(models):
        model.set(F=float(i))
        model.step(0.5)
    ends = [model.get("x") for model in models]
    assert len(set(ends)) == 20
    models[3].fmu.reset()
    models[3].initialise({})
    assert models[3].get("x") == 1.0
    models[3].set(F=3.0)
    models[3].step(0.5)
    assert models[3].get("x") == ends[3]


def test_memory_stays_flat_over_steps_and_states(run):
    """A state has about 300 bytes: 2e4 of them would be 6 MB."""
    fmu = run("mass_1_force", start={"x0": 1.0}).fmu

    def cycles(n: int, start: int) -> None:
        for i in range(start, start + n):
            state = fmu.getFMUState()
            fmu.doStep(i * 0.125, 0.125)
            fmu.freeFMUState(state)

    cycles(2000, 0)
    before = allocated()
    cycles(20000, 2000)
    assert allocated() - before < 10_000


def test_a_parameter_set_before_initialisation_ends_counts(run):
    model = run("mass_1_force", start={"m": 4.0, "x0": -2.0, "k": 0.0, "d": 0.0})
    assert model.get("x") == -2.0
    model.set(F=8.0)
    model.step(1.0)
    assert (model.get("x"), model.get("v")) == approx((-1.0, 2.0))


@pytest.mark.parametrize("fmi", [2, 3])
def test_a_model_reports_what_its_master_does_wrong(fmi, run):
    model = run("mass_1_force", fmi)
    wrongs = [
        lambda: model.set(m=2.0),
        lambda: model.set(x=2.0),
        lambda: model.fmu.doStep(0.5, 0.1),
        lambda: model.fmu.doStep(0.0, 0.0),
    ]
    for wrong in wrongs:
        with refused(fmi2Error if fmi == 2 else fmi3Error):
            wrong()
    assert len(model.messages) == (0 if fmi == 2 else len(wrongs))


def test_the_contact_is_one_sided_and_its_derivatives_are_right(run):
    model = run("contact_point")
    model.set(x=1.0795e-6)
    assert model.get("F") == approx(300.0, rel=1e-12)
    h = 1e-12
    model.set(v=0.01)
    tangents = model.get("dF_dx"), model.get("dF_dv")
    forces = []
    for x, v in ((1.0795e-6 + h, 0.01), (1.0795e-6 - h, 0.01), (1.0795e-6, 0.02), (1.0795e-6, 0.0)):
        model.set(x=x, v=v)
        forces.append(model.get("F"))
    assert tangents == approx(((forces[0] - forces[1]) / (2 * h), (forces[2] - forces[3]) / 0.02), rel=1e-6)
    for x, v, touches in ((-1e-9, 1.0, False), (1e-9, -1.0, True)):
        model.set(x=x, v=v)
        assert (model.get("F"), model.get("dF_dx"), model.get("dF_dv")) == (0.0, 0.0, 0.0)
        assert model.get("in_contact") == touches


def test_friction_falls_with_speed_and_its_derivative_is_right(run):
    model, h = run("friction"), 1e-7
    for u in (-0.3, -0.02, 0.0, 0.004, 0.2):
        forces = []
        for at in (u + h, u - h):
            model.set(u=at)
            forces.append(model.get("F"))
        model.set(u=u)
        assert model.get("dF_du") == approx((forces[0] - forces[1]) / (2 * h), rel=1e-5, abs=1e-5)
        assert model.get("F") * u <= 0.0
    model.set(u=0.5)
    assert model.get("F") == approx(-10.0 * (0.25 + 0.15 * np.exp(-5.0)), rel=1e-12)


def test_block_and_belt_stick_and_slip(run):
    """With small steps against the reference, which shows both phases."""
    block, friction, h = run("block"), run("friction"), 1e-4
    for _ in range(8000):
        friction.set(u=block.get("u"))
        block.set(F=friction.get("F"))
        block.step(h)
    assert (block.get("x"), block.get("v")) == approx(exact.stick_slip([0.8])[0], abs=2e-3)
    v = exact.stick_slip(np.linspace(2.0, 6.0, 400))[:, 1]
    assert v.max() < 0.1 and v.min() < -0.2 and np.mean(v > 0.07) > 0.4


def test_the_stiff_contact_settles_where_force_and_load_agree():
    assert exact.stiff_contact([1e-3])[0] == approx([1.0795e-6, 0.0], rel=1e-9, abs=1e-10)


def test_echo_returns_every_type(run):
    for fmi in (2, 3):
        model = run("echo", fmi)
        values = {"real": -1.5, "integer": -7, "boolean": True, "string": "Öl, 40 °C"}
        for kind, value in values.items():
            model.set(**{f"{kind}_in": value})
        model.step(0.1)
        assert {kind: model.get(f"{kind}_out") for kind in values} == values


def test_gain_can_be_square(run):
    model = run("gain", a=0.5, b=2.0, c=3.0)
    model.set(u=2.0)
    assert model.get("y") == 15.0
    assert model.fmu.getDirectionalDerivative([4], [3], [1.0]) == [12.5]


def test_long_steps_are_refused_in_fmi_2(run):
    model = run("discard", start={"y0": 1.0})
    model.set(u=2.0)
    model.step(0.1)
    with refused(fmi2Discard):
        model.step(0.2)
    assert model.fmu.getRealStatus(fmi2LastSuccessfulTime) == 0.1
    assert not model.fmu.getBooleanStatus(fmi2Terminated)
    assert model.get("y") == approx(1.2)
    partial = run("discard", partial=True)
    partial.set(u=2.0)
    with refused(fmi2Discard):
        partial.step(0.25)
    assert partial.fmu.getRealStatus(fmi2LastSuccessfulTime) == 0.1
    assert partial.get("y") == approx(0.2)


def test_long_steps_are_refused_or_end_early_in_fmi_3(run):
    for allowed in (True, False):
        model = run("discard", 3, partial=True, instantiate={"earlyReturnAllowed": allowed})
        if allowed:
            assert model.step(0.25) == (False, False, True, 0.1)
        else:
            with refused(2):
                model.step(0.25)


def test_the_terminator_ends_the_simulation(run):
    model = run("terminator")
    model.set(u=1.0)
    model.step(0.4)
    with refused(fmi2Discard):
        model.step(0.4)
    assert model.fmu.getRealStatus(fmi2LastSuccessfulTime) == approx(0.5)
    assert model.fmu.getBooleanStatus(fmi2Terminated)
    assert model.get("y") == approx(0.5)
    for allowed, reached in ((True, 0.5), (False, 0.8)):
        model = run("terminator", 3, instantiate={"earlyReturnAllowed": allowed})
        assert model.step(0.4) == (False, False, False, 0.4)
        assert model.step(0.4) == (False, True, allowed, approx(reached))


@pytest.mark.parametrize(("fmi", "options"), [(2, {}), (3, {}), (3, {"earlyReturnAllowed": True})])
def test_without_event_mode_events_happen_inside_the_step(fmi, options, run):
    model = run("early", fmi, instantiate=options)
    model.set(u=1.0)
    model.step(0.6)
    model.step(0.4)
    assert (model.get("y"), model.get("events")) == (approx(5.0), 4)


def test_an_event_ends_the_step_and_is_handled_in_event_mode(run):
    model = run("early", 3, instantiate={"earlyReturnAllowed": True, "eventModeUsed": True})
    assert model.fmu.updateDiscreteStates()[-2:] == (True, 0.25)
    model.fmu.enterStepMode()
    model.set(u=1.0)
    assert model.step(0.6) == (True, False, True, 0.25)
    assert model.get("y") == approx(0.25)
    with refused(fmi3Error):
        model.fmu.doStep(0.25, 0.1)
    model.fmu.enterEventMode()
    assert model.fmu.updateDiscreteStates() == (False, False, False, True, True, 0.5)
    model.fmu.enterStepMode()
    assert (model.get("y"), model.get("events")) == (approx(1.25), 1)
    assert model.fmu.doStep(0.25, 0.25) == (True, False, False, 0.5)


def test_where_early_return_is_not_allowed_the_step_goes_on_to_its_end(run):
    model = run("early", 3, instantiate={"eventModeUsed": True})
    model.fmu.enterStepMode()
    model.set(u=1.0)
    assert model.step(0.6) == (False, False, False, 0.6)
    assert (model.get("y"), model.get("events")) == (approx(2.6), 2)


def test_the_ball_loses_the_same_share_of_speed_at_each_bounce(run):
    """Against the closed form: falls of sqrt(2 h0 / g), then 2 e^n of it."""
    first = np.sqrt(2.0 / 9.81)
    for fmi in (2, 3):
        model = run("bouncer", fmi)
        model.step(first * (1.0 + 2.0 * 0.7 + 0.7**2))
        assert model.get("bounces") == 2
        assert (model.get("h"), model.get("v")) == approx((0.7**4, 0.0), abs=1e-12)
        model.step(first * 10.0)
        assert (model.get("h"), model.get("v")) == (0.0, 0.0)


def test_teeth_change_at_multiples_of_the_period(run):
    model, teeth = run("tooth"), []
    for _ in range(10):
        model.step(0.05)
        teeth.append((model.get("tooth"), model.get("stiffness")))
    assert [tooth for tooth, _ in teeth] == [0, 1, 1, 2, 2, 3, 3, 4, 4, 5]
    assert {(tooth % 2, stiffness) for tooth, stiffness in teeth} == {(0, 1e8), (1, 1.5e8)}


def test_nan_and_failing_do_so_after_their_time(run):
    model = run("nan")
    model.step(0.5)
    assert model.get("y") == 0.0
    model.step(0.1)
    assert np.isnan(model.get("y"))
    model = run("failing", 3)
    model.step(0.5)
    with refused(fmi3Error):
        model.step(0.1)
    assert len(model.messages) == 1 and "fails" in model.messages[0]


def test_units_say_what_a_connection_must_convert(folder):
    description = fmpy.read_model_description(str(build("millimetre", folder)))
    units = {u.name: u.baseUnit for u in description.unitDefinitions}
    assert (units["mm"].m, units["mm"].factor, units["N"].kg) == (1, 1e-3, 1)


def test_the_mass_of_pythonfmu_moves_as_the_one_in_c(run, folder):
    assert validate_fmu(str(build("python_mass", folder))) == []
    start = {"m": 2.0, "x0": 0.5}
    python, compiled = run("python_mass", start=start), run("mass_1_force", start=start)
    for model in (python, compiled):
        model.set(F=3.0)
        model.step(0.3)
    assert python.get("x") == approx(compiled.get("x"), rel=1e-13)
    saved = python.bytes()
    python.step(0.3)
    x = python.get("x")
    python.restore(saved, 0.3)
    python.step(0.3)
    assert python.get("x") == x


def test_the_library_exports_fmi_functions_only(run):
    """Names of one model must not meet those of another in one process."""
    for name in ("create", "restore", "model_step"):
        assert not hasattr(ctypes.CDLL(run("gain").fmu.dll._name), name)
