"""Writes ``vibroimpact/parts.py``, the dataclasses of a scene, from the JSON Schema of scenes.

The schema comes from the library's types (``vibroimpact schema scene``), so that names, kinds and descriptions are those of the
program. ``tests/test_parts.py`` compares the file with what is made here.
"""

from __future__ import annotations

import json
import re
import textwrap
from pathlib import Path
from typing import Any

HERE = Path(__file__).parents[1]
SCHEMA = HERE.parent / "datasets" / "schema" / "scene.schema.json"
PARTS = HERE / "vibroimpact" / "parts.py"

# Definitions that are one of several kinds, and the field that names the kind.
TAGGED = {"Structure": "kind", "Contact": "law"}
# The other objects of a scene of one impact.
OBJECTS = ["Attachment", "Support", "Segment", "Point", "MovingMode", "Start", "Striker"]
WIDTH = 124

HEADER = '''"""The parts of a scene of one impact: dataclasses with the fields of the scene file, in SI units.

Written by ``tools/make_parts.py`` from the JSON Schema of scenes. An omitted field is ``None`` here and is not written to the
scene; the values of fields are checked when the scene is used.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal, Union

import numpy as np
from numpy.typing import NDArray

from ._part import Part

'''


class Maker:
    """The text of the module, one definition after the other."""

    def __init__(self) -> None:
        self.definitions: dict[str, Any] = json.loads(SCHEMA.read_text(encoding="utf-8"))["$defs"]
        self.text: list[str] = []
        self.names: list[str] = []

    def module(self) -> str:
        for name in OBJECTS:
            self.part(name, self.definitions[name])
        for name, tag in TAGGED.items():
            kinds = [self.tagged(tag, one) for one in self.definitions[name]["oneOf"]]
            self.text.append(f"{name} = Union[\n    " + ",\n    ".join(kinds) + ",\n]\n")
            self.names.append(name)
        self.part("Scene", self.definitions["Scene"])
        listed = "".join(f'    "{name}",\n' for name in sorted(self.names))
        return HEADER + f"__all__ = [\n{listed}]\n\n\n" + "\n\n".join(self.text)

    def tagged(self, tag: str, schema: dict[str, Any]) -> str:
        """A kind of structure or a law, under the name of its tag."""
        value = schema["properties"][tag]["const"]
        name = "".join(word.capitalize() for word in value.split("-"))
        self.part(name, schema, (tag, value))
        return name

    def part(self, name: str, schema: dict[str, Any], tag: tuple[str, str] | None = None) -> None:
        """A dataclass: required fields first."""
        base = self.resolved(schema) if "$ref" in schema else {}
        properties = base.get("properties", {}) | schema["properties"]
        left_out = {"$schema", "version"} | ({tag[0]} if tag else set())
        required = [field for field in schema.get("required", []) if field not in left_out]
        optional = [field for field in sorted(properties) if field not in left_out and field not in required]
        lines = [f"@dataclass(frozen=True, kw_only=True, eq=False, repr=False)\nclass {name}(Part):"]
        lines.append(docstring(schema["description"], [(field, properties[field]) for field in required + optional]))
        if tag:
            lines.append(f'    tag: ClassVar[tuple[str, str]] = ("{tag[0]}", "{tag[1]}")\n')
        lines += [f"    {field}: {self.kind(properties[field])}" for field in required]
        lines += [f"    {field}: {self.kind(properties[field])} | None = None" for field in optional]
        self.text.append("\n".join(lines) + "\n")
        self.names.append(name)

    def resolved(self, schema: dict[str, Any]) -> Any:
        return self.definitions[schema["$ref"].rsplit("/", 1)[1]]

    def kind(self, schema: dict[str, Any]) -> str:
        """The type of a field, without the information whether the field is optional."""
        if "$ref" in schema:
            name = schema["$ref"].rsplit("/", 1)[1]
            return name if name in OBJECTS or name in TAGGED else self.kind(self.resolved(schema))
        if "const" in schema:
            return f"Literal[{json.dumps(schema['const'])}]"
        if "enum" in schema:
            return f"Literal[{', '.join(json.dumps(value) for value in schema['enum'] if value is not None)}]"
        several = schema.get("oneOf") or schema.get("anyOf")
        if several and "properties" not in schema:
            kinds = [self.kind(one) for one in several if one.get("type") != "null"]
            if all(kind.startswith("Literal[") for kind in kinds):
                return f"Literal[{', '.join(kind[8:-1] for kind in kinds)}]"
            return " | ".join(kinds)
        kinds = schema["type"] if isinstance(schema["type"], list) else [schema["type"]]
        return " | ".join(self.simple(kind, schema) for kind in kinds if kind != "null")

    def simple(self, kind: str, schema: dict[str, Any]) -> str:
        if kind == "array":
            item = self.kind(schema["items"])
            return "Sequence[float] | NDArray[np.float64]" if item == "float" else f"Sequence[{item}]"
        if kind == "object":
            return f"Mapping[str, {self.kind(schema['additionalProperties'])}]"
        return {"number": "float", "integer": "int", "string": "str", "boolean": "bool"}[kind]


def told(description: str) -> str:
    """The first paragraph of a description, without the markup of Rust's documentation."""
    first = description.split("\n\n")[0].replace("\n", " ")
    first = re.sub(r'^`"[a-z-]+"`: (a |an |the )?', lambda found: found[1] or "", first)
    first = re.sub(r",? ?`(?:\w+::)+\w+`", "", first)
    return (first[0].upper() + first[1:]).replace("`", "``")


def docstring(description: str, fields: list[tuple[str, Any]]) -> str:
    wrapped = textwrap.fill(told(description), WIDTH - 4 - 3, subsequent_indent="    ")
    lines = [f'    """{wrapped}', ""]
    for field, schema in fields:
        says = f"``{field}``: {told(schema['description'])}"
        lines.append(textwrap.fill(says, WIDTH, initial_indent="    ", subsequent_indent="        "))
    return "\n".join([*lines, '    """', ""])


if __name__ == "__main__":
    PARTS.write_text(Maker().module(), encoding="utf-8")
