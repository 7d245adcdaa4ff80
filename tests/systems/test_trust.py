"""What a run says of itself: the contact before it; columns, flags in numbers and a verdict after it."""

import numpy as np
import pytest
import xarray as xr

from contact_core import Error, RangeFlag, Scene
from contact_core.quantities import STATED, TABLE
from contact_core.scene import Assumed
from system_models.run import assumed, flags, report, trust
from system_models.run.duty import Duty
from system_models.store.results import to_dataset


def before(name: str, **changes: str) -> str:
    scene = Scene.from_toml(name, {key.replace("__", "."): value for key, value in changes.items()})
    return " ".join(" ".join(trust.before(scene, Duty.of_scene(scene))).split())


def run_of(**columns: float) -> xr.Dataset:
    """Three rows of a run of MTM and ZDDP."""
    values = {name: np.full(3, 0.5) for name in TABLE} | {name: np.zeros(3) for name in STATED.values()}
    values |= {"valid": np.full(3, True), "range_flags": np.zeros(3, int)}
    values |= {name: np.full(3, 353.15) for name in ("temperature", "temperature_1", "temperature_2")}
    point = Scene.from_toml("mtm_zddp", {}).operation.point
    values |= {name: np.full(3, getattr(point, name)) for name in ("load", "speed_1", "speed_2")}
    values |= {name: np.full(3, point.radius_x or 9.525e-3) for name in ("radius_x", "radius_y")}
    values |= {name: np.full(3, value) for name, value in columns.items()}
    units = {name: quantity.unit for name, quantity in TABLE.items()}
    return to_dataset([0.0, 60.0, 120.0], values, units, {name: q.text for name, q in TABLE.items()})


MTM = Scene.from_toml("mtm_zddp", {})


def test_pressure_motion_film_and_regime_are_told_before_the_run() -> None:
    told = before("mtm_zddp")
    assert "Hertz pressure 1.15 GPa (mean 0.767 GPa), half width 149 um" in told
    assert "entrainment speed 0.1 m/s, slide-to-roll ratio 5 %" in told
    assert "roughness 132 nm; so lambda of handbooks is 0.0711: by its limits boundary lubrication" in told


@pytest.mark.parametrize(
    ("name", "changes", "word"),
    [
        ("ball_209_inner", {}, "full film"),
        ("ball_209_inner", {"surface_1__rq": "0.1 um"}, "mixed lubrication"),
        ("mtm_zddp", {"operation__speed_1": "0.1 m/s", "operation__speed_2": "-0.1 m/s"}, "dry contact"),
    ],
)
def test_the_regime_follows_from_the_film(name: str, changes: dict[str, str], word: str) -> None:
    assert word in before(name, **changes)


def test_a_changing_duty_is_told_by_its_ranges() -> None:
    light, heavy = MTM.operation.point, Scene.from_toml("mtm_zddp", {"operation.load": "8 N"}).operation.point
    told = " ".join(trust.before(MTM, Duty((0.0, 10.0), (light, heavy))))
    assert "Hertz pressure 0.61 to 1.15 GPa" in told


def test_a_grid_too_coarse_for_the_contact_is_told_with_the_way_out() -> None:
    told = before("fzg_flank", operation__load="40 N", geometry__face_width="8 mm")
    assert "Grid: 7.0 nodes across the contact; below 8 the film is one of the grid" in told
    assert "Take --grid 513" in told  # a smaller domain would cut the inlet off
    slow = {"operation__speed_1": "4 mm/s", "operation__speed_2": "3 mm/s"} | {
        "operation__load": "40 N",
        "geometry__face_width": "8 mm",
    }
    assert "--set film.domain='0.2 mm'" in before("fzg_flank", **slow)
    assert "Grid" not in before("fzg_flank", **slow, film__domain="0.2 mm")


def test_a_domain_that_cuts_the_inlet_off_is_told_with_a_domain_that_does_not() -> None:
    told = before("ball_209_inner", film__domain="0.3 mm", film__points="65")
    assert (
        "Inlet: film.domain ends 0.81 lengths of the inlet before the contact: its film comes out too thin, by" in told
    )
    assert "--set film.domain='0.66 mm' --grid 193" in told
    assert "Inlet" not in before("ball_209_inner")
    assert "Inlet" not in before("ball_209_inner", film__domain="0.3 mm", film__model="regression")
    assert "Inlet" not in before("mtm_zddp")


def test_a_flag_names_the_quantity_and_by_how_much() -> None:
    found = run_of(temperature_1=365.15)
    found["range_flags"][:2] = int(RangeFlag.TRIBOFILM_TEMPERATURE)
    (told,) = flags.sentences(MTM, found)
    assert told.startswith("Range, 2 of 3 rows: outside the temperatures")
    assert told.endswith("(92 degC: fitted from 75 to 85 degC).")


