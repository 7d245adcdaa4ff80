"""`tribofmu log`: text logs of test rigs become duties and data."""

from pathlib import Path

import pytest
from comparison import approx

from contact_core import Scene
from system_models.cli.main import main
from system_models.run.duty import Duty
from system_models.run.fit_data import read

SHORT = "Step Time (s)\tRolling Speed (mm/s)\tSRR (%)\tTraction Coeff (-)"
HEAD = SHORT.replace("Rolling", "Ball Load (N)\tRolling") + "\tLube Temp (°C)\tPot Temp (°C)\tECR (%)\tNote"
MTM = "\r\n".join([
    "Test file", "Oil\tBase + ZDDP", "",
    'Step 1 "rub" started at 10:00:00', "Step type\tTimed\tStep description\trub", HEAD,
    "0\t49.9\t100.2\t50\t0.080\t79.8\t85\t98\t", "60\t50.1\t99.8\t50\t0.090\t80.2\t85\t99\t",
    "120\t50.0\t100\t50\t\t80.0\t85\t97\t",
    "", 'Step 2 "Stribeck" started at 10:03:00', "Step type\tStribeck\tStep description\tx",
    SHORT,
    "0\t2000\t50\t0.05", "10\t20\t50\t0.11", "All steps completed",
])  # fmt: skip


def test_a_log_becomes_a_duty_and_data_that_run_and_fit_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("mtm.txt").write_bytes(MTM.encode("cp1252"))
    assert main(["log", "mtm.txt", "--step", "1"]) == 0
    out, err = capsys.readouterr()
    assert "'Lube Temp (°C)' as temperature [degC]" in out
    assert "'Pot Temp (°C)': 'Lube Temp (°C)' is taken" in out
    assert "'ECR (%)': the contact has no such output" in out
    assert "'Note': not known" in out
    assert not err
    scene = Scene.from_toml("mtm_zddp")
    duty = Duty.from_csv("mtm_duty.csv", scene.operation.point)
    (point,) = duty.points  # scatter is no change of an input
    assert (point.load, point.speed_1, point.speed_2, point.temperature) == approx(
        (50.0, 0.125, 0.075, 353.15), rel=1e-9
    )
    data = read(Path("mtm_data.csv"), scene, "regression")
    assert data.time == approx([0.0, 60.0], rel=1e-12)  # the empty cell is none
    assert data.value == approx([0.080, 0.090], rel=1e-12)
    assert len(data.tests) == 1


def test_steps_follow_one_another_and_the_slower_body_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    table = MTM.replace(SHORT, HEAD).replace(
        "0\t2000\t50\t0.05", "0\t50\t2000\t50\t0.05\t80\t85\t9\t"
    ).replace("10\t20\t50\t0.11", "10\t50\t20\t50\t0.11\t80\t85\t9\t")  # fmt: skip
    Path("mtm.txt").write_text(table, "utf-8")
    assert main(["log", "mtm.txt", "--faster", "2", "--out", "out/two"]) == 0
    assert "3 sets of inputs" in capsys.readouterr().err
    duty = Duty.from_csv("out/two_duty.csv", Scene.from_toml("mtm_zddp").operation.point)
    assert duty.times == (0.0, 180.0, 190.0)
    assert [p.speed_1 for p in duty.points] == approx([0.075, 1.5, 0.015], rel=1e-9)
    assert [p.speed_2 for p in duty.points] == approx([0.125, 2.5, 0.025], rel=1e-9)


EHD = "Speed (m/s),Film (nm),SRR\n0.1,50.5,0\n1,240,0\n"


@pytest.mark.parametrize(
    ("text", "given", "said"),
    [
        (EHD, [], "'SRR' does not say its unit"),
        (EHD, ["--column", "SRR="], ""),
        (EHD, ["--column", "SRR=", "Speed (m/s)=rolling_speed"], "Give --srr"),
        (EHD, ["--column", "SRR=srr [m]"], "cannot be srr"),
        (EHD, ["--column", "SRR=sr"], "Did you mean 'srr'"),
        (EHD, ["--column", "SRR= [%]", "--step", "2"], "has steps 1 to 1"),
        ("Load (N)\tFilm (nm)\n1,234\t5.5\n", [], "decimals or of thousands"),
        ("Load (V)\tFilm (nm)\n1\t5.5\n", [], "'Load (V)' cannot be load"),
        ("Mass (g)\tHeight (nm)\n1\t5.5\n", [], "no table with a known column"),
    ],
)
def test_what_a_log_does_not_say_is_asked_back(
    text: str, given: list[str], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    Path("rig.csv").write_text(text)
    assert main(["log", "rig.csv", *given]) == (2 if said else 0)
    assert said in capsys.readouterr().err


def test_columns_that_a_user_names_are_taken_with_decimal_commas(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("rig.txt").write_text("Speed\tFilm (nm)\tLoad (N)\n0,5\t50,5\t20\n1,0\t240\t20\n")
    assert main(["log", "rig.txt", "--column", "Speed=rolling_speed [m/s]", "--srr", "0 %"]) == 0
    assert not Path("rig_duty.csv").exists()  # speeds change, and nothing says when
    data = read(Path("rig_data.csv"), Scene.from_toml("mtm_zddp"), "regression")
    assert sorted(data.value) == approx([50.5e-9, 240e-9], rel=1e-9)
    assert sorted(point.speed_2 for point in data.tests) == approx([0.5, 1.0], rel=1e-9)
