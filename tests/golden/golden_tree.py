"""Copies of a revision and of the working tree, each with an environment that imports it in every process."""

import io
import os
import shutil
import site
import subprocess
import sys
import tarfile
import tomllib
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).parents[2]
THREADS = ("OMP", "OPENBLAS", "MKL", "NUMBA")
SCRIPT = "import sys\nfrom {module} import {function}\nsys.exit({function}())\n"

Fill = Callable[[Path], None]


def sha_of(revision: str) -> str:
    """Return the full name of a commit; end with 2 if there is none."""
    found = _git("rev-parse", "--verify", f"{revision}^{{commit}}", check=False)
    if found.returncode:
        print(f"There is no revision '{revision}'.", file=sys.stderr)
        sys.exit(2)
    return found.stdout.decode().strip()


def archived(sha: str) -> Fill:
    """Return what fills a folder with a revision."""

    def fill(folder: Path) -> None:
        with tarfile.open(fileobj=io.BytesIO(_git("archive", sha).stdout)) as archive:
            archive.extractall(folder, filter="data")

    return fill


def working() -> Fill:
    """Return what fills a folder with the working tree, but for what git ignores."""

    def fill(folder: Path) -> None:
        for name in filter(None, _git("ls-files", "-co", "--exclude-standard", "-z").stdout.decode().split("\0")):
            if (ROOT / name).is_file():
                (folder / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(ROOT / name, folder / name)

    return fill


def _git(*words: str, check: bool = True) -> subprocess.CompletedProcess:
    return subprocess.run(["git", *words], cwd=ROOT, capture_output=True, check=check)


class Tree:
    """A copy with a virtual environment, whose packages and commands are those of the copy."""

    def __init__(self, folder: Path, fill: Fill) -> None:
        self.folder, self.root = folder, folder / "tree"
        self.root.mkdir()
        fill(self.root)
        subprocess.run([sys.executable, "-m", "venv", "--without-pip", folder / "venv"], check=True)
        self.python = next((folder / "venv").glob("[bS]*/python*"))
        packages = next((folder / "venv").glob("**/site-packages"))
        project = tomllib.loads((self.root / "pyproject.toml").read_text(encoding="utf-8"))
        # packages of this environment after the copy; without their .pth files, which may lead back to the original
        paths = [*_roots(self.root, project), *site.getsitepackages()]
        (packages / "copy.pth").write_text("\n".join(map(str, paths)) + "\n", encoding="utf-8")
        for name, entry in project["project"]["scripts"].items():
            module, _, function = entry.partition(":")
            text = SCRIPT.format(module=module, function=function)
            (self.python.parent / f"{name}.py").write_text(text, encoding="utf-8")

    @property
    def environment(self) -> dict[str, str]:
        """For processes of this tree: one thread, kernels compiled anew, nothing of another installation."""
        kept = {key: value for key, value in os.environ.items() if not key.startswith(("PYTHON", "NUMBA_"))}
        return kept | {
            "PATH": os.pathsep.join([str(self.python.parent), os.environ["PATH"]]),
            "TRIBOFMU_PYTHON": str(self.python),
            "NUMBA_CACHE_DIR": str(self.folder / "kernels"),
            "GOLDEN_TREE": str(self.root),
            "MPLBACKEND": "Agg",
            **{f"{name}_NUM_THREADS": "1" for name in THREADS},
        }


def _roots(root: Path, project: dict) -> list[Path]:
    """Folders from which the packages are imported."""
    try:
        packages = project["tool"]["hatch"]["build"]["targets"]["wheel"]["packages"]
    except KeyError:
        return [root, root / "src"]
    return list(dict.fromkeys((root / package).parent for package in packages))
