"""Build a scene's FMU: python build_fmu.py SCENE [--flavour isolated|embedded] [--out FILE.fmu] ..."""

from fmu_src.build import main

raise SystemExit(main())
