"""Between Python's values and the JSON that the library reads and writes."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

# lists of objects that become structured arrays: their fields, by the name of the list and whether it is in SI units
_TABLES: dict[str, list[list[str]]] = {
    "sub_impacts": [["start_s", "end_s", "impulse_n_s", "peak_force_n", "peak_compression_m"]],
    "contacts": [
        ["start", "end", "duration", "closing_speed", "peak_force"],
        ["start_s", "end_s", "peak_force_n"],
    ],
    "turning_points": [["n", "s", "uncertainty"]],
}
_ARRAYS = ("modes_j", "intervals")


def to_json(tree: Mapping[str, Any]) -> str:
    """A scene or a sweep as JSON text; arrays and numbers of numpy are welcome in it."""
    return json.dumps(dict(tree), default=_plain)


def _plain(value: object) -> object:
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    if isinstance(value, Mapping):
        return dict(value)
    if isinstance(value, Sequence) and not isinstance(value, (bytes, bytearray)):
        return list(value)
    raise TypeError(f"a scene cannot hold a {type(value).__name__}")


def from_json(text: str) -> dict[str, Any]:
    """A result, with its tables as arrays."""
    result: dict[str, Any] = json.loads(text, object_hook=_with_arrays)
    return result


def _with_arrays(entry: dict[str, Any]) -> dict[str, Any]:
    for name in _ARRAYS:
        if entry.get(name) is not None:
            entry[name] = np.array(entry[name], dtype=float)
    for name, kinds in _TABLES.items():
        if entry.get(name) is not None:
            rows = entry[name]
            fields = next((fields for fields in kinds if rows and fields == list(rows[0])), kinds[0])
            kind = [(field, np.int64 if field == "n" else np.float64) for field in fields]
            cells = [tuple(np.nan if row[field] is None else row[field] for field in fields) for row in rows]
            entry[name] = np.array(cells, dtype=kind)
    return entry