def test_every_flag_is_told_whatever_its_numbers() -> None:
    regression = MTM.at_level("regression")
    found = run_of(unconverged=0.7)
    found["range_flags"][:] = sum(RangeFlag)
    told = flags.sentences(regression, found)
    assert len(told) == len(RangeFlag)
    assert all(flag.text in line for flag, line in zip(RangeFlag, told, strict=True))
    assert "(up to 70 % of a block)" in " ".join(told)


def test_a_contact_outside_the_fitted_curves_says_which_number_is_outside() -> None:
    smooth = Scene.from_toml("mtm_zddp", {"film.model": "regression", "surface_1.rq": "5 nm", "surface_2.rq": "5 nm"})
    found = run_of(speed_1=90.0, speed_2=88.0)
    found["range_flags"][:] = int(RangeFlag.OUTSIDE_FIT)
    (told,) = flags.sentences(smooth, found)
    assert "(film of smooth bodies / roughness " in told
    assert "fitted to 47 at most)" in told


def test_the_verdict_says_how_well_each_is_known_and_why() -> None:
    found = run_of(error_friction=0.15, error_film=0.48, error_load_ratio=0.1)
    errors = {"friction_coefficient": Error(grid=0.07), "h_c": Error(curves=0.2), "contact_load_ratio": Error(grid=0.1)}
    told = " ".join(" ".join(trust.after(MTM, found, errors)).split())
    assert "friction to 15 %, W_c to +- 0.1 (the grid); film only to 48 % (the fitted curves)" in told
    assert "valid" not in told
    assert told.endswith("Surer: --accuracy 5%.")


def test_an_error_above_the_value_is_a_factor() -> None:
    told = " ".join(trust.after(MTM, run_of(error_friction=13.0), {}))
    assert "friction only to a factor of 14" in told


def test_a_share_of_solids_is_not_told_to_digits_that_mean_nothing() -> None:
    told = " ".join(" ".join(trust.after(MTM, run_of(error_load_ratio=1.4e-91), {})).split())
    assert "W_c to less than +- 0.001" in told


@pytest.mark.parametrize(
    ("share", "half", "told"),
    [(0.0, 1.0, "W_c not at all"), (0.3, 0.4, "W_c only to +- 0.4"), (0.3, 0.05, "W_c to +- 0.05")],
)
def test_a_share_that_may_be_anything_is_not_known(share: float, half: float, told: str) -> None:
    found = run_of(contact_load_ratio=share, error_load_ratio=half, error_friction=0.1)
    words = " ".join(" ".join(trust.after(MTM, found, {})).split())
    assert "friction to 10 %" in words and told in words


def test_a_longer_domain_is_the_way_out_where_the_inlet_is_cut_off() -> None:
    found = run_of(error_film=0.4)
    half = 0.4 * float(found["h_c"][-1])
    told = " ".join(" ".join(trust.after(MTM, found, {"h_c": Error(inlet=half)})).split())
    assert "film only to 40 % (a domain that cuts the inlet off)" in told
    assert told.endswith("Surer: the domain that the line Inlet names.")


def test_what_is_assumed_or_off_is_said_to_be_in_no_error() -> None:
    values = [Assumed("lubricant.rheology", "eyring", ""), Assumed("heat", "none", "", "off")]
    values += [Assumed("film.points", "129", "", "numerical")]
    told = " ".join(trust.after(MTM, run_of().assign_attrs(assumed.attribute(values)), {}))
    assert "In no error: what is off (heat)." in " ".join(told.split())
    assert "In no error" not in " ".join(trust.after(MTM, run_of().assign_attrs(assumed.attribute([])), {}))


def test_bodies_without_roughness_below_the_grid_are_told_in_words() -> None:
    bare = {f"surface_{i}.microroughness.rms": "0 nm" for i in (1, 2)}
    scene = Scene.from_toml("mtm_zddp", {"film.model": "regression", **bare})
    found = run_of()
    found["range_flags"][:] = int(RangeFlag.OUTSIDE_FIT)
    (told,) = flags.sentences(scene, found)
    assert "(no body has microroughness (surface_1.microroughness): fitted to bodies that have it)" in told
    assert "inf" not in told


def test_invalid_rows_are_told() -> None:
    found = run_of()
    found["valid"][1] = False
    told = " ".join(trust.after(MTM, found, {}))
    assert "1 of 3 rows are INVALID, the first at 60 s" in told
    assert "known" not in told


@pytest.mark.parametrize("width", [60, 80, 100])
def test_a_table_fits_into_the_line_and_loses_no_column(width: int) -> None:
    found = run_of()
    parts = report.table(found, width).split("\n\n")
    assert len(parts) > 1
    assert all(len(line) <= width for part in parts for line in part.splitlines())
    assert all(part.split()[0] == "time" for part in parts)
    whole = report.table(found).splitlines()[2].split()
    assert sum((part.splitlines()[2].split()[1:] for part in parts), whole[:1]) == whole
