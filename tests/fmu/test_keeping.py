"""What takes long to make for native FMUs is made once, and anew whenever something that decides it has changed."""

import os
import subprocess
import sys
import types
from pathlib import Path
from typing import Any

import native_fmu
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from contact_core.kernels import cache
from fmu_src.native import build, keeping, program

KEPT, FOLDER = keeping.kept, keeping.folder  # before the processes of a run share what is kept


@pytest.fixture
def own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A cache of the test's own."""
    monkeypatch.setattr(keeping, "folder", lambda: tmp_path / "cache")
    monkeypatch.setattr(keeping, "kept", KEPT)
    return tmp_path / "cache"


def made(key: object, data: bytes = b"made") -> bool:
    """True if something was made for a key, which an earlier run had not."""
    calls: list[object] = []
    assert KEPT(key, lambda: (calls.append(key), data)[1]) == data
    return bool(calls)


KEYS = st.tuples(st.text(max_size=3), st.binary(max_size=3), st.tuples(st.text(max_size=2), st.booleans()))


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(keys=st.lists(KEYS, max_size=2), data=st.binary(max_size=50))
def test_each_key_is_made_once(own: Path, keys: list[Any], data: bytes) -> None:
    seen = {name.name for name in own.iterdir()} if own.exists() else set()
    for key in keys:
        made((data, key), data)
        assert not made((data, key), data)
    assert len(list(own.glob("*"))) - len(seen) <= len({repr((data, key)) for key in keys})


def test_what_a_power_cut_has_torn_is_made_again(own: Path) -> None:
    assert made("key")
    (file,) = own.iterdir()
    for torn in (b"", file.read_bytes()[:-1]):
        file.write_bytes(torn)
        assert made("key")
        assert not made("key")


def test_what_no_run_has_asked_for_in_a_month_is_removed(own: Path) -> None:
    for key in ("old", "used"):
        made(key)
    for file in own.iterdir():
        os.utime(file, (0.0, 0.0))
    assert not made("used")
    made("new")
    assert made("old")
    assert not made("used")


@pytest.mark.parametrize("cache", ["/dev/null/cache", None])
def test_without_a_cache_it_is_made_each_time(cache: str | None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(keeping, "folder", FOLDER)
    monkeypatch.setattr(keeping, "user_cache", lambda: cache and Path(cache))
    assert made("key")
    assert made("key")


def test_a_changed_file_of_the_code_changes_its_fingerprint(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = types.ModuleType("a_package")
    package.__path__ = [str(tmp_path)]
    monkeypatch.setitem(sys.modules, "a_package", package)
    found = []
    for name, text in (("one.py", "1"), ("one.py", "2"), ("two.csv", "1"), ("__pycache__/one.pyc", "1")):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
        keeping._code_of.cache_clear()
        found.append(keeping.code_of("a_package"))
    assert len(set(found[:3])) == 3
    assert found[2] == found[3]
    monkeypatch.setitem(sys.modules, "typed_in", types.ModuleType("typed_in"))
    typed = [(keeping._code_of.cache_clear(), keeping.code_of("typed_in"))[1] for _ in range(2)]
    assert typed[0] != typed[1]


def test_a_second_run_neither_writes_nor_compiles_and_has_the_same_bytes(
    own: Path, quick: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Apart from linking; other options compile anew."""
    compiler = next(filter(build.available, ("gcc", "cc", "zig")), None)
    if compiler is None:
        pytest.skip("needs a compiler")
    calls: list[str] = []
    monkeypatch.setattr(program, "_equations", lambda scene: calls.append("equations") or {"contact.c": "int i;"})
    run = subprocess.run

    def counted(call: list[str], **given: Any) -> Any:
        calls.extend(["compiled"] * ("-c" in call))
        return run(call, **given)

    monkeypatch.setattr(subprocess, "run", counted)
    fast = tuple(flag for flag in build.FLAGS if flag != "-O2")
    found = []
    for flags in (fast, fast, (*fast, "-DANOTHER")):
        monkeypatch.setattr(build, "FLAGS", flags)
        program._written.clear()
        build._object.cache_clear()
        calls.clear()
        written = program.written(quick)
        libraries = build.binaries(native_fmu.sources(2), 2, "M", compiler, [build.own(2)])
        found.append((written, libraries, sorted(set(calls))))
    program._written.clear()
    assert found[0][:2] == found[1][:2]
    assert [each[2] for each in found] == [["compiled", "equations"], [], ["compiled"]]


def test_the_cache_is_the_users_own(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert cache.user_cache() == tmp_path
