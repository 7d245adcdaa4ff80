"""Everything that can change the next answer, frozen, and what a step gives back: `advance` returns a new state.

Read-only arrays on body-fixed patches [ny, nx], periodic along x, but for the film's, on the grid of the contact.
"""

import struct
import zlib
from dataclasses import dataclass, fields
from functools import cache, cached_property
from typing import Any, ClassVar, TypeVar

import numpy as np

from ..errors import StateError
from ..film.instant import FilmState
from ..kernels.arrays import Array
from ..laws.tribofilm import thickness
from ..scene import OperatingPoint, Scene
from .below import Below
from .classes import Classes
from .outputs import Outputs
from .solved import Solved
from .storage import Reader, numbers, stored
from .trends import NAMES, Trends

_Record = TypeVar("_Record", "ContactState", "Outputs", "Mean", OperatingPoint)
_MAGIC, _SCHEMA = b"tribofmu", 11
_FEWEST = 100  # bytes that a header of schema 5 or before has at least
_CHECKSUM, _SIGNED = struct.Struct("<I"), struct.Struct("<II")
_LAYOUT = struct.Struct("<I")
_TEXTS = struct.Struct(
    "<7?II"
)  # what is there of film, solved_for, means, temperatures, solved, below, classes; lengths of digest, law
_PAIR = struct.Struct("<2d")


@dataclass(frozen=True)
class Body:
    """One body's rubbing track, cut to a patch that repeats along x. Arrays [rows, nx - 1]."""

    growth: Array  # tribofilm formed [m]
    removal: Array  # tribofilm removed [m]
    formed: Array  # all tribofilm that has grown so far [m]; less what there is: all that was removed
    oxide: Array  # thickness where no tribofilm covers the solid [m]; zero without a law of it
    wear: Array  # depth worn [m]
    plastic: Array  # permanent depth pressed in [m]
    pits: Array  # depth broken out by fatigue [m]; zero without a law of it
    opened: Array  # part of it that the surface has lost [m]; zero unless stress.pits = "open"
    pressure: Array  # of the solids on a point, mean over its track [Pa], of the last solution: for wear
    exposure: Array  # per test time, of the last solution: for the tribofilm law
    abrasion: Array  # rate [1/s], per test time, at which rubbing removes the tribofilm; zero for laws without it
    since: Array  # passes through the contact since a point had the exposure `peak`
    peak: Array  # largest exposure in the last pass
    offset: float  # how far the patch has moved along x in the solved steps [m], within one patch length
    cycles: float  # passes through the contact
    worn: float  # wear volume of the whole track [m3]
    noise: float  # variance of wear and tribofilm from node to node that sampling has made [m2]

    ARRAYS: ClassVar[tuple[str, ...]] = (
        "growth",
        "removal",
        "formed",
        "oxide",
        "wear",
        "plastic",
        "pits",
        "opened",
        "pressure",
        "exposure",
        "abrasion",
        "since",
        "peak",
    )

    def __post_init__(self) -> None:
        for name in self.ARRAYS:
            getattr(self, name).setflags(write=False)

    @cached_property
    def tribofilm(self) -> Array:
        """Tribofilm thickness [m], [rows, nx - 1]."""
        film = thickness(self.growth, self.removal)
        film.setflags(write=False)
        return film


@dataclass(frozen=True)
class Mean:
    """Track means of a body at the regression level: over |y| < b, b at the scene's reference load."""

    growth: float  # tribofilm formed [m]; all of it lies on the covered part
    removal: float  # tribofilm removed [m]
    coverage: float  # share of the track that carries the tribofilm, taken as even there
    wear: float  # depth worn [m]
    roughness: float  # rms roughness of the solid under its tribofilm [m]
    worn: float  # wear volume of the whole track [m3]
    cycles: float  # passes through the contact
    formed: float = 0.0  # all tribofilm that has grown so far [m]
    oxide: float = 0.0  # thickness where no tribofilm covers the solid [m]


