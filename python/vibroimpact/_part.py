"""The base class of all parts of a scene."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields
from typing import Any, ClassVar


class Part(Mapping[str, Any]):
    """A part of a scene is also a mapping: the content of the scene file, without the omitted fields.

    Functions accept it like a dictionary; ``dataclasses.replace`` returns a copy with some fields changed.
    """

    # The field of the file that names the kind of structure or the law, and its value.
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
