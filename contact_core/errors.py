"""Errors, by meaning. Every message is a sentence that ends with a way out."""

import difflib


class ContactError(Exception):
    """Anything the contact core refuses or cannot do."""


class SceneError(ContactError):
    """A scene, or a value in it, that cannot be used."""


class OperatingPointError(ContactError):
    """A load, speed or temperature outside what the contact can be asked for."""


class StateError(ContactError):
    """A stored state that is damaged or belongs to another contact."""


class ConvergenceError(ContactError):
    """No solution exists or none was found, also not by the fallback."""


class FilmTooWideError(ConvergenceError):
    """An oil film so thick, for its load, that it does not fit on the grid."""


def did_you_mean(word: str, choices: list[str]) -> str:
    """Return " Did you mean ...?" if one of the choices looks like the word, else nothing."""
    close = [name for name in choices if name.lower() == word.lower()]
    close += difflib.get_close_matches(word, choices, n=1, cutoff=0.6)
    return f" Did you mean '{close[0]}'?" if close else ""
