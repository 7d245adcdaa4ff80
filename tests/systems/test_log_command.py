"""`tribofmu log`: text logs of test rigs become duties and data."""

from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from comparison import approx
from hypothesis import given
from hypothesis import strategies as st

from contact_core import Scene, SceneError
from system_models.cli.main import main
from system_models.instruments import log_file, log_tables
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
        ("Time (s)\tLoad (N)\n2024-05-01T10:00\t5\n", [], "no row of numbers below 'Time (s)\tLoad (N)'"),
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


# headers of exports of PCS Instruments' rigs as users have published them; the numbers are invented
TAIL = (
    "Ball Speed 1\tBall Speed 2\tDisc Speed 1\tDisc Speed 2\tRolling Speed (mm/s)\tSliding Speed (mm/s)\tSRR (%)\t\t"
    "Traction Force (N)\tTraction Coeff (-)"
)
FILMS = "\n".join([
    "EHD261 Test Data File", "Disc track radius:\t40.000", "",
    'Step 1 "zero" started at 01/01/2020 10:00', "Step type\tFILM_ZERO\tStep description\tzero",
    "       Ball load = 20.0 N", "",
    'Step 2 "films" started at 01/01/2020 10:05', "Step type\tFILM\tStep description\tfilms",
    f"Rolling Speed (mm/s)\tAverage Film (nm)\t\tStep Time (s)\tLube Temp (°C)\tBall Load (N)\t\t{TAIL}\t\t"
    "Average Film (nm)\tStandard Deviation (nm)\tImage file name",
    "100.0\t50.0\t\t10\t40.1\t20.1\t\t100.01\t\t99.99\t\t100.00\t-0.02\t-0.020\t\t0.8\t\t\t50.0\t0.5\t",
    "200.0\t80.0\t\t20\t40.1\t19.9\t\t200.00\t\t200.01\t\t200.00\t0.01\t0.005\t\t0.8\t\t\t80.0\t0.5\t",
    "", "All steps completed, test completed normally at 01/01/2020 10:20", "",
])  # fmt: skip
RUBBED = "\n".join([
    "MTM311 Test Data File", "",
    "Step 1 started at 01/01/2020 10:00:00",
    "Step type\t{kind}\tStep description\trub\tStep duration\t00:00:20",
    "Zero traction force (N)\t0.1\t(measured at the start of this step)",
    f"Step Time (s)\tTraction Coeff (-)\t\tStep Time (s)\tPot RTD Temp (degC)\tLube RTD Temp (degC)\tBall Load (N)\t"
    f"Pin Load (N)\tECR (%)\t\t{TAIL}\tRolling Coeff (-)",
    "{rows}",
])  # fmt: skip
BALL = "10\t0.100\t\t10\t90\t100.1\t30.1\t\t0\t\t50.0\t\t150.0\t\t100.0\t100.0\t100.0\t\t3.0\t0.100\t"
PIN = "10\t0.100\t\t10\t90\t100.1\t\t12.0\t0\t\t\t\t200.0\t\t\t200.0\t\t\t1.2\t0.100\t"


