"""What all parts of a scene have in common."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields
from typing import Any, ClassVar


class Part(Mapping[str, Any]):
    """A part of a scene is a mapping as well: the content of the scene file, without the fields left out.

    Functions take it as they take a dictionary; ``dataclasses.replace`` makes another with some fields changed.
    """

    # the field of the file that tells which kind of structure, or which law, and its value
    tag: ClassVar[tuple[str, str] | None] = None

    def __getitem__(self, name: str) -> Any:
        return self._stated()[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._stated())

    def __len__(self) -> int:
        return len(self._stated())

    def __repr__(self) -> str:
        given = (f"{name}={value!r}" for name, value in self._fields().items())
        return f"{type(self).__name__}({', '.join(given)})"

    def _stated(self) -> dict[str, Any]:
        return dict([self.tag] if self.tag else []) | self._fields()

    def _fields(self) -> dict[str, Any]:
        values = {field.name: getattr(self, field.name) for field in fields(self)}  # type: ignore[arg-type]
        return {name: value for name, value in values.items() if value is not None}
