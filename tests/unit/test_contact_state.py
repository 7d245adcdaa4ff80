import zlib
from dataclasses import FrozenInstanceError, fields, is_dataclass, replace
from typing import Any, ClassVar, get_args, get_origin, get_type_hints

import numpy as np
import pytest
from cheap_scene import cheap

from contact_core import ContactState, Outputs, RangeFlag, Scene, StateError, advance, initial_state
from contact_core.film.instant import FilmState
from contact_core.state import Body, Mean
from contact_core.state import state as state_module
from contact_core.state.trends import NAMES, Trends

SMALL = {"film.points": "33", "surface_1.rq": "0 nm", "surface_2.correlation_length": "16 um"}
AWKWARD = (-0.0, 5e-324, 1.0 / 3.0, -1.7976931348623157e308, 0.1 + 0.2)


@pytest.fixture(scope="module")
def scene() -> Scene:
    return Scene.from_toml("mtm_zddp", SMALL)


@pytest.fixture(scope="module")
def used(scene: Scene) -> ContactState:
    """A state with something else than zero in every field."""
    random = np.random.Generator(np.random.Philox(3))

    def filled(cls: Any, shape: tuple[int, int]) -> Any:
        values = {}
        for name, hint in get_type_hints(cls).items():
            if get_origin(hint) is ClassVar:
                continue
            if hint is float:
                values[name] = float(random.normal())
            elif get_args(get_args(hint)[1])[0] is np.bool_:
                values[name] = random.random(shape) < 0.5
            else:
                array = random.normal(size=shape)
                array.flat[: len(AWKWARD)] = AWKWARD
                values[name] = array
        return cls(**values)

    n = scene.film.points
    outputs = {f.name: type(f.default)(random.integers(1, 99) / 7.0) for f in fields(Outputs)}
    return ContactState(
        digest=scene.digest(),
        time=7200.0 / 7.0,
        bodies=(filled(Body, (n, n - 1)), filled(Body, (n + 2, n - 1))),
        film=filled(FilmState, (n, n)),
        law="none, clock",
        solved_for=scene.operation.point,
        change=1e-9 / 3.0,
        held=1.0 / 3.0,
        hold=np.inf,
        settling=3e-4,
        trends=replace(Trends.fresh().followed(dict.fromkeys(NAMES, 1.0 / 3.0), {}, 0.5, 2.5), gain=2.0 / 3.0),
        temperatures=(1000.0 / 3.0, 1001.0 / 3.0),
        outputs=Outputs(**outputs),
        means=(filled(Mean, (0, 0)), filled(Mean, (0, 0))),
    )


def same_bits(one: Any, other: Any) -> bool:
    """Whether two records are equal in type and to the last bit, signs of zero included."""
    if type(one) is not type(other):
        return False
    if is_dataclass(one):
        return all(same_bits(getattr(one, f.name), getattr(other, f.name)) for f in fields(one))
    if isinstance(one, tuple):
        return len(one) == len(other) and all(map(same_bits, one, other))
    if isinstance(one, np.ndarray):
        return one.dtype == other.dtype and one.shape == other.shape and one.tobytes() == other.tobytes()
    return one.hex() == other.hex() if isinstance(one, float) else one == other


def arrays(record: Any) -> list[np.ndarray]:
    if isinstance(record, np.ndarray):
        return [record]
    if isinstance(record, tuple):
        return [array for item in record for array in arrays(item)]
    return [a for f in fields(record) for a in arrays(getattr(record, f.name))] if is_dataclass(record) else []


def test_a_state_survives_its_bytes_bit_for_bit(scene, used):
    assert same_bits(ContactState.from_bytes(used.to_bytes(), scene), used)


def test_a_fresh_state_survives_its_bytes_bit_for_bit(scene):
    fresh = initial_state(scene)
    assert same_bits(ContactState.from_bytes(fresh.to_bytes(), scene), fresh)


def test_the_same_state_gives_the_same_bytes(scene, used):
    data = used.to_bytes()
    assert used.to_bytes() == data
    assert ContactState.from_bytes(data, scene).to_bytes() == data


