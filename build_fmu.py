"""Build a scene's FMU: python build_fmu.py SCENE [--flavour isolated|embedded] [--out FILE.fmu] ..."""

from fmu_src.package.command import main

raise SystemExit(main())
