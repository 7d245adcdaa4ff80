"""Faults put into a copy of the code, one at a time or all at once, to see whether the tests notice them.

    python -m benchmarks.house.faults [PART_OF_A_NAME ...]    each fault by itself
    python -m benchmarks.house.faults --at-once               all in one copy
    python -m benchmarks.house.faults --list

Faults are data: benchmarks/house/faults/*.toml. Each names a file, the text `old` that is replaced by `new` (or a list of such
`changes`), and the `tests` of which every one must fail with it and pass without; or says in `harmless` why none can.
The copy lies in a temporary folder with a virtual environment of its own, so that every process started by a test, an
FMU's worker too, imports the copy. What was found is kept in results/faults.json until the fault, its file or one of its
tests changes, so a run can be stopped and taken up again. docs/measured/house.md says what is known.
The exit code is 1 if a fault was not noticed, 2 if the list does not fit the code or a test fails without a fault.
"""

import argparse
import concurrent.futures
import functools
import hashlib
import json
import os
import queue
import shutil
import signal
import site
import subprocess
import sys
import tempfile
import tomllib
from dataclasses import dataclass
from pathlib import Path

from benchmarks.folders import RESULTS, ROOT
from benchmarks.pages import save

LISTS = Path(__file__).with_suffix("")
FOUND = RESULTS / "faults.json"
LONGEST = 1800.0  # s for the tests of one fault, each more than enough
LIBRARY = Path("fmu_src", "isolated", "library")
NOTICED, SURVIVES, UNKNOWN = "noticed", "survives", "not tried"


@dataclass(frozen=True)
class Fault:
    """A change of the code that makes it wrong, and the tests that must fail with it."""

    group: str
    name: str
    changes: tuple[tuple[str, str, str], ...]  # file, old, new
    tests: tuple[str, ...]
    harmless: str
    unnoticed: bool  # by any test, when a review put it in

    @property
    def files(self) -> list[str]:
        return sorted({file for file, _, _ in self.changes})

    @property
    def key(self) -> str:
        """Fingerprint of everything that makes a new run necessary."""
        parts = [repr((self.changes, self.tests))]
        files = [*self.files, *sorted({test.partition("::")[0] for test in self.tests})]
        parts += [(ROOT / file).read_text(encoding="utf-8") for file in files]
        return hashlib.sha256("\0".join(parts).encode()).hexdigest()


def listed() -> list[Fault]:
    """Return all faults."""
    rows = [
        (path, row) for path in sorted(LISTS.glob("*.toml")) for row in tomllib.loads(path.read_text("utf-8"))["fault"]
    ]
    return [
        Fault(
            path.stem,
            row["name"],
            tuple((part["file"], part["old"], part["new"]) for part in row.get("changes", [row])),
            tuple(row.get("tests", ())),
            row.get("harmless", ""),
            row.get("unnoticed", False),
        )
        for path, row in rows
    ]


def misfits(faults: list[Fault]) -> list[str]:
    """Return what is wrong with a list of faults: each line of code is there once, and each test is there."""
    names = [fault.name for fault in faults]
    wrong = [f"{name}: twice" for name in sorted({name for name in names if names.count(name) > 1})]
    text = functools.cache(lambda file: (ROOT / file).read_text("utf-8") if (ROOT / file).exists() else "")
    for fault in faults:
        if bool(fault.tests) == bool(fault.harmless):
            wrong.append(f"{fault.name}: needs either tests or a reason why it is harmless")
        for file, old, new in fault.changes:
            if text(file).count(old) != 1 or old == new:
                count = text(file).count(old)
                wrong.append(f"{fault.name}: its text occurs {count} times in {file}, or nothing changes")
        for test in fault.tests:
            path, _, function = test.partition("::")
            if (f"def {function.partition('[')[0]}(" not in text(path) and function) or not text(path):
                wrong.append(f"{fault.name}: there is no test {test}")
    return wrong


