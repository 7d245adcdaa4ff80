"""Where neither the sources' folder nor the user's cache can be written, compiled kernels are kept in a private one."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import contact_core

pytestmark = pytest.mark.skipif(os.name != "posix", reason="folders are made unusable as POSIX allows")


@pytest.fixture
def read_only(tmp_path: Path) -> Path:
    """A copy of the package in which no cache can be made, not even by root."""
    source = Path(contact_core.__file__).parent
    copy = tmp_path / "site" / source.name
    shutil.copytree(source, copy, ignore=shutil.ignore_patterns("__pycache__"))
    for folder in (copy, *(path for path in copy.rglob("*") if path.is_dir())):
        folder.joinpath("__pycache__").touch()
    return copy.parent


FOR_CHILDREN = "import os; folder = os.environ['NUMBA_CACHE_DIR']"
OF_NUMBA = "from contact_core.kernels import mixed; import numba; folder = numba.config.CACHE_DIR"


def imported(site: Path, temporary: Path, told: str = FOR_CHILDREN, **more: str) -> list[str]:
    """The folder and the notice that a process prints which finds no place but the temporary folder."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("NUMBA", "XDG", "PYTHON"))}
    environment = kept | more | {"HOME": "/dev/null", "TMPDIR": str(temporary), "PYTHONPATH": str(site)}
    code = f"from contact_core.kernels import NOTICE; {told}; print(folder, NOTICE)"
    command = [sys.executable, "-c", code]
    found = subprocess.run(command, cwd=site, env=environment, capture_output=True, text=True)
    return [found.stdout.strip(), found.stderr.strip()]


def test_the_kernels_are_kept_in_a_private_temporary_folder_which_is_said(read_only: Path, tmp_path: Path) -> None:
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    said, warned = imported(read_only, temporary, OF_NUMBA)
    (folder,) = temporary.iterdir()
    assert said.startswith(f"{folder} Neither the folder of contact_core")
    assert "Set NUMBA_CACHE_DIR to a folder that lasts" in warned
    assert folder.stat().st_mode & 0o077 == 0
    assert imported(read_only, temporary)[0].startswith(f"{folder} ")  # the same the next time


def test_a_folder_that_others_can_write_is_not_taken(read_only: Path, tmp_path: Path) -> None:
    temporary = tmp_path / "temporary"
    open_to_some = temporary / f"tribofmu-kernels-{os.getuid()}"
    open_to_some.mkdir(parents=True)
    open_to_some.chmod(0o770)  # its group is enough
    said, _ = imported(read_only, temporary)
    chosen = Path(said.partition(" ")[0])
    assert chosen.parent == temporary
    assert chosen != open_to_some
    assert not any(open_to_some.iterdir())


@pytest.mark.long
def test_a_place_that_the_user_has_chosen_stands(read_only: Path, tmp_path: Path) -> None:
    (tmp_path / "own").mkdir()
    said, warned = imported(read_only, tmp_path, NUMBA_CACHE_DIR=str(tmp_path / "own"))
    assert said == str(tmp_path / "own")
    assert warned == ""
