"""Outputs of contacts that a machine records: all of the table of quantities but those that are listed as left out."""

from contact_core.quantities import TABLE
from system_models.machines.assembly import _NOT_RECORDED, RECORDED

OUTPUTS = [q.name for q in TABLE.values() if q.role != "input"]


def test_an_output_is_recorded_unless_it_is_left_out_by_name() -> None:
    assert set(OUTPUTS) >= _NOT_RECORDED, "a name that is left out is one of an output"
    assert [name for name in OUTPUTS if name not in _NOT_RECORDED] == list(RECORDED)
    assert {"friction_force", "h_c", "lambda_ratio", "tribofilm_1", "wear_volume_2"} <= set(RECORDED)
