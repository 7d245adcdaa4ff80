"""The sources in C that all native FMUs share: random calls, sanitizers, memory, equal bits."""

import shutil
import subprocess
import sys
from pathlib import Path

import native_fmu
import pytest

from benchmarks.hosts import native_fuzz
from fmu_src.native import build

pytestmark = [pytest.mark.fmu, pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")]

SEQUENCES = 2000
INSTANCE = 16384  # bytes
CROWD, CROWD_MEMORY = 10_000, 200e6  # -, bytes


@pytest.fixture(scope="module")
def counted(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The program of random calls that notices every allocation."""
    folder = tmp_path_factory.mktemp("counted")
    return native_fuzz.compiled(folder, native_fmu.all_sources(), "-O2", *native_fuzz.COUNTED)


@pytest.fixture(scope="module")
def answers(counted: Path) -> str:
    return native_fuzz.digest(counted, SEQUENCES)


@pytest.mark.parametrize("compiler", ["clang", "zig"])  # gcc compiles all other FMUs of these tests, with -Werror
@pytest.mark.parametrize("fmi", [2, 3])
def test_sources_compile_without_a_warning(fmi: build.Fmi, compiler: str, tmp_path: Path) -> None:
    clang = "clang" if compiler == "clang" else None
    if not (shutil.which(clang) if clang else build.available(compiler)):
        pytest.skip(f"needs {compiler}")
    folder = native_fmu.write(tmp_path, native_fmu.sources(fmi))
    command = build.command(folder, "x86_64-linux", "gcc" if clang else "zig", folder / "library.so")
    command = [clang, *command[1:]] if clang else command
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")


def test_random_calls_allocate_nothing_and_give_the_same_by_fmi_2_and_3(answers: str) -> None:
    assert len(answers) == 16  # the program has compared and counted


def test_other_seeds_give_other_answers(counted: Path, answers: str) -> None:
    assert native_fuzz.digest(counted, SEQUENCES, seed=2) != answers


@pytest.mark.parametrize("compiler", ["gcc", "zig"])
def test_optimisation_and_compiler_change_no_bit(compiler: str, answers: str, tmp_path: Path) -> None:
    if not build.available(compiler):
        pytest.skip(f"needs {compiler}")
    call = ("gcc",) if compiler == "gcc" else (sys.executable, "-m", "ziglang", "cc", "-fno-sanitize=undefined")
    plain = native_fuzz.compiled(tmp_path, native_fmu.all_sources(), "-O0", compiler=call)
    assert native_fuzz.digest(plain, SEQUENCES) == answers


@pytest.mark.long
def test_random_calls_are_clean_for_the_sanitizers(answers: str, tmp_path: Path) -> None:
    checked = native_fuzz.compiled(tmp_path, native_fmu.all_sources(), *native_fuzz.SANITIZED)
    assert native_fuzz.digest(checked, SEQUENCES) == answers


def test_ten_thousand_instances_take_little_memory(counted: Path) -> None:
    each = 1024.0 * native_fuzz.kilobytes(counted, CROWD)
    assert 1000.0 < each <= INSTANCE
    assert each * CROWD <= CROWD_MEMORY


FAULTS = {
    "an unchecked number": ("instance.c", "if (!outputs_finite(&it->now.solution.outputs)) return refuse_broken(it);"),
    "an unchecked sum": ("states.c", "|| header.checksum != checksum(bytes + UNSUMMED, size - UNSUMMED)"),
    "a state that is never freed": ("instance.c", "instance_forget_all(it);"),
    "a change in the intermediate update": ("instance.c", 'if (it->asking) return out_of_turn(it, "Reset");'),
}


FIRST, *OTHERS = FAULTS


@pytest.mark.parametrize("fault", [FIRST, *(pytest.param(fault, marks=pytest.mark.long) for fault in OTHERS)])
def test_random_calls_find_faults(fault: str, tmp_path: Path) -> None:
    file, line = FAULTS[fault]
    sources = native_fmu.all_sources()
    text = sources[file].decode()
    assert line in text
    sources[file] = text.replace(line, "").encode()
    program = native_fuzz.compiled(tmp_path, sources, "-O1", "-Wno-unused", *native_fuzz.COUNTED)
    with pytest.raises(RuntimeError, match=r"sequence \d+: "):
        native_fuzz.digest(program, SEQUENCES)