def test_a_last_bit_that_differs_shows_in_the_bytes(used):
    assert replace(used, time=np.nextafter(used.time, 0.0).item()).to_bytes() != used.to_bytes()


def test_parts_are_the_bytes_with_the_arrays_themselves(used):
    head, *memory = used.parts()
    assert b"".join([head, *memory]) == used.to_bytes()
    assert isinstance(head, bytes)
    listed = [array for array in arrays(used) if np.unique(array).size > 1]
    assert len(memory) == len(listed) > 20
    assert {id(part.obj) for part in memory} == {id(array) for array in listed}
    assert all(part.readonly for part in memory)


@pytest.mark.parametrize("odd", [-0.0, np.nextafter(0.0, 1.0)])
@pytest.mark.parametrize("place", [0, 7, -1])
def test_an_array_of_one_value_is_stored_as_that_value_and_no_other_is(scene, odd, place):
    fresh = initial_state(scene)
    wear = fresh.bodies[1].wear.copy()
    wear.flat[place] = odd
    other = replace(fresh, bodies=(fresh.bodies[0], replace(fresh.bodies[1], wear=wear)))
    assert len(fresh.parts()) == 1
    assert len(other.parts()) == 2
    assert same_bits(ContactState.from_bytes(other.to_bytes(), scene), other)


def test_a_contact_that_has_only_seen_the_regression_level_has_a_state_of_a_few_kilobytes_on_any_grid():
    scene, state, point = cheap()
    fine = replace(scene, film=replace(scene.film, points=257)).at_level("regression")
    coarse = scene.at_level("regression")
    sizes = set()
    for fast in (coarse, fine):
        state = initial_state(fast)
        for _ in range(3):
            state, _ = advance(fast, point, state, 60.0)
        sizes.add(len(state.to_bytes()))
        assert same_bits(ContactState.from_bytes(state.to_bytes(), fast), state)
    assert len(sizes) == 1
    assert max(sizes) < 4_000


def test_a_changed_array_is_not_taken_for_the_one_stored_before(scene, used):
    before = used.to_bytes()
    first, second = used.bodies
    worn = replace(used, bodies=(replace(first, wear=first.wear + 1.0), second))
    assert worn.to_bytes() != before
    assert same_bits(ContactState.from_bytes(worn.to_bytes(), scene), worn)
    assert used.to_bytes() == before


def memory_kept(then: ContactState, now: ContactState) -> list[bool]:
    before = {id(part.obj) for part in then.parts()[1:]}
    return [id(part.obj) in before for part in now.parts()[1:]]


def test_a_step_of_the_regression_level_keeps_every_array():
    scene, state, point = cheap()
    fast = scene.at_level("regression")
    state, _ = advance(scene, point, state, 60.0)
    for _ in range(2):
        later, _ = advance(fast, point, state, 1.0)
        assert later.parts()[0] != state.parts()[0]
        assert len(memory_kept(state, later)) > 10
        assert all(memory_kept(state, later))
        state = later


def test_between_two_solutions_most_arrays_are_kept():
    scene, state, point = cheap()
    state, _ = advance(scene, point, state, 0.0)
    later, _ = advance(scene, point, state, 1e-3)
    changed = [not kept for kept in memory_kept(state, later)]
    assert 0 < sum(changed) < 0.5 * len(changed)


def test_arrays_of_a_state_are_read_only_and_aligned_like_fresh_ones(scene, used):
    restored = ContactState.from_bytes(used.to_bytes(), scene)
    found = arrays(restored) + arrays(initial_state(scene))
    assert len(found) > 20
    for array in found:
        assert not array.flags.writeable
        assert array.flags.aligned
        assert array.flags.c_contiguous
    with pytest.raises(ValueError, match="read-only"):
        restored.bodies[0].wear[0, 0] = 1.0


def test_a_state_is_frozen(used):
    with pytest.raises(FrozenInstanceError):
        used.time = 0.0


