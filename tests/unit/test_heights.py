"""Heights from files and arrays: the same on every grid, sure of their unit, part of a scene's identity."""

import json
import pickle
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from comparison import approx

from contact_core import ContactState, Scene, SceneError, StateError, advance, initial_state, solve
from contact_core.scene import Heights, SelfAffine, statistics_of
from contact_core.scene.height_map import HeightMap
from contact_core.surfaces.laid import laid, shown
from contact_core.surfaces.patches import bare_heights, facing_surfaces

DOMAIN = 0.5e-3
SMOOTH = {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm"}


def heights(array: np.ndarray, spacing: float = 1e-6, beyond: str = "mirrored", unit: str = "m") -> Heights:
    return Heights(spacing, unit, beyond=beyond, digest=HeightMap(array))


def square(given: Heights, points: int) -> np.ndarray:
    return laid(given, (DOMAIN, DOMAIN), (points - 1, points - 1))


def waves(n: int = 500) -> np.ndarray:
    """A periodic texture of 500 um: six waves along, four across, 50 nm."""
    at = 2.0 * np.pi * (np.arange(n) + 0.5) / n
    return 50e-9 * np.sin(6.0 * at)[None, :] * np.cos(4.0 * at)[:, None]


def dimple(n: int = 80, depth: float = 175e-9) -> np.ndarray:
    """Mourier's dimple of 15.5 um on 1 um (Tribol. Int. 39 (2006) 1745), level beyond 18.6 um."""
    at = np.arange(n) - 0.5 * (n - 1)
    r = np.hypot(at[:, None], at[None, :]) / (1.2 * 15.5)
    return np.where(r < 1.0, -depth * np.cos(0.5 * np.pi * r) * np.exp(-2.0 * r**2), 0.0)


def measured(n: int = 300, seed: int = 0) -> np.ndarray:
    """A patch as an instrument gives it: correlated noise, 100 nm rms, that does not close on itself."""
    noise = np.fft.rfft2(np.random.default_rng(seed).normal(size=(2 * n, 2 * n)))
    q = np.hypot(np.fft.fftfreq(2 * n)[:, None], np.fft.rfftfreq(2 * n)[None, :])
    z = np.fft.irfft2(noise * np.exp(-((q * 20.0) ** 2)))[:n, :n]
    return 100e-9 * z / z.std()


def settings(file: str, unit: str = "nm", spacing: str = "1 um", beyond: str = "mirrored", body: int = 2) -> dict:
    return {
        f"surface_{body}.heights.{key}": value
        for key, value in {"file": file, "unit": unit, "spacing": spacing, "beyond": beyond}.items()
    }


@pytest.mark.parametrize("beyond", ["mirrored", "flat", "repeated"])
def test_refining_a_grid_keeps_the_heights_at_shared_nodes_to_the_mean_of_a_cell(beyond):
    """A mean over a cell d wide differs by d^2/24 times the curvature from the value in its middle.

    A mirror has a kink, by the slope at the edge: cells that hold one are left out.
    """
    array = {"mirrored": measured(), "flat": dimple(), "repeated": waves()}[beyond]
    curvature = sum(np.abs(np.diff(array, 2, axis=axis)).max() for axis in (0, 1)) / 1e-6**2
    fine = square(heights(array, beyond=beyond), 513)
    for points in (65, 129, 257):
        nodes = points - 1
        off = np.abs(fine[:: 512 // nodes, :: 512 // nodes] - square(heights(array, beyond=beyond), points))
        smooth = np.arange(nodes) % (nodes // 2) != 0
        assert off[np.ix_(smooth, smooth)].max() < 1.2 * (DOMAIN / nodes) ** 2 / 24.0 * curvature
        assert off.max() < 10.0 / nodes * np.ptp(array)


@pytest.mark.parametrize("points", [65, 129, 257, 1025])
def test_a_node_has_the_mean_of_its_cell(points):
    """The mean of a sine of wavelength L over a cell d is sinc(d / L) times the sine."""
    at = 2.0 * np.pi * np.arange(points - 1) / (points - 1)
    exact = 50e-9 * np.sin(6.0 * at)[None, :] * np.cos(4.0 * at)[:, None]
    exact *= np.sinc(6.0 / (points - 1)) * np.sinc(4.0 / (points - 1))
    assert np.abs(square(heights(waves(), beyond="repeated"), points) - exact).max() < 1e-6 * 50e-9


def test_noise_finer_than_the_grid_is_averaged_and_not_sampled():
    """Of n independent numbers in a cell a mean keeps 1 / sqrt(n), sampling would keep all."""
    noise = np.random.default_rng(1).normal(scale=100e-9, size=(512, 512))
    found = square(heights(noise, DOMAIN / 512, "repeated"), 65)
    assert np.std(found) == approx(100e-9 / 8.0, rel=0.05)


def test_a_wall_between_nodes_adds_no_ridge():
    groove = np.zeros((4, 500))
    groove[:, 237:263] = -1e-6
    found = square(heights(groove, beyond="repeated", unit="m"), 65) + groove.mean()
    assert found.max() < 0.01e-6
    assert found.min() > -1.01e-6


def test_the_volume_is_the_same_on_every_grid():
    volume = dimple().sum() * 1e-12
    for points in (33, 65, 129, 200, 513):
        cell = (DOMAIN / (points - 1)) ** 2
        assert square(heights(dimple(), beyond="flat"), points).sum() * cell == approx(volume, rel=1e-9)


@pytest.mark.parametrize("points", [65, 129, 257])
def test_a_dimple_lies_in_the_middle_of_flat_surroundings(points):
    found = square(heights(dimple(), beyond="flat"), points)
    middle = (points - 1) // 2
    assert np.unravel_index(np.argmin(found), found.shape) == (middle, middle)
    assert np.abs(found[1:, 1:] - found[1:, 1:][::-1, ::-1]).max() < 1e-14  # symmetric
    away = np.hypot(*np.meshgrid(*2 * [np.arange(points - 1) - middle])) * DOMAIN / (points - 1) > 40e-6
    assert np.abs(found[away]).max() < 1e-12


@pytest.mark.parametrize("n", [120, 300, 700], ids=["smaller", "more than half", "larger"])
def test_a_mirrored_patch_closes_without_a_step(n):
    found = square(heights(measured(n)), 513)
    assert np.abs(found[1:, 1:] - found[:0:-1, :0:-1]).max() < 1e-9 * 100e-9
    for axis in (0, 1):
        steps = np.abs(np.diff(np.concatenate([found, np.take(found, [0], axis=axis)], axis=axis), axis=axis))
        assert np.take(steps, -1, axis=axis).max() <= steps.max()
        assert np.take(steps, 255, axis=axis).max() <= steps.max()
    assert abs(found.mean()) < 1e-12 * 100e-9


def test_a_mirrored_patch_shows_the_file_itself():
    """The middle of a file of 250 um: a quarter of the patch is a copy, the others are its mirror images."""
    array = measured(250)
    found = square(heights(array), 501)  # nodes fall on edges between heights: means of four
    copy = found[1:250, 1:250] - found[1:250, 1:250].mean()
    four = 0.25 * (array[1:, 1:] + array[:-1, 1:] + array[1:, :-1] + array[:-1, :-1])
    assert np.abs(copy - (four - four.mean())).max() < 0.06 * 100e-9


def test_a_file_that_ends_goes_on_in_its_mirror_image():
    """A file of 120 um has an edge 120 um into the patch, between two nodes of 1 um."""
    found = square(heights(measured(120)), 501)
    for axis in (0, 1):
        after, before = (np.take(found, np.arange(1, 100) * sign + 120, axis=axis) for sign in (1, -1))
        assert np.abs(after - before).max() < 1e-9 * 100e-9
        assert np.std(np.diff(found, axis=axis)) < 0.3 * np.std(found)  # no step anywhere


def test_tiles_repeat_in_whole_numbers():
    found = square(heights(waves(250), 1e-6, "repeated"), 129)
    assert np.abs(found[:64] - found[64:]).max() < 1e-18
    assert np.abs(found[:, :64] - found[:, 64:]).max() < 1e-18
    assert np.std(found) == approx(25e-9 * np.sinc(12 / 128) * np.sinc(8 / 128), rel=1e-3)


def test_one_row_is_the_same_all_along_y():
    found = square(heights(waves()[:1], beyond="repeated"), 129)
    assert np.array_equal(found[0], found[77])
    found = square(heights(waves()[:, :1], beyond="repeated"), 129)
    assert np.array_equal(found[:, 0], found[:, 77])


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A working folder with a measured patch of 0.3 mm in nm, as csv and npy."""
    numbers = np.round(1e9 * measured(), 2)
    np.save(tmp_path / "patch.npy", numbers)
    np.savetxt(tmp_path / "patch.csv", numbers, delimiter=",", fmt="%.2f", header="in nm; 1 um apart")
    np.savetxt(tmp_path / "german.csv", numbers, delimiter=";", fmt="%.2f")
    np.save(tmp_path / "patch_in_mm.npy", 1e-6 * numbers)
    np.save(tmp_path / "flat.npy", np.zeros((9, 9)))
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_csv_and_an_npy_give_the_same_patch_and_the_same_contact(folder):
    scenes = [Scene.from_toml("azam_case_a", settings(name)) for name in ("patch.npy", "patch.csv", "german.csv")]
    for scene in scenes[1:]:
        assert np.array_equal(bare_heights(scene, 129)[1], bare_heights(scenes[0], 129)[1])
        assert scene.digest() == scenes[0].digest()


def test_heights_come_on_top_of_the_roughness_of_their_body_alone(folder):
    plain, given = (Scene.from_toml("azam_case_a", changes) for changes in ({}, settings("patch.npy")))
    one, two = bare_heights(plain, 129), bare_heights(given, 129)
    assert np.array_equal(one[0], two[0])
    alone = laid(given.surface_2.heights, given.patch_size, (128, 128))
    assert np.abs(two[1][:-1] - one[1][:-1] - alone).max() < 1e-21
    assert given.surface_2.rms == approx(np.hypot(127e-9, given.surface_2.heights.statistics.rms), rel=1e-12)
    assert given.surface_2.length < plain.surface_2.length * 2.0


@pytest.mark.parametrize(
    ("file", "unit"), [("patch_in_mm.npy", "m"), ("patch_in_mm.npy", "um"), ("patch.npy", "um"), ("patch.npy", "mm")]
)
def test_a_wrong_unit_is_refused_with_value_range_and_way_out(folder, file, unit):
    with pytest.raises(SceneError) as error:
        Scene.from_toml("azam_case_a", settings(file, unit))
    said = str(error.value)
    assert f"surface_2.heights.unit = '{unit}' with spacing = 1e-06 m makes the rms " in said
    assert " is plausible. Give the unit of the numbers in the file" in said
    Scene.from_toml("azam_case_a", settings("patch_in_mm.npy", "mm"))


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"file": "nope.npy"}, r"surface_2\.heights\.file = 'nope\.npy' is not there; looked in .* Give its path"),
        ({"file": "patch.txt"}, r"file = 'patch\.txt' cannot be read: its name ends with '\.txt'"),
        ({"file": "words.csv"}, r"file = 'words\.csv' cannot be read: .* Give numbers as \.npy, or as \.csv"),
        ({"file": "objects.npy"}, r"file = 'objects\.npy' cannot be read: .*"),
        ({"file": "several.npy"}, r"several\.npy' cannot be read: it is a \.npz archive; save one of its arrays with"),
        ({"file": "complex.npy"}, r"file = 'complex\.npy' cannot be read: its type is complex128\. Give numbers"),
        ({"file": "holes.npy"}, r"file = 'holes\.npy' has 2 of 400 numbers that are not finite\. Fill them in\."),
        ({"file": "line.npy"}, r"holds numbers of the shape \(20,\); rows and columns are needed"),
        ({"file": "flat.npy"}, r"makes the rms height of the file 0 m; .* for a smooth surface leave heights out"),
        ({"unit": "inch"}, r"surface_2\.heights\.unit = 'inch' is not one of m, mm, um, nm\."),
        ({"spacing": "1 mm"}, r"spacing = 0\.001 m gives 0\.5 heights along .* 4 to 16384 can be used\. Give"),
        ({"spacing": "1"}, r"surface_2\.heights\.spacing = '1' has no unit"),
        ({"beyond": "tiled"}, r"beyond = 'tiled' is not one of mirrored, repeated, flat"),
        ({"beyond": "repeated"}, r"heights\.beyond = 'repeated': 1\.67 tiles of 0\.0003 m .* of 0\.0006 m, or beyond"),
        ({"beyond": "flat"}, r"heights\.beyond = 'flat': the edge of the file is not level; .* Level the file"),
        ({"beyond": "flat", "spacing": "3 um"}, r"the file is 0\.0009 m long along y, the patch 0\.0005 m\. Use a"),
        ({"digest": "0123456789abcdef0"}, r"patch\.npy' holds other numbers than before: their digest is .* Restore"),
    ],
)
def test_heights_that_cannot_be_used_are_refused_with_a_way_out(folder, changes, said):
    holes = np.ones((20, 20))
    holes[3, 4:6] = np.nan
    np.save("holes.npy", holes)
    np.save("line.npy", np.ones(20))
    np.save("complex.npy", np.ones((20, 20), dtype=complex))
    with Path("several.npy").open("wb") as archive:
        np.savez(archive, one=np.ones((20, 20)), two=np.ones((20, 20)))
    np.save("objects.npy", np.array([[{}, 1], [2, 3]], dtype=object), allow_pickle=True)
    Path("patch.txt").write_text("1,2\n3,4\n")
    Path("words.csv").write_text("x,y\n3,4\n")
    given = settings("patch.npy") | {f"surface_2.heights.{key}": value for key, value in changes.items()}
    with pytest.raises(SceneError, match=said):
        Scene.from_toml("azam_case_a", given)


def test_the_side_that_does_not_fit_is_named():
    given = heights(dimple(300), 1e-6, "flat")
    for size, words in (((400e-6, 200e-6), "long along x, the patch 0.0002 m"), ((200e-6, 400e-6), "long along y")):
        (said,) = given.errors(size)  # along y and x
        assert words in said


def test_a_file_lies_beside_the_scene_wherever_it_is_read_from(folder, monkeypatch):
    scene = Path(__file__).parents[2] / "contact_core" / "data" / "scenes" / "azam_case_a.toml"
    given = '[surface_2.heights]\nfile = "patch.csv"\nspacing = "1 um"\nunit = "nm"\n\n[lubricant]'
    (folder / "mine.toml").write_text(scene.read_text("utf-8").replace("[lubricant]", given))
    (folder / "elsewhere").mkdir()
    monkeypatch.chdir(folder / "elsewhere")
    found = Scene.from_toml(folder / "mine.toml")
    assert found.digest() == Scene.from_toml("azam_case_a", settings("../patch.npy")).digest()


def test_a_scene_with_heights_goes_through_its_table_json_and_pickle(folder):
    scene = Scene.from_toml("azam_case_a", settings("patch.npy"))
    assert Scene.from_dict(scene.to_dict()) == scene
    table = json.loads(json.dumps(scene.to_dict()))
    assert len(table["surface_2"]["heights"]["digest"]) == 64
    assert Scene.from_dict(table, folder) == scene
    assert pickle.loads(pickle.dumps(scene)) == scene
    Path("patch.npy").write_bytes(Path("patch_in_mm.npy").read_bytes())
    with pytest.raises(SceneError, match=r"surface_2\.heights\.file = 'patch\.npy' holds other numbers than before"):
        Scene.from_dict(table, folder)
    assert Scene.from_dict(scene.to_dict()) == scene  # the record has its numbers


def test_other_heights_are_another_contact(folder):
    scene = Scene.from_toml("azam_case_a", {"film.points": "65", **SMOOTH}).at_level("regression")
    one, two = (scene.with_heights(2, measured(seed=seed), 1e-6) for seed in (1, 2))
    assert len({s.digest() for s in (scene, one, two, one.with_heights(2, measured(seed=1), 1.1e-6))}) == 4
    state, _ = advance(one, one.operation.point, initial_state(one), 60.0)
    again = ContactState.from_bytes(state.to_bytes(), one)
    assert np.array_equal(facing_surfaces(one, again).heights, facing_surfaces(one, state).heights)
    with pytest.raises(StateError, match="belongs to another contact"):
        ContactState.from_bytes(state.to_bytes(), two)


def test_an_array_is_copied_and_checked():
    array = measured()
    scene = Scene.from_toml("azam_case_a").with_heights(1, array, 1e-6)
    before = scene.surface_1.heights.values.copy()
    array[:] = 0.0
    assert np.array_equal(scene.surface_1.heights.values, before)
    assert scene.realisation(3).surface_1.heights == scene.surface_1.heights
    with pytest.raises(SceneError, match=r"body = 3 must be 1 or 2\."):
        scene.with_heights(3, array, 1e-6)
    with pytest.raises(SceneError, match=r"surface_1\.heights holds numbers of the shape \(7,\)"):
        scene.with_heights(1, np.ones(7), 1e-6)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"heights": [[1.0, 2.0], [3.0]]}, "surface_2.heights cannot be used: its rows are of unequal length. Give"),
        ({"heights": measured() * 1j}, "surface_2.heights cannot be used: its type is complex128. Give real numbers"),
        ({"spacing": "8"}, "surface_2.heights.spacing = '8' has no unit. Write for example '20 nm' or '10 mm'."),
        ({"spacing": None}, "surface_2.heights.spacing = None is not a number. Write for example '20 nm' or '10 mm'."),
        ({"spacing": np.nan}, "surface_2.heights.spacing = nan m"),
        ({"unit": 1e-9}, "surface_2.heights.unit = 1e-09 is not one of m, mm, um, nm."),
        ({"beyond": True}, "surface_2.heights.beyond = True is not one of mirrored, repeated, flat."),
    ],
)
def test_arrays_that_cannot_be_used_are_refused_with_a_way_out(changes, said):
    given = {"heights": measured(), "spacing": 1e-6} | changes
    with pytest.raises(SceneError, match=re.escape(said)):
        Scene.from_toml("azam_case_a").with_heights(2, **given)


def test_the_spacing_of_an_array_is_a_number_in_metres_or_text_with_a_unit():
    scene = Scene.from_toml("azam_case_a")
    asked = scene.with_heights(2, measured(), 1e-6)
    assert scene.with_heights(2, measured(), "1 um") == asked == scene.with_heights(2, measured(), np.float64(1e-6))


def test_a_smooth_line_with_heights_is_solved_in_all_its_rows():
    line = Scene.from_toml("fzg_flank", SMOOTH | {"film.width": "0 mm"})
    assert line.rows == 1
    given = line.with_heights(1, dimple(), line.film.domain / 200, beyond="flat")
    assert given.rows == given.film.points - 1
    assert bare_heights(given, given.rows)[0].shape == (given.rows, given.film.points - 1)


ROLLER = {"geometry.model": "roller", "geometry.profile.model": "logarithmic", "geometry.profile.depth": "0.5 um"}
SHAPES = {
    "circle": ("azam_case_a", {}),
    "ellipse": ("ball_209_inner", {"film.width": "3 mm"}),
    "line": ("fzg_flank", {}),
    "roller": ("fzg_flank", {"geometry.face_width": "0.8 mm", "film.width": "1 mm", "operation.load": "40 N"} | ROLLER),
}


@pytest.mark.parametrize("body", [1, 2])
@pytest.mark.parametrize("shape", SHAPES)
def test_every_shape_takes_heights_on_either_body_and_keeps_them_on_finer_grids(shape, body):
    found = []
    for points in ("65", "129"):
        scene = Scene.from_toml(SHAPES[shape][0], {"film.points": points} | SMOOTH | SHAPES[shape][1])
        given = scene.with_heights(body, measured(200), scene.film.domain / 200)
        patches = bare_heights(given, given.rows)
        assert not patches[2 - body].any()
        found.append(patches[body - 1])
    coarse, fine = found
    assert 2 * coarse.shape[0] - fine.shape[0] in (0, 1)
    assert np.std(fine[: 2 * coarse.shape[0] : 2, ::2] - coarse) < 0.1 * np.std(coarse)
    assert np.std(coarse) == approx(100e-9, rel=0.2)


def test_rows_that_a_scar_adds_repeat_the_patch():
    scene = Scene.from_toml("azam_case_a", SMOOTH | {"film.points": "65"}).with_heights(2, measured(), 1e-6)
    own, more = bare_heights(scene, scene.rows)[1], bare_heights(scene, scene.rows + 8)[1]
    assert np.array_equal(more[4:-4], own)
    assert np.array_equal(more[:4], own[-5:-1])


def test_statistics_of_a_wave_and_of_pits_are_those_of_textbooks_at_any_level():
    size, length = 50e-9, 720e-6
    wave = 3e-6 + size * np.sin(2.0 * np.pi * (np.arange(720) + 0.5) * 1e-6 / length)
    found = statistics_of(np.tile(wave, (4, 1)), 1e-6)
    assert found.rms == approx(size / np.sqrt(2.0), rel=1e-9)
    assert found.ra == approx(2.0 * size / np.pi, rel=1e-4)
    assert found.skewness == approx(0.0, abs=1e-9)
    assert found.peak_to_valley == approx(2.0 * size, rel=1e-4)
    assert found.slope == approx(2.0 * np.pi / length * found.rms, rel=2e-3)
    pits = np.full((16, 16), 3e-6)
    pits[::4, ::4] -= size
    assert statistics_of(pits, 1e-6).skewness == approx(-(1.0 - 2.0 / 16.0) / np.sqrt(15.0 / 256.0), rel=1e-6)


def test_what_the_grid_cuts_is_what_is_missing_in_its_rms():
    scene = Scene.from_toml("azam_case_a", {"surface_2.rq": "0 nm"})
    noise = np.random.default_rng(1).normal(scale=100e-9, size=(512, 512))
    found = shown(scene.with_heights(2, noise, DOMAIN / 512, beyond="repeated"), 2)
    assert found.rms == approx(np.std(noise), rel=1e-9)
    assert found.on_grid.rms == approx(25e-9, rel=0.1)  # of 16 numbers in a cell
    assert found.cut == approx(np.sqrt(found.rms**2 - found.on_grid.rms**2), rel=1e-9)
    flat = shown(scene.with_heights(2, dimple(), 1e-6, beyond="flat"), 2)
    whole = np.zeros((500, 500))
    whole[:80, :80] = dimple()
    assert flat.rms == approx(np.std(whole), rel=1e-6)
    assert flat.slope == approx(statistics_of(whole, 1e-6).slope, rel=0.01)
    assert flat.on_grid.skewness < -20.0
    generated = shown(scene, 1)
    assert generated.rms == 12e-9
    assert generated.cut < 0.05e-9


def test_heights_lie_on_a_self_affine_surface_too():
    rough = SelfAffine(rq=50e-9, hurst=0.8, roll_off=60e-6, cut_off=8e-6, seed=1)
    scene = replace(Scene.from_toml("azam_case_a"), surface_1=rough).with_heights(1, measured(), 1e-6)
    assert np.std(bare_heights(scene, 129)[0][:-1]) == approx(scene.surface_1.rms, rel=0.15)


def test_a_dimple_deepens_the_film_of_its_place():
    speeds = {"operation.speed_1": "5 m/s", "operation.speed_2": "5 m/s"}
    laws = {"tribofilm.model": "none", "wear.model": "none", "heat.model": "none"}
    plain = Scene.from_toml("azam_case_a", SMOOTH | speeds | laws | {"film.points": "65", "film.tolerance": "1e-2"})
    given = plain.with_heights(2, dimple(depth=1e-6), 2e-6, beyond="flat")
    one, two = (solve(scene, scene.operation.point, initial_state(scene)) for scene in (plain, given))
    assert two.gap[32, 32] > one.gap[32, 32] + 0.1e-6
    assert two.gap[32, 18] == approx(one.gap[32, 18], rel=0.1)
