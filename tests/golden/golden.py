"""The numbers of two revisions, bit for bit: for changes of the code that must change none.

    python tests/golden/golden.py REV                       the working tree beside REV
    python tests/golden/golden.py REV --only scenes fmu     some parts: scenes machines fmu cosim states
    python tests/golden/golden.py REV --save                run REV and keep its record, compare nothing

Each tree is copied into a temporary folder, with a virtual environment of its own and no compiled kernels yet. The same
scripts, those beside this file, run in both, one process at a time and on one thread. They know the names that
contact_core offers, the command `tribofmu` and FMI. Every number that they see is kept with all its bits, states as a
digest. The record of REV is results/golden/SHA.json; a part of it is run again when its scripts, the packages or the
machine have changed. The record of the working tree is results/golden/working_tree.json.

A number that only REV has is a difference; runs and numbers that only the working tree has are new, texts may be
reworded: both are said. A state or checkpoint of REV may be refused with a sentence by the
working tree: this is said, and is no difference. The exit code is 1 if anything differs.
"""

import argparse
import hashlib
import importlib.metadata
import json
import platform
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from golden_compare import differences
from golden_tree import ROOT, Tree, archived, sha_of, working

HERE = Path(__file__).parent
RECORDS = ROOT / "results" / "golden"
PARTS = {  # and their scripts, besides those that all share
    "scenes": ["golden_scenes.py", "golden_laws.py", "golden_calls.py"],
    "machines": ["golden_machines.py", "golden_command.py"],
    "fmu": ["golden_fmu.py", "golden_host.py", "golden_command.py", "golden_laws.py"],
    "cosim": ["golden_cosim.py", "golden_command.py", "golden_laws.py"],
    "states": ["golden_states.py", "golden_command.py", "golden_laws.py"],
}
SHARED = ["golden_runs.py", "golden_record.py"]
PACKAGES = ("numpy", "scipy", "numba", "llvmlite", "pyfftw", "fmpy", "pythonfmu", "xarray")
SHOWN = 5  # differences of a run


def main() -> int:
    """Compare what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("revision", metavar="REV", help="of git, whose numbers are right")
    parser.add_argument("--only", nargs="+", choices=PARTS, default=list(PARTS), help="these parts")
    parser.add_argument("--save", action="store_true", help="run REV and keep its record, compare nothing")
    parser.add_argument("--anew", action="store_true", help="run REV again even if there is a record")
    parser.add_argument(
        "--match", default="", metavar="TEXT", help="of the working tree only runs with TEXT in their name"
    )
    given = parser.parse_args()
    sha = sha_of(given.revision)
    RECORDS.mkdir(parents=True, exist_ok=True)
    file = RECORDS / f"{sha}.json"
    base = {} if given.anew else _read(file)
    left = [part for part in given.only if base.get(part, {}).get("key") != _key(part)]
    if left:
        with tempfile.TemporaryDirectory(prefix="golden-") as folder:
            tree = Tree(Path(folder), archived(sha))
            for part in left:
                base[part] = _run(tree, part, given.revision)
                file.write_text(json.dumps(base))
    if given.save:
        return 0
    own = {}
    with tempfile.TemporaryDirectory(prefix="golden-") as folder:
        tree = Tree(Path(folder), working())
        for part in given.only:
            own[part] = _run(tree, part, "working tree", file, given.match)
            (RECORDS / "working_tree.json").write_text(json.dumps(own))
    return _table(given.only, base, own, given.match)


def _read(file: Path) -> dict:
    return json.loads(file.read_text()) if file.exists() else {}


def _key(part: str) -> str:
    """What a part's record depends on besides the tree."""
    parts = [platform.machine(), platform.python_version(), _processor()]
    parts += [f"{name} {importlib.metadata.version(name)}" for name in PACKAGES]
    parts += [(HERE / name).read_text(encoding="utf-8") for name in (*PARTS[part], *SHARED)]
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()


def _processor() -> str:
    """Kernels are compiled for it."""
    info = Path("/proc/cpuinfo")
    lines = info.read_text().splitlines() if info.exists() else []
    return next((line for line in lines if line.startswith("model name")), platform.processor())


def _run(tree: Tree, part: str, name: str, before: Path | None = None, match: str = "") -> dict:
    """Run one part in a tree, or some runs of it; the record of the other tree is there for stored states."""
    print(f"{name}: {part} ...", flush=True)
    begin, out = time.monotonic(), tree.folder / f"{part}.json"
    command = [str(tree.python), str(HERE / "golden_runs.py"), part, str(out), *([str(before)] if before else [])]
    with tempfile.TemporaryDirectory(prefix="golden-work-", dir=tree.folder) as folder:
        code = subprocess.run(command, cwd=folder, env=tree.environment | {"GOLDEN_RUNS": match}).returncode
    if code:
        print(f"{name}: {part} has failed, see above.", file=sys.stderr)
        return {"key": "", "failed": True, "seconds": time.monotonic() - begin, "runs": {}}
    seconds = time.monotonic() - begin
    print(f"{name}: {part} took {seconds:.0f} s", flush=True)
    return {"key": _key(part), "seconds": seconds, "runs": json.loads(out.read_text())}


def _table(parts: list[str], base: dict, own: dict, match: str) -> int:
    """Print what was compared; return the exit code."""
    wrong = compared = 0
    print(f"\n{'part':9} {'run':58} {'values':>9}  result")
    for part in parts:
        if base[part].get("failed") or own[part].get("failed"):
            print(f"{part:9} {'':58} {0:9}  FAILED")
            wrong += 1
            continue
        before, after = base[part]["runs"], own[part]["runs"]
        for run in [*before, *(run for run in after if run not in before)]:
            if match not in run:
                continue
            count, found, notes = differences(before.get(run), after.get(run))
            compared += count
            wrong += bool(found)
            said = f"{len(found)} DIFFER" if found else "; ".join(["equal", *notes] if count else notes or ["nothing"])
            print(f"{part:9} {run:58} {count:9}  {said}")
            for line in found[:SHOWN]:
                print(f"          {line}")
    seconds = ", ".join(f"{part} {own[part]['seconds']:.0f} s" for part in parts)
    print(f"\n{compared} values compared, {wrong} runs differ. The working tree took: {seconds}.")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
