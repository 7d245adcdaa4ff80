"""Options of accuracy act on every coupled Real, whatever its type and variability, or say on which they do not."""

import re
import zipfile
from pathlib import Path
from typing import Any

import pytest
from built import Built
from comparison import approx
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from test_master_behaviours import oscillator

from benchmarks.models import build
from system_models.master import CouplingError, System, simulate

SIGNALS = ["one:x", "one:v", "one:F", "two:x1", "two:v1", "two:F"]
SCHEMES: list[dict[str, Any]] = [
    {"algorithm": "jacobi"},
    {"algorithm": "gauss_seidel"},
    {"iterate": "quasi_newton"},
    {"tolerance": 3e-2},
]


@pytest.fixture(scope="session")
def folder(built: Built) -> Path:
    return built.models


def declared(path: Path, target: Path, discrete: set[str] = frozenset(), single: set[str] = frozenset()) -> Path:
    """The FMU with some variables declared discrete, and some, of FMI 3, of single precision."""

    def other(found: re.Match[str]) -> str:
        element, name = found[0], found[1]
        if name in discrete:
            element = element.replace('variability="continuous"', 'variability="discrete"')
        return re.sub("^<Float64", "<Float32", element) if name in single else element

    with zipfile.ZipFile(path) as source, zipfile.ZipFile(target, "w") as archive:
        for name in source.namelist():
            content = source.read(name)
            if name == "modelDescription.xml":
                text = content.decode()
                content = re.sub(r'<(?:ScalarVariable|Float64) name="(\w+)"[^>]*>', other, text).encode()
            archive.writestr(name, content)
    return target


def declared_oscillator(folder: Path, tmp_path: Path, fmi: int, discrete: set[str], single: set[str]) -> System:
    fmus = []
    for name, model in (("one", "mass_1_force"), ("two", "mass_2_spring")):
        own = [{signal[4:] for signal in chosen if signal.startswith(name)} for chosen in (discrete, single)]
        fmus.append(declared(build(model, folder, fmi=fmi), tmp_path / f"{name}.fmu", *own))
    return oscillator(*fmus)


def run(system: System, **scheme: Any) -> list[float]:
    """The courses of place and force, and the number of steps."""
    result = simulate(system, 0.4, 0.02, outputs=["one.x", "two.F"], **scheme)
    return [*result["one.x"].values, *result["two.F"].values, result.attrs["steps"]]


