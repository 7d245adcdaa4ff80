"""The duty of a machine becomes the schedule that the master takes."""

import math
import tomllib
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from comparison import approx
from hypothesis import given
from hypothesis import strategies as st

from contact_core import OperatingPoint, SceneError
from contact_core.quantities import Quantity
from system_models.machines import timeline
from system_models.machines.files import shipped_files
from system_models.machines.timeline import Timeline
from system_models.run.duty import Duty

POINT = OperatingPoint(load=50.0, speed_1=0.1, speed_2=0.2, temperature=350.0)
SIGNALS = {
    "speed": Quantity("speed", "n", "rad/s", "speed of the shaft", "input", display="rpm"),
    "load": Quantity("load", "F", "N", "radial load", "input", minimum=0.0, maximum=2e4),
}
RPM = 2.0 * math.pi / 60.0


def read(text: str, folder: Path = Path()) -> Timeline:
    return timeline.read(tomllib.loads(text)["duty"], SIGNALS, folder)


def test_a_constant_duty_is_one_value_until_the_end() -> None:
    duty = read('[duty]\nduration = "2 h"\nspeed = "1500 rpm"\nload = "2 kN"')
    assert duty.end == 7200.0
    assert duty.schedule({"speed": "drive.speed_setpoint"}) == {
        "drive.speed_setpoint": [(0.0, approx(1500.0 * RPM, rel=1e-15))],
        "load": [(0.0, 2000.0)],
    }


STEPS = """
[duty]
duration = "20 min"
speed = "10 rad/s"
load = "1 kN"
[[duty.steps]]
time = "5 min"
speed = "20 rad/s"
[[duty.steps]]
time = "10 min"
speed = "20 rad/s"
load = "0 N"
"""


def test_a_step_changes_what_it_names() -> None:
    duty = read(STEPS)
    assert duty.end == 1200.0
    assert duty.schedule() == {"speed": [(0.0, 10.0), (300.0, 20.0)], "load": [(0.0, 1000.0), (600.0, 0.0)]}


def test_a_repetition_begins_as_the_first_time() -> None:
    duty = read(STEPS.replace("[duty]", "[duty]\nrepeat = 3"))
    assert duty.end == 3600.0
    assert duty.course("speed") == [(k * 1200.0 + t, v) for k in range(3) for t, v in ((0.0, 10.0), (300.0, 20.0))]


def test_rows_can_be_had_with_all_signals() -> None:
    assert [values for _, values in read(STEPS).filled()] == [
        {"speed": 10.0, "load": 1000.0},
        {"speed": 20.0, "load": 1000.0},
        {"speed": 20.0, "load": 0.0},
    ]


@pytest.mark.parametrize("signals", ['["speed"]', '"speed"'])
def test_start_stop_cycles_run_and_stand(signals: str) -> None:
    duty = read(
        '[duty]\nspeed = "10 rad/s"\nload = "1 kN"\nrepeat = 2\n'
        'start_stop = { signals = SIGNALS, run = "1 min", standstill = "30 s" }'.replace("SIGNALS", signals)
    )
    assert duty.end == 180.0
    assert duty.schedule() == {
        "speed": [(0.0, 10.0), (60.0, 0.0), (90.0, 10.0), (150.0, 0.0)],
        "load": [(0.0, 1000.0)],
    }


def write(folder: Path, text: str) -> Path:
    (folder / "cycle.csv").write_text(text, encoding="utf-8")
    return folder


TABLE = "time [min],speed [rpm]\n0,60\n1,120\n2,0\n"


def test_a_table_ends_at_its_last_row_and_leaves_other_signals_as_they_are(tmp_path: Path) -> None:
    duty = read('[duty]\nfile = "cycle.csv"\nload = "5 N"\nspeed = "1 rad/s"', write(tmp_path, TABLE))
    assert duty.end == 120.0
    speeds = [(0.0, approx(2.0 * math.pi)), (60.0, approx(4.0 * math.pi))]
    assert duty.schedule() == {"load": [(0.0, 5.0)], "speed": speeds}


def test_a_duration_holds_the_last_row(tmp_path: Path) -> None:
    duty = read('[duty]\nfile = "cycle.csv"\nduration = "3 min"', write(tmp_path, TABLE))
    assert duty.end == 180.0
    assert duty.course("speed")[-1] == (120.0, 0.0)


TIMES = st.lists(st.integers(1, 50), max_size=5, unique=True).map(sorted)


@given(TIMES, st.integers(1, 3), st.sampled_from([0, 9]), st.integers(1, 300))
def test_each_row_of_a_table_holds_until_the_next_as_long_as_the_simulation(times, repeat, longer, stop):
    with TemporaryDirectory() as folder:
        lines = [f"{time},{k}" for k, time in enumerate([0, *times])]
        (Path(folder) / "table.csv").write_text("\n".join(["time [s],load [N]", *lines]))
        end = (times[-1] if times else stop) + longer
        table = {"file": "table.csv", "repeat": repeat} | ({"duration": f"{end} s"} if longer else {})
        course = timeline.read(table, SIGNALS, Path(folder), stop=float(stop)).course("load")
        scene = Duty.from_csv(Path(folder) / "table.csv", POINT)
    assert [time for time, _ in course] == sorted({time for time, _ in course})
    for time in range(stop):
        held = [value for at, value in course if at <= time][-1]
        within = time % end if time < repeat * end else end  # the last row holds once all is done
        assert held == scene.at(within).load


