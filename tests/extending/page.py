"""docs/extending.md as changes of files: its blocks are applied to a copy of the packages."""

import os
import re
import shlex
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
PACKAGES = ("contact_core", "fmu_src", "system_models")
PAGE = (ROOT / "docs" / "extending.md").read_text("utf-8")
_BLOCK = re.compile(r"(?:^`([^`\n]+)`, (new|change|at the end):\n\n)?^```(\w+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


@dataclass(frozen=True)
class Block:
    """A block of the page; `file` and `action` are empty where it is an example of use."""

    file: str
    action: str
    language: str
    text: str


def section(title: str) -> list[Block]:
    """Return the blocks under a heading; a difference without a file continues that of the block before."""
    (text,) = re.findall(rf"^## {title}\n(.*?)(?=^## |\Z)", PAGE, re.DOTALL | re.MULTILINE)
    blocks: list[Block] = []
    for file, action, language, code in _BLOCK.findall(text):
        if language == "diff" and not file:
            file, action = blocks[-1].file, blocks[-1].action
        blocks.append(Block(file, action, language, code))
    return blocks


class Tree:
    """A copy of the packages. Compiled kernels, which no extension touches, are those of the original."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        for name in PACKAGES:
            apart = "kernels" if name == "contact_core" else ""
            skipped = shutil.ignore_patterns("*.so", "*.dll", apart)
            shutil.copytree(source(name), folder / name, ignore=skipped)
        (folder / "contact_core" / "kernels").symlink_to(source("contact_core") / "kernels", target_is_directory=True)

    def follow(self, title: str, without: str = "") -> set[str]:
        """Apply a section, but not to the file `without`; return the files that were written."""
        written = set()
        for block in section(title):
            if block.file and block.file != without:
                self._apply(block)
                written.add(block.file)
        return written

    def _apply(self, block: Block) -> None:
        path = self.folder / block.file
        if block.action == "new":
            assert not path.exists(), block.file
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(block.text, "utf-8")
            return
        before = path.read_text("utf-8")
        if block.action == "at the end":
            path.write_text(before + block.text, "utf-8")
            return
        lines = [line if line.strip() else f" {line.lstrip(' ')}" for line in block.text.splitlines(keepends=True)]
        old, new = ("".join(line[1:] for line in lines if line[0] != sign) for sign in "+-")
        assert before.count(old) == 1, f"{block.file}: the page shows what is not there:\n{old}"
        path.write_text(before.replace(old, new), "utf-8")

    def changed(self) -> set[str]:
        """Return the files that differ from the original, or that it does not have."""
        found = set()
        for name in PACKAGES:
            for path in (self.folder / name).rglob("*"):
                if path.is_symlink() or path.is_dir() or "__pycache__" in path.parts:
                    continue
                relative = path.relative_to(self.folder)
                original = source(name).parent / relative
                if not original.exists() or original.read_bytes() != path.read_bytes():
                    found.add(relative.as_posix())
        return found

    def python(self, code: str, fails: bool = False) -> str:
        """Run code against the copy; return what it prints, or its error."""
        return self._run([sys.executable, "-c", code], fails)

    def command(self, line: str, fails: bool = False) -> str:
        """Run `tribofmu` against the copy."""
        program, *arguments = shlex.split(line)
        assert program == "tribofmu"
        return self._run([sys.executable, "-m", "system_models.cli.main", *arguments], fails)

    def _run(self, command: list[str], fails: bool) -> str:
        work = self.folder / "work"
        work.mkdir(exist_ok=True)
        path = os.pathsep.join(map(str, (self.folder, ROOT)))
        # what is compiled to bytes stays compiled from one run to the next
        environment = os.environ | {"PYTHONPATH": path, "OPENBLAS_NUM_THREADS": "1", "PYTHONDONTWRITEBYTECODE": ""}
        run = subprocess.run(command, cwd=work, env=environment, capture_output=True, text=True, check=False)
        assert (run.returncode != 0) == fails, run.stderr
        return run.stderr if fails else run.stdout


def source(package: str) -> Path:
    """Return the folder of an installed package."""
    module = sys.modules.get(package) or __import__(package)
    return Path(str(module.__file__)).parent


def examples(title: str, language: str) -> list[str]:
    """Return the examples of use of a section."""
    return [block.text for block in section(title) if not block.file and block.language == language]