@pytest.mark.parametrize("fmi", [2, 3])
@given(st.sets(st.sampled_from(SIGNALS), min_size=1), st.sampled_from(SCHEMES))
@settings(max_examples=5, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_a_discrete_real_is_coupled_iterated_and_controlled_as_a_continuous_one(
    folder: Path, tmp_path: Path, fmi: int, discrete: set[str], scheme: dict[str, Any]
) -> None:
    plain = oscillator(*(build(model, folder, fmi=fmi) for model in ("mass_1_force", "mass_2_spring")))
    assert run(declared_oscillator(folder, tmp_path, fmi, discrete, set()), **scheme) == run(plain, **scheme)


@given(st.sets(st.sampled_from(SIGNALS), min_size=1), st.sampled_from(SCHEMES))
@settings(max_examples=5, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_a_real_of_single_precision_is_coupled_as_one_of_double(
    folder: Path, tmp_path: Path, single: set[str], scheme: dict[str, Any]
) -> None:
    plain = oscillator(*(build(model, folder, fmi=3) for model in ("mass_1_force", "mass_2_spring")))
    found = run(declared_oscillator(folder, tmp_path, 3, set(), single), **scheme)
    assert found[-2] == approx(run(plain, **scheme)[-2], rel=1e-4)


def test_a_tolerance_below_what_single_precision_shows_is_told(
    folder: Path, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """Rounding is no error that shorter steps lower, nor one that tells which outputs lag."""
    system = declared_oscillator(folder, tmp_path, 3, set(), {*SIGNALS})
    for tolerance, steps, told in ((1e-3, 40, 0), (1e-6, 200, 1)):
        found = simulate(system, 0.3, 1e-2, order=2, tolerance=tolerance, outputs=["one.x"])
        assert found.attrs["steps"] < steps
        assert sum("single precision" in message for message in caplog.messages) == told


def test_a_tolerance_is_kept_where_some_inputs_hold_whatever_the_order(
    folder: Path, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    mixed = declared_oscillator(folder, tmp_path, 2, {"one:F"}, set())
    found = simulate(mixed, 0.5, 1e-3, order=2, tolerance=1e-2, outputs=["one.x"])
    exact = simulate(mixed, 0.5, 1e-3, iterate="quasi_newton", order=2, outputs=["one.x"])
    assert found["one.x"].values[-1] == approx(exact["one.x"].values[-1], abs=1e-2)
    assert "order = 2 extrapolates the values of continuous Real inputs, not of the connections 'two.F' to" in (
        caplog.text
    )


def test_inputs_that_hold_get_no_derivatives_and_are_given_no_means(folder: Path, tmp_path: Path) -> None:
    held = declared_oscillator(folder, tmp_path, 2, {"one:F", "two:x1"}, set())
    result = simulate(held, 0.4, 0.02, order=1, outputs=["one.x"])
    assert result.attrs["receives_means"] == ""
    rigid = build("mass_2_spring", folder, interpolates=False)
    result = simulate(oscillator(build("mass_1_force", folder), rigid), 0.4, 0.02, order=1, outputs=["one.x"])
    assert result.attrs["receives_means"] == "two"


def echoes(folder: Path, *kinds: str, fmi: int = 2) -> System:
    fmus = dict.fromkeys("ab", build("echo", folder, fmi=fmi))
    return System(fmus, [(f"a.{kind}_out", f"b.{kind}_in") for kind in kinds])


OPTIONS = [{"tolerance": 1e-3}, {"iterate": "aitken"}, {"order": 1}]


@pytest.mark.parametrize("option", OPTIONS)
@pytest.mark.parametrize("kinds", [[], ["integer"], ["boolean", "string"]], ids=["none", "integer", "others"])
def test_an_option_that_acts_on_nothing_is_refused_by_name(
    folder: Path, kinds: list[str], option: dict[str, Any]
) -> None:
    (name,) = option
    with pytest.raises(CouplingError, match=f"^{name} = .*, of which this system has none. Leave it out."):
        simulate(echoes(folder, *kinds), 1.0, 0.1, **option)


@pytest.mark.parametrize("option", OPTIONS)
def test_what_an_option_does_not_act_on_is_named(
    folder: Path, caplog: pytest.LogCaptureFixture, option: dict[str, Any]
) -> None:
    (name,) = option
    simulate(echoes(folder, "real"), 0.2, 0.1, **option)
    assert not caplog.text
    simulate(echoes(folder, "real", "integer", "boolean"), 0.2, 0.1, **option)
    (message,) = caplog.messages
    assert message.startswith(f"{name} = ")
    assert "'a.boolean_out' to 'b.boolean_in', 'a.integer_out' to 'b.integer_in'." in message


def test_a_change_that_is_an_event_is_not_missed_by_a_tolerance(folder: Path, caplog: pytest.LogCaptureFixture) -> None:
    system = echoes(folder, "real", "integer")
    system.events = [system.port("a.integer_out")]
    simulate(system, 0.2, 0.1, tolerance=1e-3)
    assert not caplog.text


def test_a_discrete_input_of_event_mode_is_set_at_events_alone(
    folder: Path, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """What it gets is controlled by a tolerance all the same; nothing repeats a step for it."""
    echo = declared(build("echo", folder, fmi=3, events=True), tmp_path / "echo.fmu", {"real_in"})
    system = System({"b": echo, "m": build("mass_1_force", folder)}, [("m.x", "b.real_in"), ("b.real_out", "m.F")])
    result = simulate(system, 0.2, 0.02, tolerance=1e-2, outputs=["m.x", "b.real_out"])
    assert not caplog.text
    assert result["b.real_out"].values == approx(result["m.x"].values)
    assert result["m.x"].values[-1] == approx(simulate(system, 0.2, 1e-4)["m.x"].values[-1], abs=1e-2)
    simulate(system, 0.2, 0.1, iterate="aitken")
    assert "iterate = 'aitken' finds the values of Real inputs that are set in every step, not of" in caplog.text


@pytest.mark.parametrize(
    ("given_", "needs"), [({"horizon": 1.0}, "tolerance"), ({"iteration_tolerance": 1e-3}, "iterate")]
)
def test_what_belongs_to_another_option_is_refused_without_it(
    folder: Path, given_: dict[str, float], needs: str
) -> None:
    (name,) = given_
    with pytest.raises(CouplingError, match=rf"^{name} = [\d.]+( s)? is that of (a )?{needs}"):
        simulate(echoes(folder, "real"), 1.0, 0.1, **given_)
