"""What tests need built is built once a run, for all of its processes: FMUs, unpacked FMUs, compiled programs.

Nothing of it may be changed: whoever changes files copies them first. Whoever patches what builds, builds for himself.
"""

import hashlib
import shutil
import zipfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
import xdist
from filelock import FileLock

from contact_core import Scene
from fmu_src.flavours import Flavour, Version
from fmu_src.native import build as native_build
from fmu_src.native import keeping
from fmu_src.package.build import build
from fmu_src.runtime import resources
from system_models.parts import resources as resources_of_parts
from system_models.parts.build import build as build_part
from system_models.parts.part import Part

NAME = "built.fmu"


class Built:
    """Folders of one run, each filled by the process that asks for it first."""

    def __init__(self, request: pytest.FixtureRequest, factory: pytest.TempPathFactory) -> None:
        base = factory.getbasetemp()  # of this process; those of xdist's workers lie in that of the run
        self.root = (base.parent if xdist.is_xdist_worker(request) else base) / "built"
        self.models = self.root / "models"  # for benchmarks.models.build, which looks for itself what lies there
        self.models.mkdir(parents=True, exist_ok=True)
        cache = getattr(request.config, "cache", None)  # of pytest, which -p no:cacheprovider leaves out
        self.native = cache.mkdir("native") if cache else self.root / "native"

    def folder(self, key: object, make: Callable[[Path], object]) -> Path:
        """The folder that `make` fills; the repr of `key` tells all that decides how."""
        folder = self.root / hashlib.sha256(repr(key).encode()).hexdigest()[:16]
        with FileLock(f"{folder}.lock"):
            if not folder.exists():
                part = folder.with_suffix(".part")
                shutil.rmtree(part, ignore_errors=True)  # of a `make` that failed
                part.mkdir()
                make(part)
                part.rename(folder)
        return folder

    def fmu(self, source: Scene | Part, flavour: Flavour = "isolated", *, fmi: Version = 2, **options: Any) -> Path:
        """The FMU of a scene or component; `options`: others of `build`."""

        def make(folder: Path) -> None:
            own = build if isinstance(source, Scene) else build_part
            own(source, folder / NAME, flavour, fmi=fmi, **options)

        return self.folder(_key(source, flavour, fmi, options), make) / NAME

    def unpacked(self, source: Scene | Part, flavour: Flavour = "isolated", **options: Any) -> Path:
        """The folder into which the FMU is unpacked."""
        file = self.fmu(source, flavour, **options)

        def make(folder: Path) -> None:
            with zipfile.ZipFile(file) as archive:
                archive.extractall(folder)

        return self.folder(("unpacked", file.parent.name), make)

    @contextmanager
    def sharing(self) -> Iterator[None]:
        """What takes longest of native FMUs is made once, also for later runs: equations in C, and what is compiled."""
        alone = keeping.kept

        def kept(key: object, make: Callable[[], bytes]) -> bytes:
            with FileLock(self.root / f"{hashlib.sha256(repr(key).encode()).hexdigest()[:16]}.lock"):
                return alone(key, make)

        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(keeping, "folder", lambda: self.native)
            patch.setattr(keeping, "kept", kept)
            yield


def _key(source: Scene | Part, flavour: Flavour, fmi: Version, options: dict[str, Any]) -> tuple[object, ...]:
    """All that decides what the FMU contains."""
    guid = resources.guid if isinstance(source, Scene) else resources_of_parts.guid
    compiler = native_build.default_compiler() if flavour == "native" else None
    return guid(source, flavour, fmi), compiler, native_build.FLAGS, sorted(options.items())