def test_a_table_of_one_row_holds_as_long_as_the_simulation_or_is_refused(tmp_path: Path) -> None:
    folder = write(tmp_path, "time [s],load [N]\n0,1\n")
    assert timeline.read({"file": "cycle.csv"}, SIGNALS, folder, stop=9.0).schedule() == {"load": [(0.0, 1.0)]}


def test_a_file_takes_the_place_of_steps_and_cycles(tmp_path: Path) -> None:
    table = timeline.with_file(tomllib.loads(STEPS)["duty"], write(tmp_path, TABLE) / "cycle.csv")
    assert timeline.read(table, SIGNALS, Path()).schedule()["load"] == [(0.0, 1000.0)]


def test_the_shipped_cycle_runs_ten_minutes_with_standstills() -> None:
    folder = Path(str(shipped_files()["bearing_209"])).parent
    duty = read('[duty]\nfile = "drive_cycle.csv"', folder)
    assert duty.end == 600.0
    speeds = duty.course("speed")
    assert sum(speed == 0.0 for _, speed in speeds) >= 4
    assert max(speed for _, speed in speeds) == approx(3200.0 * RPM)
    assert {time % 5.0 for time, _ in speeds} == {0.0}


START = '[duty]\nduration = "9 s"\nspeed = "1 rad/s"\n'
CYCLES = '[duty]\nspeed = "1 rad/s"\n'


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('[duty]\nspeed = "1 rad/s"', r"'duty\.duration' is missing\. Write for example"),
        ("[duty]\nduration = 5", r"duty\.duration = 5 has no unit\. Write for example '1\.0 s'"),
        ('[duty]\nduration = "0 s"', r"duty\.duration = '0 s' must be above 0"),
        (START + 'lod = "1 N"', r"\[duty\] has no 'lod'\. Did you mean 'load'\? Known are speed, load, duration"),
        (START + 'load = "-1 N"', r"In \[duty\]: load = -1 N \(radial load\) must be at least 0 and at most 20000 N"),
        (START + 'load = "1 rpm"', r"duty\.load = '1 rpm' has the wrong unit: it must be convertible to N"),
        (START + "steps = 3", r"duty\.steps must be a list of tables\. Write \[\[duty\.steps\]\]"),
        (START + '[[duty.steps]]\nspeed = "2 rad/s"', r"'duty\.steps\[0\]\.time' is missing"),
        (START + '[[duty.steps]]\ntime = "9 s"', r"duty\.steps\[0\]\.time = 9 s must come after the 0 s before it"),
        (START + '[[duty.steps]]\ntime = "1 s"\nload = "1 N"', r"changes 'load', which has no value at the start"),
        (START + '[[duty.steps]]\ntime = "1 s"\nfile = "a"', r"\[duty\.steps\[0\]\] has no 'file'"),
        (START + 'steps = []\nfile = "a.csv"', r"\[duty\] has steps and file\. Keep one"),
        (START + "repeat = 0", r"duty\.repeat = 0 must be a whole number from 1 to"),
        (START + 'repeat = "1.5"', r"duty\.repeat = '1\.5' must be a whole number from 1 to"),
        (CYCLES + "start_stop = 3", r"duty\.start_stop must be a table with signals, run, standstill"),
        (CYCLES + 'start_stop = { run = "1 s", standstill = "1 s" }', r"must be a table with signals, run, standstill"),
        (
            CYCLES + 'start_stop = { signals = ["sped"], run = "1 s", standstill = "1 s" }',
            r"signals names 'sped', which has no value in \[duty\]\. Did you mean 'speed'\?",
        ),
        (
            START + 'start_stop = { signals = ["speed"], run = "1 s", standstill = "1 s" }',
            r"start_stop and duration\. Leave the duration out",
        ),
        ('[duty]\nfile = "nowhere.csv"', r"The duty file 'nowhere\.csv' cannot be read"),
    ],
)
def test_what_cannot_be_is_refused_with_a_way_out(text: str, said: str) -> None:
    with pytest.raises(SceneError, match=said):
        read(text)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "time [s],sped [rpm]\n0,1\n",
            r"line 1: there is no column 'sped'\. Did you mean 'speed'\? Known are time, sp",
        ),
        ("time [s],load [rpm]\n0,1\n", r"line 1: load = '1\.0 rpm' has the wrong unit: .* convertible to N"),
        (
            "time [s],load [N]\n0,1\n3,3e4\n",
            r"line 3, column 'load \[N\]', value '3e4': load = 30000 N .* at most 20000",
        ),
        ("time [s],load [N]\n0,1\n", r"cycle\.csv' has one row only\. Add one at the end"),
    ],
)
def test_a_bad_table_is_refused_with_file_line_and_value(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(SceneError, match=said):
        read('[duty]\nfile = "cycle.csv"', write(tmp_path, text))


def test_a_duration_does_not_cut_a_table_off(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"duration = 60 s, but the duty file '.*' lasts to 120 s\. Make it longer"):
        read('[duty]\nfile = "cycle.csv"\nduration = "1 min"', write(tmp_path, TABLE))


def test_a_missing_signal_is_named() -> None:
    with pytest.raises(
        SceneError, match=r"'duty\.speed' is missing\. Write in \[duty\] for example speed = \"10 rpm\""
    ):
        timeline.read({"duration": "1 s", "load": "1 N"}, SIGNALS, Path(), needed=("load", "speed"))
