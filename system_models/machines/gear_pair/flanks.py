"""The contact of two flanks at a station of the path."""

from contact_core.scene import Scene

from ..assembly import Contact
from .geometry import SpurGearPair
from .mesh import Station


def contact_at(scene: Scene, pair: SpurGearPair, station: Station) -> Contact:
    """Return the contact at a station: values of its FMU beside load, speeds and temperatures."""
    return Contact(
        scene,
        {
            "solids.reduced_modulus": pair.reduced_modulus,
            "radius_x": station.radius_x,
            "geometry.face_width": station.face_width,
            "geometry.track_length_1": station.track_length_1,
            "geometry.track_length_2": station.track_length_2,
        },
    )