@dataclass(frozen=True)
class ContactState:
    """Everything that the next step depends on."""

    digest: str  # fingerprint of the scene it belongs to
    time: float  # [s]
    bodies: tuple[Body, Body]
    film: FilmState | None  # the last film solution: warm start and history of the squeeze term; None: start dry
    law: str  # what `exposure` of the bodies means
    solved_for: OperatingPoint | None  # of the last block; None: nothing solved yet
    change: float  # geometry change since the last block [m]
    held: float  # time since the last block [s]
    hold: float  # longest time until the next block [s]
    settling: float  # time [s] for which the film still follows inputs that have changed (control.inputs)
    trends: Trends
    temperatures: tuple[float, float] | None  # of the bodies [K], for heat.bulk = "lumped"; None: none yet
    outputs: Outputs
    means: tuple[Mean, Mean] | None = None  # of the regression level, newer than the patches; None: these are current
    solved: Solved | None = None  # blocks that the level `auto` has solved; None: none yet
    window: float = 0.0  # way [m] by which the nodes of the contact lie further along +x: they move on with the oil
    below: Below | None = None  # stresses and damage below the surfaces; None: none sampled yet
    classes: Classes | None = None  # damage at the regression level; None: that of `below`

    @property
    def rows(self) -> int:
        """Rows of the patches and of the grid of the contact."""
        return self.bodies[0].wear.shape[0]

    def to_bytes(self) -> bytes:
        """Return the state as bytes; the same state gives the same bytes.

        They are: magic, checksum of the head, the head (schema, length, layout, texts, numbers, what the arrays are,
        their checksums), raw little-endian arrays.
        """
        return b"".join(self.parts())

    def parts(self) -> list[bytes | memoryview]:
        """Return the parts that `to_bytes` joins: all up to the arrays, then the memory of each array, not copied.

        An array of one value everywhere has no part: fresh surfaces take up no room. An array that has not changed
        since an earlier state is the same object in both (`obj` of its part): at the regression level all of them,
        between two solutions of the deterministic level all but tribofilm and wear.
        """
        some = self.film, self.solved, self.below, self.classes
        kept = [stored(record) for record in (*self.bodies, self.trends, *some) if record is not None]
        texts = self.digest.encode(), self.law.encode()
        maybe = self.film, self.solved_for, self.means, self.temperatures, self.solved, self.below, self.classes
        given = [record is not None for record in maybe]
        single = [r for r in (self, self.outputs, self.solved_for, *(self.means or ())) if r is not None]
        head = b"".join(
            [
                _LAYOUT.pack(_layout()),
                _TEXTS.pack(*given, *map(len, texts)),
                *texts,
                *map(numbers, single),
                _PAIR.pack(*self.temperatures or (0.0, 0.0)),
                *[record.head for record in kept],
            ]
        )
        signed = _SIGNED.pack(_SCHEMA, len(head)) + head
        memory = [array for record in kept for array in record.memory]
        return [b"".join([_MAGIC, _CHECKSUM.pack(zlib.crc32(signed)), signed]), *memory]

    @staticmethod
    def from_bytes(data: bytes, scene: Scene) -> "ContactState":
        """Restore what `to_bytes` wrote, bit for bit. Raises StateError if damaged or of another scene."""
        state = _read(data)
        if state.digest != scene.digest():
            raise StateError(
                f"The stored state belongs to another contact (fingerprint {state.digest}, scene '{scene.name}' has "
                f"{scene.digest()}): geometry, surfaces and grid must be the same. Use the scene it was made with."
            )
        return state


def _read(data: bytes) -> ContactState:
    start = len(_MAGIC) + _CHECKSUM.size
    if data[: len(_MAGIC)] != _MAGIC or len(data) < start + _SIGNED.size:
        raise StateError("The stored state is not one of tribofmu's. Give a file that a run has written.")
    (checksum,) = _CHECKSUM.unpack_from(data, len(_MAGIC))
    schema, length = _SIGNED.unpack_from(data, start)
    if schema != _SCHEMA:  # 5 and before had the length of their header there
        found = schema if schema < _FEWEST else "5 or less"
        raise StateError(
            f"The stored state has schema {found} or is damaged; this version reads {_SCHEMA}. Give a file that a run "
            "of this version has written."
        )
    end = start + _SIGNED.size + length
    if zlib.crc32(memoryview(data)[start:end]) != checksum:
        raise StateError("The stored state is damaged: it was cut or changed. Use an earlier one.")
    reader = Reader(data, start + _SIGNED.size, end)
    try:
        state = _unpacked(reader)
        reader.close()
    except (ValueError, struct.error) as error:
        raise StateError(f"The stored state is damaged ({error}). Use an earlier one.") from None
    return state


@cache
def _layout() -> int:
    """Return the fingerprint of the numbers and trends in a stored state, by their names and order."""
    records = (ContactState, Outputs, OperatingPoint, Mean, Body, Trends, FilmState, Solved, Below, Classes)
    names = [f.name for record in records for f in fields(record)]
    return zlib.crc32(" ".join([*names, *NAMES]).encode())


def _unpacked(reader: Reader) -> ContactState:
    (layout,) = reader.values(_LAYOUT)
    if layout != _layout():
        raise StateError(
            "The stored state was written by a version with other inputs or outputs. Give a file that a run of this "
            "version has written."
        )
    film, solved_for, means, temperatures, solved, below, classes, digest, law = reader.values(_TEXTS)
    texts: dict[str, Any] = {"digest": reader.text(digest), "law": reader.text(law)}
    own = reader.numbers(ContactState)
    outputs = Outputs(**reader.numbers(Outputs))
    point = OperatingPoint(**reader.numbers(OperatingPoint)) if solved_for else None
    both = (Mean(**reader.numbers(Mean)), Mean(**reader.numbers(Mean))) if means else None
    warm = reader.values(_PAIR)
    return ContactState(
        **texts,
        **own,
        outputs=outputs,
        solved_for=point,
        means=both,
        temperatures=(warm[0], warm[1]) if temperatures else None,
        bodies=(reader.record(Body), reader.record(Body)),
        trends=reader.record(Trends),
        film=reader.record(FilmState) if film else None,
        solved=reader.record(Solved) if solved else None,
        below=reader.record(Below) if below else None,
        classes=reader.record(Classes) if classes else None,
    )


def changed(record: _Record, **values: Any) -> _Record:
    """`dataclasses.replace` at a fifth of its cost: the fields must exist, and nothing is looked at."""
    copy = object.__new__(type(record))
    copy.__dict__.update(record.__dict__)
    copy.__dict__.update(values)
    return copy


def initial_state(scene: Scene) -> ContactState:
    """Fresh surfaces: no film, no wear, nothing solved."""
    shape = (scene.rows, scene.film.points - 1)
    zeros = np.zeros(shape)
    arrays = dict.fromkeys(Body.ARRAYS, zeros) | {"since": np.full(shape, np.inf)}
    body = Body(**arrays, offset=0.0, cycles=0.0, worn=0.0, noise=0.0)
    return ContactState(
        scene.digest(), 0.0, (body, body), None, "", None, 0.0, 0.0, 0.0, 0.0, Trends.fresh(), None, Outputs()
    )
