"""A native FMU by FMI 3.0: early return, intermediate update, adjoint derivatives, what it does without."""

import re
import shutil
from collections.abc import Callable, Iterator
from ctypes import byref, c_size_t
from pathlib import Path

import fmpy
import native_fmu
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import FMU3Slave, fmi3Float64, fmi3ValueReference

from fmu_src.isolated.library import image
from fmu_src.native import build
from tests.comparison import approx

pytestmark = [pytest.mark.fmu, pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")]

ERROR = 3
AT = {v.name: reference for reference, v in enumerate(native_fmu.table())}
INPUTS = [AT[v.name] for v in native_fmu.table() if v.causality == "input"]
Update = Callable[..., None]


@pytest.fixture(scope="module")
def native3_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return native_fmu.unpacked(tmp_path_factory.mktemp("native3"), 3)


class Host3:
    """An instance, its log, and what the intermediate update saw."""

    def __init__(self, folder: Path):
        self.fmu = FMU3Slave(guid=native_fmu.TOKEN, unzipDirectory=str(folder), modelIdentifier=native_fmu.MODEL)
        self.log: list[tuple[int, str, str]] = []
        self.seen: list[tuple[float, ...]] = []
        self.return_at: float | None = None  # share of the step of 1 s

    def instantiate(self, early: bool = True, update: bool = True, logging: bool = True, **options: bool) -> None:
        self.fmu.instantiate(
            logMessage=self._logged,
            loggingOn=logging,
            earlyReturnAllowed=early,
            intermediateUpdate=self._update if update else None,
            **options,
        )

    def _logged(self, _: object, status: int, category: bytes, message: bytes) -> None:
        self.log.append((status, category.decode(), message.decode()))

    def _update(self, _: object, time: float, *rest: object) -> None:
        *flags, requested, when = rest
        self.seen.append((time, *flags, self.get("time")))
        if self.return_at is not None:
            requested[0], when[0] = True, self.return_at

    def initialise(self) -> None:
        self.fmu.enterInitializationMode(startTime=0.0)
        self.fmu.exitInitializationMode()

    def get(self, name: str) -> float:
        return self.fmu.getFloat64([AT[name]])[0]

    def outputs(self) -> list[float]:
        return self.fmu.getFloat64(
            [AT[v.name] for v in native_fmu.table() if (v.kind, v.causality) == ("Real", "output")]
        )


@pytest.fixture
def loaded(native3_folder: Path) -> Iterator[Host3]:
    host = Host3(native3_folder)
    yield host
    if host.fmu.component:
        host.fmu.freeInstance()


@pytest.fixture
def ready(loaded: Host3) -> Host3:
    loaded.instantiate()
    loaded.initialise()
    return loaded


def refused(call: Callable[..., object], *arguments: object) -> bool:
    with pytest.raises(FMICallException) as caught:
        call(*arguments)
    return caught.value.status == ERROR


def test_exactly_the_functions_of_fmi_are_exported(native3_folder: Path) -> None:
    (library,) = (native3_folder / "binaries" / "x86_64-linux").iterdir()
    header = (build.headers() / "fmi3Functions.h").read_text()
    declared = set(re.findall(r"FMI3_Export\s+\w+\s+(fmi3\w+);", header))
    assert len(declared) > 70
    assert set(image.read(library.read_bytes()).exports) == declared


def test_the_host_is_asked_before_a_step_and_informed_after_it(ready: Host3) -> None:
    assert ready.fmu.doStep(0.0, 1.0) == (False, False, False, 1.0)
    set_requested, get_allowed = False, True
    assert ready.seen == [
        (0.0, set_requested, get_allowed, False, True, 0.0),
        (1.0, set_requested, get_allowed, True, False, 1.0),
    ]


def test_a_step_ends_where_the_host_wants_to_return(ready: Host3, native3_folder: Path) -> None:
    ready.return_at = 0.25
    assert ready.fmu.doStep(0.0, 1.0) == (False, False, True, 0.25)
    assert ready.get("time") == 0.25
    other = Host3(native3_folder)
    other.instantiate()
    other.initialise()
    other.fmu.doStep(0.0, 0.25)
    assert other.outputs() == ready.outputs()
    other.fmu.freeInstance()
    ready.return_at = 0.25  # not after the step began: it does nothing
    kept = ready.outputs()
    assert ready.fmu.doStep(0.25, 1.0) == (False, False, True, 0.25)
    assert ready.outputs() == kept
    ready.return_at = 9.0  # after its end
    assert ready.fmu.doStep(0.25, 1.0) == (False, False, False, 1.25)


@pytest.mark.parametrize(("early", "update"), [(False, True), (True, False)])
def test_without_permission_or_callback_a_step_is_whole(loaded: Host3, early: bool, update: bool) -> None:
    loaded.instantiate(early, update)
    loaded.initialise()
    loaded.return_at = 0.5
    assert loaded.fmu.doStep(0.0, 1.0) == (False, False, False, 1.0)
    assert [time for time, *_ in loaded.seen] == ([1.0] if update else [])


def test_time_advances_over_a_step_that_cannot_be_computed(ready: Host3) -> None:
    ready.fmu.setFloat64([AT["load"]], [-1.0])
    ready.fmu.doStep(0.0, 1.0)  # fmpy raises nothing for a warning
    assert ready.log == [(1, "logValidity", "load = -1 N (normal load) must be at least 0 and at most 100000 N.")]
    assert (ready.get("time"), ready.fmu.getBoolean([AT["valid"]])) == (1.0, [False])


def test_messages_name_the_functions_of_fmi_3_and_are_no_formats(loaded: Host3) -> None:
    loaded.instantiate()
    assert refused(loaded.fmu.setString, [AT["initial_state"]], ["100%"])
    loaded.initialise()
    assert refused(loaded.fmu.enterInitializationMode)
    assert [text for _, _, text in loaded.log] == [
        "initial_state = '100%' is not possible: it is built into this FMU as the empty text. Build the FMU anew with "
        "the value, or build another flavour, whose parameters can be set.",
        "fmi3EnterInitializationMode is not allowed after initialisation. Nothing was done.",
    ]


def test_the_host_chooses_what_is_logged(loaded: Host3) -> None:
    def heard() -> list[str]:
        """Categories of a flag that appears, a step that is refused and a wrong call."""
        loaded.log.clear()
        for load in (50.0, 2000.0, -1.0):
            loaded.fmu.setFloat64([AT["load"]], [load])
            loaded.fmu.doStep(loaded.get("time"), 1.0)
        assert refused(loaded.fmu.enterInitializationMode)
        return [category for _, category, _ in loaded.log]

    loaded.instantiate(logging=False)
    loaded.initialise()
    assert heard() == ["logValidity", "logStatusError"]  # warnings and errors
    loaded.fmu.setDebugLogging(True, [])
    assert heard() == ["logSolver", "logValidity", "logValidity", "logStatusError"]
    loaded.fmu.setDebugLogging(True, ["logSolver", "unknown"])
    assert heard() == ["logSolver", "logStatusError"]
    loaded.fmu.setDebugLogging(True, ["logAll"])
    assert heard() == ["logSolver", "logValidity", "logValidity", "logStatusError"]
    loaded.fmu.setDebugLogging(False, [])
    assert heard() == ["logStatusError"]


def test_a_start_time_that_is_no_number_is_an_error(loaded: Host3) -> None:
    loaded.instantiate()
    assert refused(loaded.fmu.enterInitializationMode, None, float("nan"))
    loaded.initialise()


def test_configuration_mode_has_nothing_to_configure_and_permits_nothing_else(loaded: Host3) -> None:
    loaded.instantiate()
    component = loaded.fmu.component
    loaded.fmu.fmi3EnterConfigurationMode(component)
    assert refused(loaded.fmu.setFloat64, [AT["load"]], [1.0])
    assert refused(loaded.fmu.enterInitializationMode)
    loaded.fmu.fmi3ExitConfigurationMode(component)
    loaded.initialise()
    assert refused(loaded.fmu.fmi3EnterConfigurationMode, component)


def test_outputs_depend_on_inputs_in_initialisation_mode_only(loaded: Host3) -> None:
    loaded.instantiate()
    count = c_size_t()
    loaded.fmu.enterInitializationMode()
    loaded.fmu.fmi3GetNumberOfVariableDependencies(loaded.fmu.component, AT["h_c"], byref(count))
    assert count.value == len(INPUTS)
    elements, kinds = (c_size_t * count.value)(*[9] * count.value), (fmpy.fmi3.fmi3DependencyKind * count.value)()
    known = (fmi3ValueReference * count.value)()
    arguments = (loaded.fmu.component, AT["h_c"], elements, known, elements, kinds)
    loaded.fmu.fmi3GetVariableDependencies(*arguments, count)
    assert (list(known), set(elements)) == (INPUTS, {0})
    assert refused(loaded.fmu.fmi3GetVariableDependencies, *arguments, c_size_t(count.value + 1))
    loaded.fmu.exitInitializationMode()
    loaded.fmu.fmi3GetNumberOfVariableDependencies(loaded.fmu.component, AT["h_c"], byref(count))
    assert count.value == 0


def test_adjoint_derivatives_are_the_transposed_directional_ones(ready: Host3) -> None:
    ready.fmu.doStep(0.0, 1.0)
    unknowns, knowns = [AT["friction_force"], AT["h_c"]], [AT["load"], AT["speed_1"], AT["radius_x"]]
    seed = (fmi3Float64 * 2)(2.0, -3.0)
    found = (fmi3Float64 * 3)()
    ready.fmu.fmi3GetAdjointDerivative(
        ready.fmu.component,
        (fmi3ValueReference * 2)(*unknowns),
        2,
        (fmi3ValueReference * 3)(*knowns),
        3,
        seed,
        2,
        found,
        3,
    )
    for known, value in zip(knowns, found, strict=True):
        friction, film = ready.fmu.getDirectionalDerivative(unknowns, [known], [1.0])
        assert value == approx(2.0 * friction - 3.0 * film)


def test_other_counts_of_values_and_other_kinds_are_refused(ready: Host3) -> None:
    assert refused(ready.fmu.getFloat64, [AT["load"]], 2)
    assert refused(ready.fmu.getFloat32, [AT["load"]])
    assert refused(ready.fmu.getInt32, [AT["load"]])
    assert refused(ready.fmu.enterEventMode)
    assert ready.fmu.getUInt8([]) == []


@pytest.mark.parametrize("wrong", ["token", "events"])
def test_another_token_or_event_mode_gives_no_instance(loaded: Host3, wrong: str) -> None:
    loaded.fmu.guid = "other" if wrong == "token" else loaded.fmu.guid
    with pytest.raises(Exception, match="Failed to instantiate"):
        loaded.instantiate(eventModeUsed=wrong == "events")
    assert [(status, category) for status, category, _ in loaded.log] == [(ERROR, "logStatusError")]


def test_fmpy_simulates_both_versions_with_equal_bits(tmp_path: Path) -> None:
    names = [v.name for v in native_fmu.table() if v.causality == "output"]
    first, second = (
        fmpy.simulate_fmu(
            str(native_fmu.packed(tmp_path, fmi)),
            stop_time=1.0,
            output_interval=0.1,
            start_values={"load": 80.0},
            output=names,
        )
        for fmi in (2, 3)
    )
    assert len(first) == 11
    assert first.tolist() == second.tolist()


@pytest.mark.parametrize("fmi", [2, 3])
def test_fmpy_finds_no_mistake_in_the_fmu(fmi: build.Fmi, tmp_path: Path) -> None:
    assert fmpy.validation.validate_fmu(str(native_fmu.packed(tmp_path, fmi))) == []
