"""Exceptions: input that cannot be used, and a computation that was interrupted."""

from __future__ import annotations

from typing import Any


class InvalidInput(ValueError):
    """Input that cannot be used; the text is that of the command line.

    ``field`` is the path of the field, as in ``structure.segments[0].length_m``; ``value`` is its value as
    JSON text, or ``None`` if the field is missing; ``allowed`` completes the sentence "it must be ...".
    """

    field: str
    value: str | None
    allowed: str

    def __init__(self, message: str, field: str, value: str | None, allowed: str) -> None:
        super().__init__(message)
        self.field = field
        self.value = value
        self.allowed = allowed

    def __reduce__(self) -> tuple[type[InvalidInput], tuple[str, str, str | None, str]]:
        return type(self), (str(self), self.field, self.value, self.allowed)


class Interrupted(KeyboardInterrupt):
    """Ctrl-C ended a computation; ``result`` is the result so far, in the form of a complete one."""

    result: dict[str, Any]

    def __init__(self, result: dict[str, Any]) -> None:
        super().__init__("interrupted; the result so far is the attribute result of this exception")
        self.result = result

    def __reduce__(self) -> tuple[type[Interrupted], tuple[dict[str, Any]]]:
        return type(self), (self.result,)
