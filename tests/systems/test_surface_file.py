"""`tribofmu surface-file`: files of instruments become a set that a scene takes."""

import hashlib
import zipfile
from pathlib import Path

import numpy as np
import pytest
from comparison import approx

from system_models.cli.main import main

pytest.importorskip("SurfaceTopography", reason="the extra `surfaces` is not installed")

STEP = 0.5e-6
MAIN = """<?xml version="1.0" encoding="UTF-8"?>
<p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/ISO5436_2"><Record1><Revision>ISO5436 - 2000</Revision>
<FeatureType>SUR</FeatureType><Axes>
<CX><AxisType>I</AxisType><DataType>D</DataType><Increment>{step}</Increment><Offset>0</Offset></CX>
<CY><AxisType>I</AxisType><DataType>D</DataType><Increment>{step}</Increment><Offset>0</Offset></CY>
<CZ><AxisType>A</AxisType><DataType>D</DataType></CZ></Axes></Record1>
<Record2><Date>2024-01-02T03:04:05</Date><Instrument><Manufacturer>Maker</Manufacturer><Model>Confocal</Model>
<Serial>7</Serial><Version>1</Version></Instrument></Record2>
<Record3><MatrixDimension><SizeX>{nx}</SizeX><SizeY>{ny}</SizeY><SizeZ>1</SizeZ></MatrixDimension>
<DataLink><PointDataLink>bindata/data.bin</PointDataLink></DataLink></Record3></p:ISO5436_2>"""


def heights() -> np.ndarray:
    x = (np.arange(64) + 0.5) * STEP
    return np.tile(20e-9 * np.cos(2.0 * np.pi * x / 8e-6), (48, 1))


def x3p(path: Path, z: np.ndarray) -> None:
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("main.xml", MAIN.format(step=STEP, nx=z.shape[1], ny=z.shape[0]))
        archive.writestr("bindata/data.bin", z.astype("<f8").tobytes())


def sdf(path: Path, z: np.ndarray) -> None:
    head = {
        "ManufacID": "Maker", "CreateDate": "020120240304", "ModDate": "020120240304", "NumPoints": z.shape[1],
        "NumProfiles": z.shape[0], "Xscale": STEP, "Yscale": STEP, "Zscale": 1e-9, "Zresolution": -1,
        "Compression": 0, "DataType": 7, "CheckType": 0,
    }  # fmt: skip
    rows = "\n".join(" ".join(f"{1e9 * value:.9f}" for value in row) for row in z)
    path.write_text("aISO-1.0\n" + "".join(f"{k} = {v}\n" for k, v in head.items()) + f"*\n{rows}\n*\n*\n")


@pytest.mark.parametrize(("write", "name"), [(x3p, "disc.x3p"), (sdf, "disc.sdf")])
def test_heights_axes_and_missing_points_are_those_of_the_file(
    write, name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    write(Path(name), heights())
    assert main(["surface-file", name, "--form", "none"]) == 0
    out = capsys.readouterr().out
    z = np.load("disc.npy")
    assert z == approx(1e9 * heights(), abs=1e-5)
    assert hashlib.sha256(Path(name).read_bytes()).hexdigest() in out
    assert "32 by 24 um, 64 by 48 points" in out
    assert "Sq 14.14 nm" in Path("disc.toml").read_text()
    assert main(["surface-file", name, "--form", "none", "--along", "y", "--out", "across"]) == 0
    assert np.load("across.npy") == approx(z.T, rel=1e-12)


def test_gaps_of_a_file_are_counted_and_the_instrument_is_recorded(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    z = heights()
    z[10:16, 20:28] = np.nan
    x3p(Path("disc.x3p"), z)
    assert main(["surface-file", "disc.x3p", "--out", "gaps", "--shortest", "4 um"]) == 0
    said = Path("gaps.toml").read_text()
    assert "points without a height: 1.56 %" in said
    assert "Confocal" in said and "2024-01-02" in said
    assert main(["surfaces", "mtm_zddp", "--set", "surface_2.set=gaps.toml:gaps"]) == 0


def test_a_file_without_unit_or_size_is_asked_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    np.savetxt("plain.txt", 1e6 * heights())
    assert main(["surface-file", "plain.txt"]) == 2
    assert "--unit" in capsys.readouterr().err
    assert main(["surface-file", "plain.txt", "--unit", "um"]) == 2
    assert "--size" in capsys.readouterr().err
    assert main(["surface-file", "plain.txt", "--unit", "um", "--size", "32 um", "24 um", "--form", "none"]) == 0
    assert np.load("plain.npy") == approx(1e9 * heights(), abs=1e-9)


def test_what_is_no_surface_is_refused_with_a_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("letter.x3p").write_bytes(b"no surface at all")
    assert main(["surface-file", "letter.x3p"]) == 2
    assert "Export the surface as" in capsys.readouterr().err
