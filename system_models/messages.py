"""What FMUs of FMI 2.0 say goes to `logging`.

The library by which fmpy makes text of a message and its arguments holds one logger for the whole process, the last
that it was given, and calls it for every FMU: so there is one, which is never freed, and an FMU is known by its name.
"""

import logging
from ctypes import byref
from typing import Any

from fmpy.fmi2 import defaultCallbacks, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.logging import addLoggerProxy

log = logging.getLogger(__name__)

LEVELS = (logging.INFO, logging.WARNING, logging.WARNING, logging.ERROR, logging.CRITICAL)  # by FMI status


def pass_on(name: str, status: int, message: bytes | None) -> None:
    """Log what an FMU says."""
    text = (message or b"").decode("utf-8", "replace")
    log.log(LEVELS[min(status, len(LEVELS) - 1)], "%s: %s", name, text)


def callbacks() -> fmi2CallbackFunctions:
    """The functions that an instance is given."""
    functions = fmi2CallbackFunctions()
    functions.logger = _LOGGER
    functions.allocateMemory = defaultCallbacks.allocateMemory
    functions.freeMemory = defaultCallbacks.freeMemory
    addLoggerProxy(byref(functions))
    return functions


def _on_message(environment: Any, instance: bytes | None, status: int, category: bytes, message: bytes | None) -> None:
    pass_on((instance or b"an FMU").decode("utf-8", "replace"), status, message)


_LOGGER = fmi2CallbackLoggerTYPE(_on_message)
