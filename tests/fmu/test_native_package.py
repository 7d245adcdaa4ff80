"""Native FMUs as `build` packs them, with a hand-made contact in place of the generated one, run by fmpy."""

import shutil
from pathlib import Path

import fmpy
import native_fmu
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave
from fmpy.validation import validate_fmu
from fmu_host import unpacked

from contact_core import Scene
from fmu_src.native import build as native_build
from fmu_src.native import files
from fmu_src.package.build import build

pytestmark = [pytest.mark.fmu, pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")]


@pytest.fixture(scope="module")
def packed(quick: Scene, tmp_path_factory: pytest.TempPathFactory) -> dict[int, Path]:
    """The FMU of each version of FMI."""
    folder = tmp_path_factory.mktemp("native")
    contact = {name: data for name, data in native_fmu.sources(2).items() if name in ("contact.c", "contact.h")}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(files, "contact", lambda scene: contact)
        patch.setattr(native_build, "default_compiler", lambda: "gcc")
        return {fmi: build(quick, folder / f"native{fmi}.fmu", "native", fmi=fmi) for fmi in (2, 3)}


def test_fmpy_finds_no_problem_and_runs_both_versions_alike(packed: dict[int, Path]) -> None:
    """The description's token, types and value references are those of the library."""
    runs = [
        fmpy.simulate_fmu(str(fmu), stop_time=5.0, output_interval=1.0, start_values={"load": 40.0, "speed_1": 0.2})
        for fmu in packed.values()
    ]
    assert [validate_fmu(str(fmu)) for fmu in packed.values()] == [[], []]
    assert runs[0].dtype.names == runs[1].dtype.names
    assert runs[0].tobytes() == runs[1].tobytes()
    assert len(runs[0]) == 6
    assert runs[0]["valid"].all()


def test_every_start_value_may_be_set_and_no_other_value_of_a_parameter(packed: dict[int, Path]) -> None:
    for fmu in packed.values():
        listed = fmpy.read_model_description(str(fmu)).modelVariables
        own = {v.name: v.start for v in listed if v.start is not None}
        assert len(own) > 50
        assert len(fmpy.simulate_fmu(str(fmu), stop_time=1.0, output_interval=1.0, start_values=own)) == 2
        with pytest.raises(FMICallException, match="error"):
            fmpy.simulate_fmu(str(fmu), stop_time=1.0, start_values={"boundary_friction.bare": 0.2})


def started(fmu: Path, folder: Path) -> FMU2Slave | FMU3Slave:
    """An instance after its initialisation."""
    description = fmpy.read_model_description(str(fmu))
    two = description.fmiVersion.startswith("2")
    instance = (FMU2Slave if two else FMU3Slave)(
        guid=description.guid,
        unzipDirectory=str(unpacked(fmu, folder)),
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName="one",
    )
    instance.instantiate()
    if two:
        instance.setupExperiment(startTime=0.0)
        instance.enterInitializationMode()
    else:
        instance.enterInitializationMode(startTime=0.0)
    instance.exitInitializationMode()
    return instance


def test_a_state_stored_by_one_version_is_restored_by_the_other(packed: dict[int, Path], tmp_path: Path) -> None:
    two, three = (started(packed[fmi], tmp_path / str(fmi)) for fmi in (2, 3))
    reals = [k for k, v in enumerate(native_fmu.table()) if (v.kind, v.causality) == ("Real", "output")]
    two.doStep(0.0, 60.0)
    three.doStep(0.0, 7.0)
    data = two.serializeFMUstate(two.getFMUstate())
    three.setFMUState(three.deserializeFMUState(data))
    assert three.serializeFMUState(three.getFMUState()) == data
    for instance in (two, three):
        instance.doStep(60.0, 5.0)
    assert two.getReal(reals) == three.getFloat64(reals)
    assert any(two.getReal(reals))
    for instance in (two, three):
        instance.freeInstance()


@pytest.mark.skipif(shutil.which("cmake") is None, reason="needs cmake")
@pytest.mark.parametrize("fmi", [pytest.param(2, marks=pytest.mark.long), 3])
def test_fmpy_compiles_the_sources_to_a_library_with_the_same_bits(
    fmi: int, packed: dict[int, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from fmpy.build import build_platform_binary

    monkeypatch.setenv("CFLAGS", "-ffp-contract=off")
    folder, scratch = unpacked(packed[fmi], tmp_path / "fmu"), tmp_path / "scratch"
    shutil.rmtree(folder / "binaries")
    scratch.mkdir()
    build_platform_binary(folder, build_dir=scratch)
    times = {"stop_time": 5.0, "output_interval": 1.0}
    compiled, shipped = (fmpy.simulate_fmu(str(place), **times) for place in (folder, packed[fmi]))
    assert compiled.tobytes() == shipped.tobytes()
