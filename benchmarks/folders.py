"""Where benchmarks write: pages into docs/measured/<room>, kept runs into results/."""

from pathlib import Path

ROOT = Path(__file__).parents[1]
MEASURED = ROOT / "docs" / "measured"
RESULTS = ROOT / "results"