class Copy:
    """A copy of the working tree, with an environment that imports it in every process."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.tree = folder, folder / "tree"
        kept = subprocess.run(
            ["git", "ls-files", "-co", "--exclude-standard", "-z"], cwd=ROOT, check=True, capture_output=True, text=True
        ).stdout
        for name in filter(None, kept.split("\0")):
            if (ROOT / name).is_file():
                (self.tree / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(ROOT / name, self.tree / name)
        subprocess.run([sys.executable, "-m", "venv", "--without-pip", folder / "venv"], check=True)
        self.python = next((folder / "venv").glob("[bS]*/python*"))
        packages = next((folder / "venv").glob("**/site-packages"))
        # packages of this environment after the copy; without their .pth files, which may lead back to the original
        (packages / "copy.pth").write_text("\n".join([str(self.tree), *site.getsitepackages()]) + "\n")

    def with_faults(self, faults: list[Fault], tests: list[str]) -> tuple[int | None, list[str], str]:
        """Return pytest's exit code (None: it did not end), the tests that failed, and the end of what it printed."""
        files = sorted({file for fault in faults for file in fault.files})
        native = any(Path(file).is_relative_to(LIBRARY) for file in files)
        kept = self.folder / "kept"
        environment = {key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "TRIBOFMU_PYTHON")}
        environment["PATH"] = os.pathsep.join([str(self.python.parent), os.environ["PATH"]])
        for file in files:
            (kept / file).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(self.tree / file, kept / file)
        if native:
            shutil.copytree(self.tree / LIBRARY, kept / "library")
        try:
            for fault in faults:
                for file, old, new in fault.changes:
                    text = (self.tree / file).read_text(encoding="utf-8")
                    if old not in text:
                        print(f"left out, as another fault has changed its line: {fault.name}")
                    (self.tree / file).write_text(text.replace(old, new), encoding="utf-8")
            if any("jit" in (self.tree / file).read_text(encoding="utf-8") for file in files):
                # numba looks only at the file of the function called: kernels that use a changed one stay as they were
                environment["NUMBA_CACHE_DIR"] = str(kept / "kernels")
            if native:
                build = [self.python, "-m", "fmu_src.isolated.library.build"]
                built = subprocess.run(
                    build, cwd=self.tree, env=environment, capture_output=True, text=True, check=False
                )
                if built.returncode != 0:
                    return None, [], built.stderr
            return self._pytest(tests, environment, LONGEST * max(1, len(tests) // 5))
        finally:
            if native:
                shutil.rmtree(self.tree / LIBRARY)
                shutil.copytree(kept / "library", self.tree / LIBRARY)
            for file in files:
                shutil.copy2(kept / file, self.tree / file)
                for compiled in (self.tree / file).parent.glob(f"__pycache__/{Path(file).stem}.*.pyc"):
                    compiled.unlink()
            shutil.rmtree(kept, ignore_errors=True)

    def _pytest(
        self, tests: list[str], environment: dict[str, str], longest: float
    ) -> tuple[int | None, list[str], str]:
        command = [self.python, "-m", "pytest", "-q", "-rfE", "--tb=line", "-p", "no:cacheprovider", *tests]
        with tempfile.TemporaryFile("w+") as told:
            process = subprocess.Popen(
                command, cwd=self.tree, env=environment, stdout=told, stderr=subprocess.STDOUT, start_new_session=True
            )
            try:
                code = process.wait(longest)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                code = process.wait() and None
            told.seek(0)
            text = told.read()
        told_of = [line.partition(" ")[2] for line in text.splitlines() if line.startswith(("FAILED ", "ERROR "))]
        failed = [line.partition(" - ")[0] for line in told_of]
        return code, failed, text[-3000:]


def silent(tests: tuple[str, ...] | list[str], failed: list[str]) -> list[str]:
    """Return those of the tests, files, functions or single cases, of which nothing failed."""
    return [
        test for test in tests if not any(name == test or name.startswith((f"{test}[", f"{test}::")) for name in failed)
    ]


def each(faults: list[Fault], known: dict[str, dict], jobs: int) -> None:
    """Try each fault by itself, and each test without a fault first."""
    keys = {fault.name: fault.key for fault in faults}  # of the sources that are copied, whatever changes meanwhile
    left = [
        fault for fault in faults if not fault.harmless and known.get(fault.name, {}).get("key") != keys[fault.name]
    ]
    print(f"{len(faults)} faults, {len(left)} of them to be tried")
    if not left:
        return
    with tempfile.TemporaryDirectory(prefix="faults-") as folder:
        copies: queue.SimpleQueue[Copy] = queue.SimpleQueue()
        for number in range(min(jobs, len(left))):
            copies.put(Copy(Path(folder, str(number))))

        def tried(fault: Fault | None) -> tuple[int | None, list[str], str]:
            copy = copies.get()
            try:
                tests = sorted({test for one in left for test in one.tests}) if fault is None else list(fault.tests)
                return copy.with_faults([] if fault is None else [fault], tests)
            finally:
                copies.put(copy)

        code, failed, text = tried(None)
        if code != 0:
            print(text, f"these fail without a fault: {failed}", sep="\n", file=sys.stderr)
            sys.exit(2)
        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            running = {pool.submit(tried, fault): fault for fault in left}
            for done in concurrent.futures.as_completed(running):
                fault, (code, failed, text) = running[done], done.result()
                missed = list(fault.tests) if code != 1 else silent(fault.tests, failed)
                print(
                    f"{'SURVIVES' if missed else 'noticed '}  {fault.name}",
                    *missed,
                    sep="\n    silent: " if missed else "",
                )
                if code not in (0, 1):
                    print(text, "" if code is not None else "The tests did not end, or could not begin.", sep="\n")
                known[fault.name] = {"key": keys[fault.name], "silent": missed}
                FOUND.parent.mkdir(exist_ok=True)
                FOUND.write_text(json.dumps(known, indent=1))


def at_once(faults: list[Fault]) -> int:
    """Put all faults into one copy and run the tests of all."""
    tried = [fault for fault in faults if not fault.harmless]
    with tempfile.TemporaryDirectory(prefix="faults-") as folder:
        code, failed, text = Copy(Path(folder)).with_faults(
            tried, sorted({test for one in tried for test in one.tests})
        )
    print(text)
    missed = [fault.name for fault in tried if len(silent(fault.tests, failed)) == len(fault.tests)]
    print(f"{len(tried)} faults at once: {len(failed)} tests failed; hidden by the others: {missed or 'none'}")
    return int(code != 1)


def state_of(fault: Fault, known: dict[str, dict]) -> str:
    """Return whether the tests have noticed a fault as it stands now."""
    found = known.get(fault.name, {})
    if found.get("key") != fault.key:
        return UNKNOWN
    return SURVIVES if found["silent"] else NOTICED


def page(faults: list[Fault], known: dict[str, dict]) -> str:
    """Return the page: each fault with the tests that notice it, or why none can."""
    state = {fault.name: fault.harmless or state_of(fault, known) for fault in faults}
    noticed, survive = (list(state.values()).count(one) for one in (NOTICED, SURVIVES))
    harmless = sum(bool(fault.harmless) for fault in faults)
    lines = [
        "# Faults that the tests notice",
        "",
        f"{len(faults)} faults, put into a copy of the code one at a time: {noticed} make every test named here fail, "
        f"{harmless} cannot matter, {survive} survive, and {len(faults) - noticed - harmless - survive} were not tried "
        "since they or their tests have changed (in brackets). `python -m benchmarks.house.faults` writes this "
        "page; the faults are data in benchmarks/house/faults. A star marks those that a review put in when no test noticed them.",
    ]
    for group in sorted({fault.group for fault in faults}):
        lines += ["", f"## {group.capitalize()}", "", "| fault | in | noticed by |", "|---|---|---|"]
        for fault in faults:
            if fault.group == group:
                by = fault.harmless or "<br>".join(test.removeprefix("tests/") for test in fault.tests)
                if state[fault.name] == SURVIVES:
                    by = f"**survives** {by}"
                elif state[fault.name] == UNKNOWN:
                    by = f"({by})"
                lines.append(f"| {fault.name}{' *' if fault.unnoticed else ''} | {', '.join(fault.files)} | {by} |")
    return "\n".join(lines) + "\n"


def main() -> int:
    """Run the faults asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help="parts of the names of faults, or of their groups")
    parser.add_argument("--at-once", action="store_true", help="all in one copy")
    parser.add_argument("--list", action="store_true", help="print the names and end")
    parser.add_argument("--jobs", type=int, default=2, help="copies that are tried at the same time")
    given = parser.parse_args()
    every = listed()
    if wrong := misfits(every):
        print(*wrong, sep="\n", file=sys.stderr)
        return 2
    faults = [
        one for one in every if not given.names or any(part in f"{one.group}: {one.name}" for part in given.names)
    ]
    if given.list:
        print(*(f"{fault.group}: {fault.name}" for fault in faults), sep="\n")
        return 0
    if given.at_once:
        return at_once(faults)
    known = json.loads(FOUND.read_text()) if FOUND.exists() else {}
    each(faults, known, given.jobs)
    save("house/faults", page(every, known))
    print("wrote docs/measured/house.md")
    return int(any(not fault.harmless and state_of(fault, known) != NOTICED for fault in faults))


if __name__ == "__main__":
    sys.exit(main())
