"""Names and messages of FMUs, before they are printed."""


def printable(text: str, kept: str = "") -> str:
    """Return a text without characters that a terminal would obey, but for those in `kept`; so it is one line."""
    return "".join(letter if letter.isprintable() or letter in kept else ascii(letter)[1:-1] for letter in text)
