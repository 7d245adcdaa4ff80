"""The files of a native FMU: sources generated for one scene, and the libraries built from them."""

from collections.abc import Mapping

from contact_core.errors import SceneError
from contact_core.scene import Scene

from ..flavours import Version


def sources(scene: Scene, fmi: Version) -> dict[str, bytes]:
    """Return name and content of the sources. Raises SceneError if none can be generated for the scene."""
    raise SceneError(f"The native flavour cannot be built yet, for FMI {fmi} and scene {scene.name}: choose isolated.")


def binaries(sources: Mapping[str, bytes], fmi: Version) -> dict[str, bytes]:
    """Return the libraries by their names in an FMU, such as binaries/linux64/MixedContact.so.

    Raises FileNotFoundError if there is no compiler.
    """
    raise FileNotFoundError(f"There is no compiler for {len(sources)} sources of FMI {fmi}.")