@pytest.mark.parametrize("german", [False, True])
def test_films_of_an_interferometer_are_read_though_its_steps_are_called_film(
    german: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    text = FILMS.replace(".", ",").replace("\t", ";") if german else FILMS
    Path("ehd.txt").write_bytes(text.encode("latin-1"))
    assert main(["log", "ehd.txt"]) == 0
    out = capsys.readouterr().out
    assert '"films" started at' in out and ", FILM: 2 rows" in out
    assert "'Traction Coeff (-)': it is empty" in out
    scene = Scene.from_toml("mtm_zddp")
    data = read(Path("ehd_data.csv"), scene, "regression")
    assert sorted(data.value) == approx([50e-9, 80e-9], rel=1e-9)
    for test, speed in zip(sorted(data.tests, key=lambda test: test.speed_1), (0.1, 0.2), strict=True):
        assert (test.speed_1, test.speed_2) == approx((speed, speed), rel=1e-9)  # pure rolling, but for the rig's noise
        assert (test.load, test.temperature) == approx((20.0, 313.25), rel=1e-9)


def test_ball_and_disc_speeds_say_which_body_is_the_faster_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("mtm.txt").write_text(RUBBED.format(kind="BOD_TIMED", rows=BALL), "utf-8")
    assert main(["log", "mtm.txt"]) == 0
    assert "makes body 2 the faster one, as ball and disc speeds" in capsys.readouterr().out
    (point,) = Duty.from_csv("mtm_duty.csv", Scene.from_toml("mtm_zddp").operation.point).points
    assert (point.load, point.speed_1, point.speed_2) == approx((30.1, 0.05, 0.15), rel=1e-9)
    assert point.temperature == approx(373.25, rel=1e-9)
    assert main(["log", "mtm.txt", "--faster", "1", "--force"]) == 0
    (point,) = Duty.from_csv("mtm_duty.csv", Scene.from_toml("mtm_zddp").operation.point).points
    assert (point.speed_1, point.speed_2) == approx((0.15, 0.05), rel=1e-9)


def test_a_pin_stands_still_and_has_its_own_column_of_load(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("pin.txt").write_text(RUBBED.format(kind="POD_TIMED", rows=PIN), "utf-8")
    assert main(["log", "pin.txt"]) == 0
    assert "Body 1 is the pin" in capsys.readouterr().out
    header, row = Path("pin_duty.csv").read_text().splitlines()
    assert dict(zip(header.split(","), row.split(","), strict=True)) == {
        "time [s]": "0", "load [N]": "12", "speed_1 [m/s]": "0", "speed_2 [m/s]": "0.2", "temperature [degC]": "100.1"
    }  # fmt: skip
    Path("pin.txt").write_text(RUBBED.format(kind="TIMED", rows=PIN), "utf-8")
    assert main(["log", "pin.txt", "--force"]) == 2
    assert "neither a rolling speed nor a slide-to-roll ratio" in capsys.readouterr().err
    assert main(["log", "pin.txt", "--srr", "200 %", "--faster", "2", "--force"]) == 0
    assert Path("pin_duty.csv").read_text().splitlines()[1].split(",")[2:4] == ["0", "0.2"]


def test_images_of_a_mapper_are_named_as_what_they_are(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("map.txt").write_text("SLIM Mapper Analysis File\nX\tY\tR\tG\tB\tFilm\n0\t5\t7\t5\t1\t130.0\n")
    assert main(["log", "map.txt"]) == 2
    assert "Film=tribofilm_1 [nm]" in capsys.readouterr().err


MARKS = st.sampled_from(["-9", "-999", "1e30", "1e400", "-1e30", "", "9999999999"])


@given(
    st.lists(st.tuples(*4 * [st.one_of(MARKS, st.floats(0.001, 90.0).map("{:.4g}".format))]), min_size=2, max_size=9)
)
def test_marks_of_what_was_not_measured_reach_neither_duty_nor_data(cells) -> None:
    head = "Time (s),Load (N),Friction Coefficient,Oil Temp (degC),Mean Speed (m/s),SRR (%)"
    lines = [f"{k},{load},{friction},{oil},{speed},5" for k, (load, friction, oil, speed) in enumerate(cells)]
    scene = Scene.from_toml("mtm_zddp")
    with TemporaryDirectory() as folder:
        file = Path(folder) / "log.csv"
        file.write_text("\n".join([head, *lines]))
        rows = log_tables.rows_of(log_file.read(file, {}), [], None, None)
        duty, data = log_tables.duty(rows), log_tables.data(rows)
        if duty:  # refuses what is out of range
            Duty.from_csv(log_tables.write(duty, Path(folder) / "duty.csv"), scene.operation.point)
        if data:
            read(log_tables.write(data, Path(folder) / "data.csv"), scene, "regression")
    friction = [float(row[1]) for row in cells if row[1]]
    kept = [row.measured["friction_coefficient"] for row in rows if "friction_coefficient" in row.measured]
    assert set(kept) <= {value for value in friction if 0.0 <= value <= 10.0}


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        (
            "0,-8,0.1\n1,50,0.1\n2,50,0.1\n",
            "'Load (N)': cells that are not from 0 to 100000 N, as load is, count as not measured: 1, such as -8.",
        ),
        ("0,-9,0.1\n1,50,0.1\n2,50,0.1\n", "speed or temperature that the contact takes are left out: 1."),
        ("0,50,1e30\n1,50,-0.1\n2,50,0.1\n", "as friction_coefficient is, count as not measured: 2, such as 1e30."),
        ("-8,50,0.1\n1,50,0.1\n2,50,0.1\n", "as time is, count as not measured: 1, such as -8."),
        ("0,50,-9\n1,50,0.1\n2,50,-99\n", "-9 among numbers that are not negative counts as not measured: 2."),
        *(
            (f"0,50,0.1\n{line}\n2,50,0.1\n3,50,0.1\n", f"passed over: 1, such as '{line}'.\n")
            for line in ("nan,50,0.1", ",50,0.1", "OVER,OL,0.2", "Paused by operator", "# pause", "nan,nan,nan")
        ),
        ("0,50,0.1\n1,50,0.1\n\nUnknown,Header\n1,2\n3,4\n", "passed over: 2, such as '1,2'."),
    ],
)
def test_cells_that_cannot_have_been_measured_are_counted(
    rows: str, said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("rig.csv").write_text(f"Time (s),Load (N),Friction Coefficient\n{rows}")
    assert main(["log", "rig.csv"]) == 0
    assert said in capsys.readouterr().err


RIG = "Time (s);Load (N);Friction Coefficient;Oil Temp (degC);Mean Speed (mm/s);SRR (%)"


@pytest.mark.parametrize(
    ("head", "times"),
    [
        (RIG.replace("Time (s)", "Time"), ["00:00:00", "00:00:30", "00:02:00"]),
        (RIG.replace("Time (s)", "Time"), ["00:00:00,0", "00:00:30,0", "00:02:00,0"]),
        (RIG, ["0", "30", "120"]),
        (
            "Time;Load;Friction Coefficient;Oil Temp;Mean Speed;SRR\ns;N;-;°C;mm/s;%",
            ["0", "30", "120"],
        ),
        (
            "Time;Load (N);Friction Coefficient;Oil Temp;Mean Speed;SRR\n[min];;;[degC];[mm/s];[%]",
            ["0", "0,5", "2"],
        ),
    ],
)
def test_a_clock_and_a_line_of_units_are_read(
    head: str, times: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    rows = [f"{time};{load};0,1;80;100;5" for time, load in zip(times, (50, 50, 60), strict=True)]
    Path("rig.csv").write_text("\n".join([head, *rows]), "utf-8")
    assert main(["log", "rig.csv"]) == 0
    duty = Duty.from_csv("rig_duty.csv", Scene.from_toml("mtm_zddp").operation.point)
    assert duty.times == (0.0, 120.0)
    assert [p.load for p in duty.points] == [50.0, 60.0]
    assert (duty.points[0].speed_1, duty.points[0].temperature) == approx((0.1025, 353.15), rel=1e-9)


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ("0,50\n1,60\n0,70\n1,80\n", "No duty: the time falls back from 1 s to 0 s, as in another test. Make a log"),
        ("0,50\n1,60\n1,70\n", "No duty: inputs change at 1 s, and again at that time."),
        ("0,50\n0,60\n", "No duty: inputs change, but there is no column of time"),
    ],
)
def test_why_there_is_no_duty_is_told(
    rows: str, said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    lines = [f"{row},0.1" for row in rows.split()]
    Path("rig.csv").write_text("\n".join(["Time (s),Load (N),Friction Coefficient", *lines]))
    assert main(["log", "rig.csv"]) == 0
    assert said in capsys.readouterr().err
    assert not Path("rig_duty.csv").exists()


def test_data_to_fit_have_a_range_too(tmp_path: Path) -> None:
    (tmp_path / "data.csv").write_text("time [s],friction_coefficient [1]\n0,0.1\n1,1e30\n")
    with pytest.raises(SceneError, match=r"friction_coefficient = 1e\+30 .* at most 10"):
        read(tmp_path / "data.csv", Scene.from_toml("mtm_zddp"), "regression")
    (tmp_path / "data.csv").write_text("time [s],friction_coefficient [1]\n0,0.1\n1,-9\n2,-0.01\n")
    with pytest.raises(SceneError, match="friction_coefficient = -9 is further below 0 than any other is above it"):
        read(tmp_path / "data.csv", Scene.from_toml("mtm_zddp"), "regression")
