"""A machine as an attribute of its result is the machine again."""

from pathlib import Path

from system_models.machines.reading import ATTRIBUTE, described, from_attribute, read


def test_a_machine_is_made_again_with_its_changes_and_the_folder_of_its_files() -> None:
    machine = read("gear_fzg_c", {"mesh.stations": "5"})._replace(folder=Path("rigs"))
    again = from_attribute(described(machine)[ATTRIBUTE])
    assert again == machine._replace(folder=Path("rigs").absolute())
    assert again.table["mesh"]["stations"] == 5
