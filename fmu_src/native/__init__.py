"""The native flavour: C99 sources generated for one scene, and libraries built from them."""

from contact_core.errors import SceneError
from contact_core.scene import Scene

from ..flavours import Version


def sources(scene: Scene, fmi: Version) -> dict[str, bytes]:
    """Return name and content of the sources. Raises SceneError if none can be generated for the scene."""
    raise SceneError(f"The native flavour cannot be built yet, for FMI {fmi} and scene {scene.name}: choose isolated.")


def binaries(sources: dict[str, bytes], fmi: Version) -> dict[str, bytes]:
    """Return the libraries: "x86_64-linux/MixedContact.so" of FMI 3.0, "linux64/MixedContact.so" of FMI 2.0."""
    raise FileNotFoundError(f"There is no compiler for {len(sources)} sources of FMI {fmi}.")
