"""The files of a native FMU: sources generated for one scene, and the libraries built from them."""

from collections.abc import Mapping

from contact_core.scene import Scene

from ..flavours import Version
from ..runtime.resources import MODEL, guid
from ..variables import variables
from . import build, program
from .built_in import built_in
from .model import model_c
from .tables import tables_h


def sources(scene: Scene, fmi: Version) -> dict[str, bytes]:
    """Return name and content of the sources. Raises SceneError if none can be generated for the scene."""
    model = model_c(built_in(variables(scene)), guid(scene, "native", fmi), guid(scene, "native"))
    return {**build.runtime(fmi), **contact(scene), "model.c": model.encode()}


def contact(scene: Scene) -> dict[str, bytes]:
    """Return the equations of a scene. Raises SceneError if it has none without a solver."""
    texts = {**program.written(scene), "tables.h": tables_h()}
    also = [name for name in _WHERE_NEEDED if any(f'#include "{name}"' in text for text in texts.values())]
    own = {name: (build.FOLDER / name).read_bytes() for name in also}
    return {**own, **{name: text.encode() for name, text in texts.items()}}


_WHERE_NEEDED = ("normal.h",)


def binaries(sources: Mapping[str, bytes], fmi: Version, model: str = MODEL, here: bool = False) -> dict[str, bytes]:
    """Return the libraries by their names in an FMU, such as binaries/linux64/MixedContact.so.

    `here`: that of this platform only. Raises FileNotFoundError if there is no compiler.
    """
    return build.binaries(sources, fmi, model, chosen=[build.own(fmi)] if here else None)


def missing(fmi: Version) -> list[str]:
    """Return the platforms for which the installed compiler builds no library. Raises FileNotFoundError without any."""
    return sorted({*build.platforms(fmi, "zig")} - {*build.platforms(fmi, build.default_compiler())})
