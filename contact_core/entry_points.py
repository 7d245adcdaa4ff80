"""What other installed packages offer to this one: their entry points."""

from importlib.metadata import EntryPoint, entry_points
from typing import Any

from .errors import SceneError

PREFIX = "tribofmu."  # of all groups


def offered(prefix: str) -> dict[str, dict[str, Any]]:
    """Return what packages offer in groups of entry points whose names begin with `prefix`: by group, then by name.

    Raises SceneError if something cannot be imported, or if two packages offer the same name.
    """
    found: dict[str, dict[str, Any]] = {}
    for entry in _entries(prefix):
        group = found.setdefault(entry.group, {})
        if entry.name in group:
            raise SceneError(f"Two packages offer a '{entry.name}' of {entry.group}. Remove one: pip uninstall NAME.")
        try:
            group[entry.name] = entry.load()
        except Exception as error:
            raise SceneError(
                f"{_described(entry)} cannot be imported: {type(error).__name__}: {error}. Correct it, or remove the "
                "package."
            ) from error
    return found


def homes(group: str) -> set[str]:
    """Return the names of the packages or modules that offer something in a group; nothing is imported."""
    return {entry.module.partition(".")[0] for entry in _entries(group)}


def versions(modules: set[str]) -> dict[str, str]:
    """Return names and versions of the packages that offer something from modules or packages of these names."""
    found = {entry.dist for entry in _entries(PREFIX) if entry.module.partition(".")[0] in modules}
    return {dist.name: dist.version for dist in found if dist}


def _described(entry: EntryPoint) -> str:
    """Return an entry point in words: what it offers, and the package that does."""
    package = entry.dist.name if entry.dist else "an unknown package"
    return f"'{entry.name}' of {entry.group} ({entry.value}), which the package {package} offers,"


def _entries(prefix: str) -> list[EntryPoint]:
    known = entry_points()
    return [entry for group in sorted(known.groups) if group.startswith(prefix) for entry in known.select(group=group)]
