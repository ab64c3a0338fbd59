"""Modes of a test as a table of comma-separated values, with standard deviations."""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping
from os import PathLike
from pathlib import Path

import numpy as np

from ._structure import Floats, Structure

_SD = "_sd"
_MASS = "modal_mass_kg"


def from_table(path: str | PathLike[str], static_compliances_m_n: Mapping[str, float] | None = None) -> Structure:
    """Reads modes from a table with the columns of a ``modes-file`` and, if they are known, their standard deviations.

    The columns are ``frequency_hz`` or ``omega_rad_s``, ``damping_ratio``, ``modal_mass_kg``, and shapes at points; a column
    ``NAME_sd`` contains the standard deviations of ``NAME``. Shapes are mass-normalised (kg^-1/2), or normalised to the modal
    masses if the table has them: they are then divided by the square roots of these, so that the structure has unit modal masses. The
    standard deviation of a modal mass increases those of the shapes of its mode.
    """
    columns = _columns(Path(path))
    frequencies = [name for name in ("omega_rad_s", "frequency_hz") if name in columns]
    if len(frequencies) != 1:
        raise ValueError(f"{path}: one column of frequencies is needed, omega_rad_s or frequency_hz")
    frequency = frequencies[0]
    factor = 1.0 if frequency == "omega_rad_s" else 2.0 * math.pi
    spreads = {name: values for name, values in columns.items() if name.endswith(_SD)}
    for name in spreads:
        if name.removesuffix(_SD) not in columns:
            raise ValueError(f"{path}: column {name} is not allowed; it must be beside the column {name.removesuffix(_SD)}")
        if np.any(spreads[name] < 0.0):
            raise ValueError(f"{path}: column {name} = {spreads[name].min()} is not allowed; it must be 0 or a positive number")
    points = [name for name in columns if name not in spreads and name not in (frequency, "damping_ratio", _MASS)]
    masses = columns.get(_MASS, np.ones_like(columns[frequency]))
    if np.any(masses <= 0.0):
        raise ValueError(f"{path}: column {_MASS} = {masses.min()} is not allowed; it must be a positive number")
    shapes = {name: columns[name] / np.sqrt(masses) for name in points}
    deviations = {}
    for name, key, scale in [(frequency, "omega_rad_s", factor), ("damping_ratio", "damping_ratios", 1.0)]:
        if name + _SD in spreads:
            deviations[key] = scale * spreads[name + _SD]
    for name in points:
        if name + _SD in spreads or _MASS + _SD in spreads:
            own = spreads.get(name + _SD, np.zeros_like(masses)) / np.sqrt(masses)
            # A shape is in proportion to the mass to the power of -1/2.
            by_mass = 0.5 * shapes[name] * spreads.get(_MASS + _SD, np.zeros_like(masses)) / masses
            deviations[f"points.{name}.shape"] = np.hypot(own, by_mass)
    return Structure(
        omega_rad_s=factor * columns[frequency],
        shapes=shapes,
        damping_ratios=columns.get("damping_ratio"),
        static_compliances_m_n=dict(static_compliances_m_n or {}),
        standard_deviations=deviations,
    )


def _columns(path: Path) -> dict[str, Floats]:
    with path.open(newline="", encoding="utf-8-sig") as file:
        rows = [row for row in csv.reader(file) if row]
    if len(rows) < 2:
        raise ValueError(f"{path}: a line of names, and below it a line for each mode, is needed")
    names = [name.strip() for name in rows[0]]
    if len(set(names)) != len(names) or "" in names:
        raise ValueError(f"{path}: each column needs a name of its own")
    for line, row in enumerate(rows[1:], start=2):
        if len(row) != len(names):
            raise ValueError(f"{path}: row {line} has {len(row)} cells, and the line of names {len(names)}")
    found = {}
    for k, name in enumerate(names):
        cells = []
        for line, row in enumerate(rows[1:], start=2):
            try:
                value = float(row[k])
            except ValueError:
                value = math.nan
            if not math.isfinite(value):
                raise ValueError(f"{path}: row {line}, {name} = {row[k]!r} is not allowed; it must be a finite number")
            cells.append(value)
        found[name] = np.asarray(cells)
    return found
