"""Runs one part in the tree whose Python this is: golden_runs.py PART OUT.json [RECORD.json of the other tree]."""

import importlib
import json
import os
import sys
import time
import traceback
from pathlib import Path

from golden_record import FAILED, Record


def main() -> None:
    """Run all runs of a part, and write what they have seen."""
    part, out = sys.argv[1], Path(sys.argv[2])
    before = json.loads(Path(sys.argv[3]).read_text()).get(part, {}).get("runs", {}) if len(sys.argv) > 3 else {}
    import contact_core

    tree, found = Path(os.environ["GOLDEN_TREE"]).resolve(), Path(contact_core.__file__).resolve()
    if not found.is_relative_to(tree):
        sys.exit(f"contact_core comes from {found}, not from {tree}")
    runs = {}
    wanted = os.environ.get("GOLDEN_RUNS", "")
    for name, run in importlib.import_module(f"golden_{part}").runs(before):
        if wanted not in name:
            continue
        begin = time.monotonic()
        record = Record()
        try:
            run(record)
        except Exception:  # the other runs are worth having
            traceback.print_exc()
            record.put(FAILED, traceback.format_exc().splitlines()[-1])
        runs[name] = record.values
        print(f"    {name}: {len(record.values)} names, {time.monotonic() - begin:.1f} s", flush=True)
    out.write_text(json.dumps(runs))


if __name__ == "__main__":
    main()
