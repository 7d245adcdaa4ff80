"""Everything that is wrong with a table, in one refusal: wrong values, and what is missing in one sentence."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import NamedTuple

from ..errors import SceneError


class Missing(NamedTuple):
    """A value that a table has to give."""

    key: str  # dotted
    text: str  # unit and meaning, or the choices
    way_out: str  # a sentence for a value that is missing alone


class TableError(SceneError):
    """Refusal of a table, with all that is wrong in it and all that is missing."""

    def __init__(self) -> None:
        super().__init__()
        self.wrong: list[str] = []  # sentences
        self.missing: list[Missing] = []
        self.way_out = ""  # a sentence, where several values are missing

    @contextmanager
    def collected(self) -> Iterator[None]:
        """Keep the refusals of a part of the table and continue with the next part."""
        try:
            yield
        except TableError as inside:
            self.wrong += inside.wrong
            self.missing += inside.missing
        except SceneError as error:
            self.wrong.append(str(error))

    def refuse(self) -> None:
        """Raise itself if something has been found."""
        if self.wrong or self.missing:
            raise self

    def __str__(self) -> str:
        """Return the sentences, each once."""
        return " ".join([*dict.fromkeys(self.wrong), *self._lacking()])

    def _lacking(self) -> list[str]:
        if not self.missing:
            return []
        if len(self.missing) == 1:
            only = self.missing[0]
            return [f"'{only.key}' is missing. {only.way_out}"]
        listed = "; ".join(f"{missing.key} {missing.text}" for missing in self.missing)
        return [f"These {len(self.missing)} values are missing: {listed}. {self.way_out}".rstrip()]
