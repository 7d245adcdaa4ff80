"""Completion in a shell, by the shell itself; and pages that errors name."""

import shutil
import subprocess
from pathlib import Path

import pytest

from contact_core.errors import ContactError, ConvergenceError, SceneError
from system_models.cli.main import COMMANDS, main
from system_models.cli.pages import PAGES, page_of

ROOT = Path(__file__).parents[2]


def completed(script: str, *words: str) -> set[str]:
    """Return what bash completes the last word to."""
    ask = f"COMP_WORDS=({' '.join(repr(word) for word in words)}); COMP_CWORD={len(words) - 1}; _tribofmu; "
    code = f'{script}\n{ask}printf "%s\\n" "${{COMPREPLY[@]}}"'
    run = subprocess.run(["bash", "-c", code], check=True, capture_output=True, text=True)
    return set(run.stdout.split())


@pytest.mark.skipif(shutil.which("bash") is None, reason="needs bash")
def test_bash_completes_commands_options_scenes_and_machines(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["completion", "bash"]) == 0
    script = capsys.readouterr().out
    assert completed(script, "tribofmu", "") == set(COMMANDS)
    assert {"mtm_zddp", "mtm_rig"} <= completed(script, "tribofmu", "run", "mtm")
    assert completed(script, "tribofmu", "stribeck", "mtm") == {"mtm_zddp", "mtm_zddp_thesis"}
    assert completed(script, "tribofmu", "run", "mtm_zddp", "--res") == {"--resume"}
    assert completed(script, "tribofmu", "completion", "z") == {"zsh"}


def test_the_scripts_of_zsh_and_fish_name_every_command(capsys: pytest.CaptureFixture[str]) -> None:
    for shell, begin in (("zsh", "autoload -U +X bashcompinit"), ("fish", "complete -c tribofmu")):
        assert main(["completion", shell]) == 0
        script = capsys.readouterr().out
        assert script.startswith(begin)
        assert all(name in script for name in COMMANDS)


def test_pages_that_errors_name_are_there() -> None:
    assert [page for page in sorted(PAGES) if not (ROOT / page).is_file()] == []


@pytest.mark.parametrize(
    ("error", "command", "page"),
    [
        (SceneError("surface_1.correlation_length = 1 m is"), "run", "docs/how-to/surfaces.md"),
        (SceneError("operation.load has no unit."), "run", "docs/how-to/scenes.md"),
        (ConvergenceError("No solution was found."), "run", "docs/concepts/numerics.md"),
        (ContactError("The FMU has no load."), "cosim", "docs/how-to/cosim.md"),
        (ContactError("The folder cannot be made."), "list", "docs/index.md"),
    ],
)
def test_an_error_names_the_page_of_what_it_is_about(error: ContactError, command: str, page: str) -> None:
    assert page_of(error, command) == page


def test_a_refused_command_ends_with_its_page(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "mtm_zddp", "--set", "surface_1.rq=3"]) == 2
    assert capsys.readouterr().err.endswith("See docs/how-to/surfaces.md.\n")
