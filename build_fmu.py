"""Build a scene's FMU: python build_fmu.py SCENE [--out FILE.fmu] [--set key=value ...]."""

from fmu_src.build import main

raise SystemExit(main())
