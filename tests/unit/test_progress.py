"""Progress within a long step: told to listeners, without any effect on the answer."""

from cheap_scene import cheap

from contact_core import advance
from contact_core.progress import listening


def test_a_block_tells_each_of_its_instants_in_order_and_gives_the_same_bits_as_without_a_listener():
    scene, state, op = cheap(control__driver="mixed")
    told = []
    with listening(lambda *part: told.append(part)):
        heard = advance(scene, op, state, 0.0)
    numbers, totals = zip(*[(number, total) for what, number, total in told if what == "instant"], strict=True)
    assert list(numbers) == list(range(1, len(numbers) + 1))
    assert set(totals) == {len(numbers)}
    count = len(told)
    alone = advance(scene, op, state, 0.0)
    assert len(told) == count  # nobody listens any longer
    assert alone[0].to_bytes() == heard[0].to_bytes()
