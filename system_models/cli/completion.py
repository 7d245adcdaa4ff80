"""The command `tribofmu completion`: a script that completes commands, options, shipped scenes and machines, and pages.

It is made from the arguments that the commands have, and holds all words itself: no key press starts Python.
"""

import argparse

from contact_core.scene.toml import shipped_scenes

from ..machines import files
from . import pages

_BASH = """\
_tribofmu() {{
    local word=${{COMP_WORDS[COMP_CWORD]}} words
    case $COMP_CWORD:${{COMP_WORDS[1]}} in
        1:*) words="{commands}" ;;
{cases}
    esac
    COMPREPLY=($(compgen -W "$words" -- "$word"))
    [ "$COMP_CWORD" -gt 1 ] && COMPREPLY+=($(compgen -f -- "$word"))
}}
complete -o filenames -F _tribofmu tribofmu
"""
_SHELLS = {
    "bash": 'eval "$(tribofmu completion bash)" in ~/.bashrc',
    "zsh": 'eval "$(tribofmu completion zsh)" in ~/.zshrc',
    "fish": "tribofmu completion fish | source in ~/.config/fish/config.fish",
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    lines = "; ".join(f"{shell}: {line}" for shell, line in _SHELLS.items())
    parser.add_argument("shell", choices=tuple(_SHELLS), help=f"the shell to complete in; {lines}")


def run(arguments: argparse.Namespace) -> int:
    """Print the script of a shell."""
    words = _words(arguments.parser)
    print(_fish(words) if arguments.shell == "fish" else _bash(words, arguments.shell == "zsh"), end="")
    return 0


def _words(parser: argparse.ArgumentParser) -> dict[str, list[str]]:
    """Return what may follow each command: options, choices, scenes, machines and pages where they are taken."""
    (commands,) = (action for action in parser._actions if isinstance(action, argparse._SubParsersAction))
    found = {}
    for name, command in commands.choices.items():
        words = [option for action in command._actions for option in action.option_strings if option[:2] == "--"]
        words += [str(choice) for action in command._actions for choice in action.choices or ()]
        for action in command._actions:
            if action.dest == "scene":
                words += [*shipped_scenes(), *(files.shipped() if "machine" in str(action.help) else ())]
            if action.dest == "page":
                words += pages.files()
        found[name] = list(dict.fromkeys(words))
    return found


def _bash(words: dict[str, list[str]], zsh: bool) -> str:
    cases = "\n".join(f'        *:{name}) words="{" ".join(each)}" ;;' for name, each in words.items())
    script = _BASH.format(commands=" ".join(words), cases=cases)
    return f"autoload -U +X bashcompinit && bashcompinit\n{script}" if zsh else script


def _fish(words: dict[str, list[str]]) -> str:
    lines = [f"complete -c tribofmu -n __fish_use_subcommand -f -a '{' '.join(words)}'"]
    lines += [
        f"complete -c tribofmu -n '__fish_seen_subcommand_from {name}' -a '{' '.join(each)}'"
        for name, each in words.items()
    ]
    return "\n".join(lines) + "\n"
