"""C of native FMUs beside Python: scenes with a random choice in every slot, random inputs and steps.

    python -m benchmarks.fmu.native_laws [--scenes 100] [--seed 1] [--runs 6] [--steps 12]

Prints, for each scene, its choices and the output that differs most, and at the end how many scenes differ by more than
rounding. The choices are those of `native_scenes`; tests/fmu/test_native_laws.py tries each of them once. Needs gcc.
"""

import argparse
import random
import sys
import tempfile
from pathlib import Path

from .native_contact import NativeContact, differences, tolerance
from .native_scenes import CHOICES, merged, scene_of, usable


def main() -> int:
    """Compare what is asked for; return 1 if anything differs."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", type=int, default=100, help="number of scenes")
    parser.add_argument("--seed", type=int, default=1, help="of the choices")
    parser.add_argument("--runs", type=int, default=6, help="runs from fresh surfaces")
    parser.add_argument("--steps", type=int, default=12, help="steps of a run")
    given = parser.parse_args()
    rng, wrong = random.Random(given.seed), 0
    for _ in range(given.scenes):
        numbers = {slot: rng.randrange(len(listed)) for slot, listed in CHOICES.items()}
        if not usable(numbers):
            continue
        scene = scene_of(merged(numbers))
        with tempfile.TemporaryDirectory() as folder:
            try:
                found = differences(scene, NativeContact(scene, Path(folder)), given.runs, given.steps)
                name, worst = max(found.items(), key=lambda item: item[1] / tolerance(item[0]))
                bad = not worst <= tolerance(name)
                said = f"{name} {worst:.1e}{' DIFFERS' if bad else ''}"
            except Exception as error:  # said, and the next scene tried
                bad, said = True, f"{type(error).__name__}: {error}"
        wrong += bad
        print(" ".join(f"{slot}{number}" for slot, number in numbers.items() if number), "|", said, flush=True)
    print(f"{wrong} scenes differ.")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