def test_a_fresh_state_has_no_film_no_wear_and_the_shape_of_the_grid(scene):
    state = initial_state(scene)
    assert state.film is None
    assert state.solved_for is None
    assert state.time == 0.0
    for body in state.bodies:
        assert all(getattr(body, name).shape == (33, 32) for name in Body.ARRAYS)
        assert not any(getattr(body, name).any() for name in Body.ARRAYS if name != "since")
        assert np.isinf(body.since).all()


@pytest.mark.parametrize("length", [0, 5, 8, 12, 15, 16, 200, -8, -1])
def test_a_cut_state_is_refused(scene, used, length):
    with pytest.raises(StateError, match=r"not one of tribofmu's|damaged"):
        ContactState.from_bytes(used.to_bytes()[:length], scene)


def test_a_state_with_something_behind_it_is_refused(scene, used):
    with pytest.raises(StateError, match="damaged"):
        ContactState.from_bytes(used.to_bytes() + b"\0", scene)


def test_a_state_with_any_byte_changed_is_refused(scene, used):
    data = used.to_bytes()
    places = [*range(0, 16), *np.linspace(16, len(data) - 1, 60).astype(int)]
    for at in places:
        damaged = data[:at] + bytes([data[at] ^ 4]) + data[at + 1 :]
        with pytest.raises(StateError) as error:
            ContactState.from_bytes(damaged, scene)
        assert "Use an earlier one." in str(error.value) or "Give a file" in str(error.value)


def test_a_state_of_an_older_schema_is_refused_with_both_numbers(scene):
    header = b'{"schema": 5, "arrays": [], "state": {}}' + b" " * 4000
    head = len(header).to_bytes(4, "little") + header
    for written in (head, bytes([4, 0, 0, 0]) + head):
        data = b"tribofmu" + zlib.crc32(written).to_bytes(4, "little") + written
        with pytest.raises(StateError, match=r"has schema (4|5 or less) .*reads 11\. Give a file"):
            ContactState.from_bytes(data, scene)


def test_a_state_of_other_outputs_is_refused(scene, used, monkeypatch):
    """Numbers are stored by their order: a version with one output more would read each of them as another."""
    data = used.to_bytes()
    monkeypatch.setattr("contact_core.state.state.NAMES", ("another", *state_module.NAMES))
    state_module._layout.cache_clear()
    try:
        with pytest.raises(StateError, match=r"a version with other inputs or outputs\. Give a file"):
            ContactState.from_bytes(data, scene)
    finally:
        state_module._layout.cache_clear()


@pytest.mark.parametrize("data", [b"", b"tribofmu", b"PK\x03\x04 not a state at all", b"\0" * 64])
def test_foreign_bytes_are_refused_with_a_way_out(scene, data):
    with pytest.raises(StateError, match=r"not one of tribofmu's\. Give a file that a run has written\."):
        ContactState.from_bytes(data, scene)


@pytest.mark.parametrize(
    "change",
    [
        {"surface_2.seed": "9"},
        {"film.points": "35"},
        {"geometry.radius_y": "9 mm"},
        {"surface_2.rq": "90 nm"},
    ],
)
def test_the_state_of_another_contact_is_refused_with_both_fingerprints(scene, used, change):
    other = Scene.from_toml("mtm_zddp", SMALL | change)
    with pytest.raises(StateError) as error:
        ContactState.from_bytes(used.to_bytes(), other)
    assert scene.digest() in str(error.value)
    assert other.digest() in str(error.value)
    assert "Use the scene it was made with." in str(error.value)


def test_a_state_outlives_a_change_of_laws(used):
    other = Scene.from_toml("mtm_zddp", SMALL | {"wear.bare": "2e-5", "tribofilm.model": "none"})
    assert same_bits(ContactState.from_bytes(used.to_bytes(), other), used)


def test_range_flags_add_up_and_come_apart_again():
    total = sum(RangeFlag)
    assert total == 2 ** len(RangeFlag) - 1
    assert set(RangeFlag(total)) == set(RangeFlag)
    assert all(flag.text for flag in RangeFlag)
