"""docs/extending.md as changes of files: its blocks are applied to a copy of the packages."""

import json
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
# runs code that it is sent, each in a copy of itself as it is by then, so that nothing is imported twice
_FORKS = """
import json, os, sys, traceback

def run(code):
    try:
        exec(compile(code, "page", "exec"), {"__name__": "page"})
        return 0
    except SystemExit as end:
        return int(end.code or 0)
    except BaseException:
        traceback.print_exc()
        return 1
    finally:
        sys.stdout.flush()
        sys.stderr.flush()

answers = os.fdopen(os.dup(1), "w")
commands = os.fdopen(os.dup(0))
os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
for line in commands:
    code, fork = json.loads(line)
    for place, name in enumerate(("out.txt", "err.txt"), 1):
        file = os.open(name, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        os.dup2(file, place)
        os.close(file)
    if not fork:
        status = run(code)
    elif child := os.fork():
        status = os.waitpid(child, 0)[1]
    else:
        os._exit(run(code))
    print(status, file=answers, flush=True)
"""
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
        self._process: subprocess.Popen[str] | None = None
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

    def warmed(self, code: str) -> "Tree":
        """Let each run begin where this code ends."""
        self._ask(code, fork=False, fails=False)
        return self

    def python(self, code: str, fails: bool = False) -> str:
        """Run code against the copy; return what it prints, or its error."""
        return self._ask(code, fork=True, fails=fails)

    def command(self, line: str, fails: bool = False) -> str:
        """Run `tribofmu` against the copy."""
        program, *arguments = shlex.split(line)
        assert program == "tribofmu"
        code = f"import sys; from system_models.cli.main import main; sys.exit(main({arguments!r}))"
        return self.python(code, fails)

    def close(self) -> None:
        """End the process that runs code."""
        if self._process:
            self._process.communicate()

    def _ask(self, code: str, fork: bool, fails: bool) -> str:
        work = self.folder / "work"
        work.mkdir(exist_ok=True)
        if not self._process:
            path = os.pathsep.join(map(str, (self.folder, ROOT)))
            # what is compiled to bytes stays compiled from one run to the next
            environment = os.environ | {"PYTHONPATH": path, "OPENBLAS_NUM_THREADS": "1", "PYTHONDONTWRITEBYTECODE": ""}
            pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
            self._process = subprocess.Popen([sys.executable, "-c", _FORKS], cwd=work, env=environment, **pipes)
        assert self._process.stdin and self._process.stdout
        print(json.dumps([code, fork]), file=self._process.stdin, flush=True)
        status = json.loads(self._process.stdout.readline())
        out, err = ((work / f"{name}.txt").read_text("utf-8") for name in ("out", "err"))
        assert (status != 0) == fails, err
        return err if fails else out


def source(package: str) -> Path:
    """Return the folder of an installed package."""
    module = sys.modules.get(package) or __import__(package)
    return Path(str(module.__file__)).parent


def examples(title: str, language: str) -> list[str]:
    """Return the examples of use of a section."""
    return [block.text for block in section(title) if not block.file and block.language == language]
