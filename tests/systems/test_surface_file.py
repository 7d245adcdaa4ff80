"""`tribofmu surface-file`: files of instruments become a set that a scene takes."""

import hashlib
import re
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
<CY><AxisType>I</AxisType><DataType>D</DataType><Increment>{across}</Increment><Offset>0</Offset></CY>
<CZ><AxisType>A</AxisType><DataType>D</DataType></CZ></Axes></Record1>
<Record2><Date>2024-01-02T03:04:05</Date><Instrument><Manufacturer>Maker</Manufacturer><Model>Confocal</Model>
<Serial>7</Serial><Version>1</Version></Instrument></Record2>
<Record3><MatrixDimension><SizeX>{nx}</SizeX><SizeY>{ny}</SizeY><SizeZ>1</SizeZ></MatrixDimension>
<DataLink><PointDataLink>bindata/data.bin</PointDataLink></DataLink></Record3></p:ISO5436_2>"""


def heights() -> np.ndarray:
    x = (np.arange(64) + 0.5) * STEP
    return np.tile(20e-9 * np.cos(2.0 * np.pi * x / 8e-6), (48, 1))


def x3p(path: Path, z: np.ndarray, step: float = STEP, across: float = STEP) -> None:
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("main.xml", MAIN.format(step=step, across=across, nx=z.shape[1], ny=z.shape[0]))
        archive.writestr("bindata/data.bin", z.astype("<f8").tobytes())


def sdf(path: Path, z: np.ndarray, step: float = STEP, across: float = STEP) -> None:
    head = {
        "ManufacID": "Maker", "CreateDate": "020120240304", "ModDate": "020120240304", "NumPoints": z.shape[1],
        "NumProfiles": z.shape[0], "Xscale": step, "Yscale": across, "Zscale": 1e-9, "Zresolution": -1,
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


def ball(nx: int, ny: int, dx: float, dy: float) -> tuple[np.ndarray, np.ndarray]:
    """Roughness of some waves, and the same on a tilted ball of 10 mm, [ny, nx]."""
    x, y = (np.arange(nx) + 0.5) * dx, (np.arange(ny) + 0.5) * dy
    waves = [(5, 3, 40e-9), (0, 8, 25e-9), (9, 0, 30e-9), (7, 7, 15e-9)]
    z = sum(a * np.outer(np.cos(np.pi * m * y / (ny * dy)), np.cos(np.pi * n * x / (nx * dx))) for n, m, a in waves)
    return z, z - ((x - 3e-5) ** 2)[None] / 2e-2 - ((y - 3e-5) ** 2)[:, None] / 2e-2 + 2e-3 * x[None] - 1e-3 * y[
        :, None
    ]


@pytest.mark.parametrize("kind", ["x3p", "sdf", "nc", "npy", "xyz", "csv"])
def test_the_roughness_that_is_in_a_file_comes_out_of_every_format(
    kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from SurfaceTopography import Topography

    (tmp_path / "measured").mkdir()
    monkeypatch.chdir(tmp_path)
    rough, z = ball(96, 64, 1e-6, 1.5e-6)  # pixels that are no squares
    file, given = Path(f"measured/disc.{kind}"), list[str]()
    if kind == "x3p":
        x3p(file, z, 1e-6, 1.5e-6)
    elif kind == "sdf":
        sdf(file, z, 1e-6, 1.5e-6)
    elif kind == "nc":  # in ångström
        Topography(1e10 * z.T, (96e4, 96e4), unit="Å", periodic=False).to_netcdf(str(file))
    elif kind == "npy":
        np.save(file, z)
        given = ["--unit", "m", "--size", "96 um", "96 um"]
    elif kind == "xyz":  # some places are left out
        y, x = (index.ravel() for index in np.indices(z.shape))
        rows = np.c_[x + 0.5, 1.5 * (y + 0.5), 1e6 * z.ravel()]
        np.savetxt(file, np.delete(rows, [7, 900, 4001], axis=0))
        given = ["--unit", "um"]
    else:  # decimal commas
        file.write_text("\n".join(";".join(f"{1e6 * v:.8f}".replace(".", ",") for v in row) for row in z))
        given = ["--unit", "um", "--size", "96 um", "96 um"]
    assert (
        main(["surface-file", str(file), "--form", "curvature", *given, "--longest", "90 um", "--shortest", "6 um"])
        == 0
    )
    patch, said = np.load("disc.npy"), Path("disc.toml").read_text()
    assert patch.shape == (32, 32)
    # the least-squares form takes a little of long waves; of the three missing points their fill
    assert patch.std() == approx(1e9 * rough.std(), rel=3e-3)
    assert "longer than 90 um, shorter than 6 um" in said
    slopes = re.search(r"slopes (\S+) and (\S+) um/mm .*?, radii of curvature (\S+) mm, (\S+) mm", said)
    assert slopes is not None
    # at the middle of the image, 18 um off the top of the ball: 2e-3 - 18e-6 / 10e-3
    found = [float(each) for each in slopes.groups()]
    assert found[:2] == approx([0.2, -2.8], abs=0.02)
    assert found[2:] == approx([10.0, 10.0], rel=0.05)  # waves have a little curvature, too
    assert "1 by 1.5 um apart" in said


def test_several_files_make_an_ensemble_that_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    for name, height in (("one", 1.0), ("two", 1.4)):
        x3p(Path(f"{name}.x3p"), height * ball(96, 96, STEP, STEP)[0], STEP, STEP)
    assert main(["surface-file", "one.x3p", "two.x3p"]) == 0
    out = capsys.readouterr().out
    assert 'files = ["one.toml", "two.toml"]' in out
    setting = re.search(r"by --set (\S+)", out)
    assert setting is not None
    quick = ["film.model=regression", "operation.duration=1 min"]
    assert main(["run", "mtm_zddp", "--set", setting[1], *quick, "--out", "both"]) == 0
    assert "Ensemble of 2 surfaces (surface_2.files): one.toml, two.toml." in capsys.readouterr().out
    assert main(["surface-file", "one.x3p", "two.x3p", "--out", "disc"]) == 0
    assert Path("disc_1.toml").exists() and Path("disc_2.npy").exists()
    Path("sub").mkdir()
    Path("one.x3p").rename("sub/two.x3p")
    assert main(["surface-file", "two.x3p", "sub/two.x3p"]) == 2
    assert "Give --out NAME" in capsys.readouterr().err


def test_the_measured_file_is_never_replaced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    np.save("disc.npy", heights())
    before = Path("disc.npy").read_bytes()
    assert main(["surface-file", "disc.npy", "--unit", "m", "--size", "32 um", "24 um"]) == 2
    assert "itself would be replaced" in capsys.readouterr().err
    assert Path("disc.npy").read_bytes() == before
