"""Laws and machines of other packages: found by entry points, and what cannot be used is refused by name."""

import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from contact_core import Scene, SceneError
from contact_core.entry_points import versions
from contact_core.laws import SLOTS, offered
from contact_core.laws.viscosity import Barus
from fmu_src.runtime import resources as of_contacts
from system_models.machines import registry
from system_models.parts import resources
from system_models.parts.load_arm import LoadArm

LAW = """
from dataclasses import dataclass
from contact_core.laws.viscosity import Barus
@dataclass(frozen=True)
class Mine(Barus):
    name = "mine"
class Plain:
    pass
@dataclass(frozen=True)
class Bare:
    name = "bare"
    source = ""
"""
MACHINE = """
from dataclasses import replace
from system_models.machines.registry import KINDS
MINE = replace(KINDS["ball_on_disc"], name="mine")
TAKEN = KINDS["ball_on_disc"]
"""
Package = Callable[..., None]


def forget() -> None:
    offered.of_others.cache_clear()
    registry.kinds.cache_clear()


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Package]:
    """Yield a function that installs a package: entry points by group, and the text of its module `others_work`."""
    monkeypatch.syspath_prepend(tmp_path)

    def install(group: str, entry: str, text: str, name: str = "others-work") -> None:
        (tmp_path / "others_work.py").write_text(text, "utf-8")
        info = tmp_path / f"{name.replace('-', '_')}-1.dist-info"
        info.mkdir()
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1\n", "utf-8")
        (info / "entry_points.txt").write_text(f"[{group}]\n{entry}\n", "utf-8")
        forget()

    yield install
    monkeypatch.undo()
    sys.modules.pop("others_work", None)
    forget()


@pytest.mark.parametrize("slot", SLOTS)
def test_our_own_laws_have_what_is_asked_of_those_of_others(slot: str) -> None:
    assert [offered.lacking(slot, law) for law in SLOTS[slot]] == [[] for _ in SLOTS[slot]]


def test_a_law_of_another_package_is_a_model_of_its_slot_and_survives_a_table(package: Package) -> None:
    package("tribofmu.laws.viscosity", "mine = others_work:Mine", LAW)
    scene = Scene.from_toml("mtm_zddp", {"lubricant.viscosity.model": "mine"})
    assert type(scene.lubricant.viscosity).__name__ == "Mine"
    assert isinstance(scene.lubricant.viscosity, Barus)
    assert Scene.from_dict(scene.to_dict()) == scene


@pytest.mark.parametrize(
    ("group", "entry", "said"),
    [
        ("viscosty", "mine = others_work:Mine", "no slot 'viscosty'"),
        ("viscosity", "other = others_work:Mine", "calls itself 'mine'"),
        ("viscosity", "mine = others_work:Plain", "must be a frozen dataclass"),
        ("viscosity", "bare = others_work:Bare", "has no __call__, equations, error. contact_core/laws/base.py"),
        ("viscosity", "barus = contact_core.laws.viscosity:Barus", "has the name of a law of tribofmu"),
        ("viscosity", "mine = others_work:Misspelt", "which the package others-work offers, cannot be imported"),
        ("viscosity", "mine = nowhere:Mine", "No module named 'nowhere'"),
    ],
)
def test_what_cannot_be_used_as_a_law_is_refused_by_name(package: Package, group: str, entry: str, said: str) -> None:
    package(f"tribofmu.laws.{group}", entry, LAW)
    with pytest.raises(SceneError, match=said) as refused:
        Scene.from_toml("mtm_zddp")
    assert str(refused.value).count("tribofmu.laws.") <= len(SLOTS) + 1  # said once


def test_two_packages_with_one_name_are_refused(package: Package) -> None:
    for name in ("one", "two"):
        package("tribofmu.laws.viscosity", "mine = others_work:Mine", LAW, name)
    with pytest.raises(SceneError, match="Two packages offer a 'mine'"):
        Scene.from_toml("mtm_zddp")


def test_a_machine_of_another_package_is_a_kind(package: Package) -> None:
    package("tribofmu.machines", "mine = others_work:MINE", MACHINE)
    assert [*registry.kinds()] == [*registry.KINDS, "mine"]


@pytest.mark.parametrize(
    ("entry", "said"),
    [
        ("other = others_work:MINE", "must be a Kind of that name"),
        ("mine = others_work:KINDS", "must be a Kind of that name"),
        ("ball_on_disc = others_work:TAKEN", "is one of tribofmu"),
    ],
)
def test_what_is_no_kind_of_machine_is_refused(package: Package, entry: str, said: str) -> None:
    package("tribofmu.machines", entry, MACHINE)
    with pytest.raises(SceneError, match=said):
        registry.kinds()


def test_a_component_is_made_from_packages_that_offer_machines_alone(package: Package, tmp_path: Path) -> None:
    text = "from system_models.parts.load_arm import LoadArm\nclass Arm(LoadArm):\n    pass\n"
    package("another.group", "arm = others_work:Arm", text)
    from others_work import Arm

    arm = Arm(dead_weight=3.0)
    for name, data in resources.files(arm).items():
        (tmp_path / name).write_bytes(data)
    module = (tmp_path / "slavemodule.txt").read_text("utf-8")
    with pytest.raises(SceneError, match="neither in this package nor in an installed one that offers"):
        resources.read(str(tmp_path), module)
    package("tribofmu.machines", "arm = others_work:Arm", text, "machines")
    assert resources.read(str(tmp_path), module) == replace(arm)
    assert isinstance(arm, LoadArm)


def test_an_fmu_refuses_another_version_of_the_package_of_its_law(package: Package, tmp_path: Path) -> None:
    package("tribofmu.laws.viscosity", "mine = others_work:Mine", LAW)
    scene = Scene.from_toml("mtm_zddp", {"lubricant.viscosity.model": "mine"})
    files = of_contacts.files(scene)
    for name, data in files.items():
        (tmp_path / name).write_bytes(data)
    module = files["slavemodule.txt"].decode()
    assert of_contacts.read(str(tmp_path), module) == scene
    (info,) = tmp_path.glob("*.dist-info/METADATA")
    info.write_text(info.read_text("utf-8").replace("Version: 1", "Version: 2"), "utf-8")
    of_contacts.read.cache_clear()
    with pytest.raises(SceneError, match="built with others-work 1, but 2 is installed"):
        of_contacts.read(str(tmp_path), module)


def test_a_law_in_a_part_of_a_package_is_of_that_package(package: Package) -> None:
    package("tribofmu.laws.viscosity", "mine = others_work.laws:Mine", LAW)
    assert versions({"others_work"}) == {"others-work": "1"}
    assert versions({"laws", "others"}) == {}


def test_an_fmu_with_our_laws_names_our_packages_alone() -> None:
    assert of_contacts.versions_of(Scene.from_toml("mtm_zddp")) == of_contacts.VERSIONS
