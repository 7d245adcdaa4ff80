"""What a scene assumes, in the table and the result of its run."""

import numpy as np
import xarray as xr
from comparison import approx

from contact_core import Scene
from contact_core.assumed import assumed
from system_models.cli.main import main


def test_a_run_prints_and_keeps_half_widths_by_what_is_assumed(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    settings = ["film.model=regression", "operation.duration=2 min"]
    assert main(["run", "mtm_zddp", "--out", "out", "--set", *settings]) == 0
    said = " ".join(capsys.readouterr().out.split())
    scene = Scene.from_toml("mtm_zddp", {"film.model": "regression"})
    worth = assumed(scene, scene.operation.point)
    with xr.open_dataset("out/result.nc", decode_times=False) as result:
        friction = result["friction_coefficient_assumed"].values
        assert friction == approx(np.full(3, worth["friction_coefficient"].together), rel=0.02)
        wear = result["wear_depth_1_assumed"].values / np.maximum(result["wear_depth_1"].values, 1e-30)
        assert wear[1:] == approx(np.full(2, worth["wear_depth"].together), rel=0.02)
        assert result["h_c_assumed"].attrs["units"] == "m"
    assert f"({friction[0]:.2g})" in said
    assert "Assumed, beside these errors, of new surfaces: friction +- 0.031 (by boundary_friction.bare, surf" in said
    assert "in brackets the half width by what is assumed" in said
