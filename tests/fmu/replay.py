"""Restore a stored FMU state and print the outputs of the next steps: replay.py FOLDER STATE [STEPS]."""

import json
import sys
from pathlib import Path

from fmu_host import hosted

STEPS = [(30.0, {"load": 45.0}), (90.0, {})]


def replay(host, state: bytes, steps=STEPS) -> list[dict[str, str]]:
    host.restore(state)
    return [{k: float(v).hex() for k, v in host.step(dt, **inputs).items()} for dt, inputs in steps]


if __name__ == "__main__":
    with hosted(Path(sys.argv[1])) as fresh:
        print(json.dumps(replay(fresh, Path(sys.argv[2]).read_bytes(), *map(json.loads, sys.argv[3:]))))
