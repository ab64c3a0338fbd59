"""Conversion between Python's values and the JSON that the library reads and writes."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._errors import InvalidInput
from ._result import Identification, Impact, Motion, Result

if TYPE_CHECKING:
    from _typeshed import SupportsKeysAndGetItem

# Lists of objects that become structured arrays: the fields, by the name of the list.
_TABLES: dict[str, list[list[str]]] = {
    "sub_impacts": [
        [
            "start_s",
            "end_s",
            "impulse_n_s",
            "peak_force_n",
            "peak_force_uncertainty_n",
            "peak_force_uncertainty_solver_n",
            "peak_force_uncertainty_modes_left_out_n",
            "peak_force_uncertainty_beam_theory_n",
            "peak_compression_m",
        ]
    ],
    "contacts": [
        ["start", "end", "duration", "closing_speed", "peak_force"],
        ["start_s", "end_s", "peak_force_n"],
    ],
    "turning_points": [["n", "s", "uncertainty"]],
    "points": [
        ["contact", "side", "displacement_m", "velocity_m_s"],
        [
            "contact",
            "side",
            "intervals_per_period",
            "displacement_first_harmonic_m",
            "displacement_max_m",
            "displacement_min_m",
            "displacement_section_m",
        ],
    ],
}
# The intervals of a contact between bodies.
_INTERVALS = [
    [
        "start_s",
        "end_s",
        "impulse_n_s",
        "peak_force_n",
        "peak_compression_m",
        "approach_speed_m_s",
        "separation_speed_m_s",
    ]
]
# Classes of results, by an entry that only this kind of result has.
_KINDS: dict[str, type[Result]] = {"striker_velocity_m_s": Impact, "steady_motion": Motion, "profiles": Identification}
_WHOLE = ("n", "side", "intervals_per_period")
_ARRAYS = ("modes_j", "intervals")


def to_json(tree: Mapping[str, Any]) -> str:
    """A scene or a sweep as JSON text; it may contain arrays and numbers of numpy."""
    return json.dumps(dict(tree), default=_plain)


def _plain(value: object) -> object:
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    if isinstance(value, Mapping):
        return dict(value)
    if isinstance(value, Sequence) and not isinstance(value, (bytes, bytearray)):
        return list(value)
    raise TypeError(f"a scene cannot contain a {type(value).__name__}")


def to_csv(table: SupportsKeysAndGetItem[str, Any]) -> str:
    """Columns as a table of comma-separated values; a missing number (NaN) becomes an empty cell."""
    cells = {str(name): [_cell(value) for value in table[name]] for name in table.keys()}
    lengths = {name: len(column) for name, column in cells.items()}
    for name, length in lengths.items():
        longest = max(lengths.values())
        if length != longest:
            allowed = f"as long as the longest column, which has {longest}"
            message = f"column {name} = {length} values is not allowed; it must be {allowed}"
            raise InvalidInput(message, f"column {name}", f"{length} values", allowed)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(cells)
    writer.writerows(zip(*cells.values()))
    return text.getvalue()


def _cell(value: Any) -> str:
    if isinstance(value, (float, np.floating)):
        return "" if np.isnan(value) else repr(float(value))
    return "" if value is None else str(value)


def to_free(free: Mapping[str, Any] | Iterable[str]) -> list[str]:
    """Free fields in the form of the command line: by their names, or ``field=low..high``."""
    if isinstance(free, str):
        raise TypeError("free must be a list of fields, or a mapping from fields to limits of the search, not one text")
    if not isinstance(free, Mapping):
        return list(free)
    return [field if limits is None else f"{field}={limits[0]}..{limits[1]}" for field, limits in free.items()]


def from_json(text: str) -> Result:
    """A result in the class for its kind, with its tables as arrays."""
    tree = json.loads(text, object_hook=_with_arrays)
    kind = next((kind for entry, kind in _KINDS.items() if entry in tree), Result)
    return kind(tree)


def columns(table: str) -> dict[str, Any]:
    """The columns of a table of comma-separated numbers and truth values."""
    names, *rows = csv.reader(table.splitlines())
    cells = list(zip(*rows)) or [()] * len(names)

    def column(values: tuple[str, ...]) -> Any:
        truths = bool(values) and set(values) <= {"true", "false"}
        return np.array([value == "true" for value in values] if truths else [float(value) for value in values])

    return {name: column(values) for name, values in zip(names, cells)}


def _with_arrays(entry: dict[str, Any]) -> dict[str, Any]:
    tables = _TABLES | ({"intervals": _INTERVALS} if "intervals_left_out" in entry else {})
    for name in _ARRAYS:
        if name not in tables and isinstance(entry.get(name), list):
            entry[name] = np.array(entry[name], dtype=float)
    for name, kinds in tables.items():
        rows = entry.get(name)
        if isinstance(rows, list):
            rows = [_flat(row) for row in rows]
            # A scene has lists of these names, too.
            fields = next((fields for fields in kinds if not rows or fields == list(rows[0])), None)
            if fields is not None:
                entry[name] = _table(rows, fields)
    if entry.get("floquet_multipliers") is not None:
        entry["floquet_multipliers"] = np.array([complex(*pair) for pair in entry["floquet_multipliers"]])
    return entry


def _flat(row: Any) -> Any:
    """A row whose uncertainties in parts are columns, as ``sub_impacts.csv`` has them."""
    flat: dict[str, Any] = {}
    for name, cell in row.items() if isinstance(row, dict) else ():
        if name.endswith("_uncertainty_parts_n") and isinstance(cell, dict):
            flat |= {f"{name.removesuffix('_parts_n')}_{part}_n": size for part, size in cell.items()}
        else:
            flat[name] = cell
    return flat or row


def _table(rows: list[dict[str, Any]], fields: list[str]) -> Any:
    longest = max((len(row["contact"]) for row in rows if "contact" in row), default=1)

    def kind(field: str) -> tuple[Any, ...]:
        if rows and isinstance(rows[0][field], list):
            return field, np.float64, (len(rows[0][field]),)
        return field, f"U{longest}" if field == "contact" else np.int64 if field in _WHOLE else np.float64

    cells = [tuple(np.nan if row[field] is None else row[field] for field in fields) for row in rows]
    return np.array(cells, dtype=[kind(field) for field in fields])
