"""Messages of FMUs go to `logging`.

fmpy's library for messages of FMI 2.0 holds one logger for the whole process: there is one, and it is never freed.
"""

import logging
from ctypes import byref
from typing import Any

from fmpy.fmi2 import defaultCallbacks, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.logging import addLoggerProxy

from .printable import printable

log = logging.getLogger(__name__)

LEVELS = (logging.INFO, logging.WARNING, logging.WARNING, logging.ERROR, logging.CRITICAL)  # by FMI status


said: dict[str, str] = {}  # last message of each FMU that tells of something wrong, by its name


def pass_on(name: str, status: int, message: bytes | None) -> None:
    """Log the message of an FMU; a record has its FMI status and its text as attributes."""
    text = printable((message or b"").decode("utf-8", "replace"), kept="\n\t")
    if LEVELS[min(status, len(LEVELS) - 1)] > logging.INFO and text.strip():
        said[name] = text
    log.log(LEVELS[min(status, len(LEVELS) - 1)], "%s: %s", name, text, extra={"status": status, "text": text})


def cause(name: str, says: str = "It says") -> str:
    """Return the first line of an FMU's last message of an error as a sentence; or a sentence that it gave none."""
    if name not in said:
        return "It gave no message; ask who made it."
    return f"{says}: {said[name].strip().splitlines()[0].rstrip('.')}."


def callbacks() -> fmi2CallbackFunctions:
    functions = fmi2CallbackFunctions()
    functions.logger = _LOGGER
    functions.allocateMemory = defaultCallbacks.allocateMemory
    functions.freeMemory = defaultCallbacks.freeMemory
    addLoggerProxy(byref(functions))
    return functions


def _on_message(environment: Any, instance: bytes | None, status: int, category: bytes, message: bytes | None) -> None:
    pass_on((instance or b"an FMU").decode("utf-8", "replace"), status, message)


_LOGGER = fmi2CallbackLoggerTYPE(_on_message)
