"""The result of every reader, and its output."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]

# Names of columns that a point cannot have.
_TAKEN = ("omega_rad_s", "frequency_hz", "damping_ratio", "modal_mass_kg")


@dataclass
class Structure:
    """Modes of a structure at named points.

    ``shapes`` are mass-normalised (kg^-1/2), with an array over the modes for each point. ``static_compliances_m_n`` are
    those of the whole elastic structure, from which the program computes remainder modes for all modes that are not listed.
    ``standard_deviations`` are those of ``omega_rad_s``, ``damping_ratios`` and the shapes, by these names and
    ``points.NAME.shape``.
    """

    omega_rad_s: Floats
    shapes: dict[str, Floats]
    damping_ratios: Floats | None = None
    static_compliances_m_n: dict[str, float] = field(default_factory=dict)
    standard_deviations: dict[str, Floats] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.omega_rad_s = _numbers("omega_rad_s", self.omega_rad_s)
        count = len(self.omega_rad_s)
        if count == 0:
            raise ValueError("omega_rad_s is empty: at least one mode is needed")
        if np.any(self.omega_rad_s < 0.0):
            raise ValueError(f"omega_rad_s = {self.omega_rad_s.min()} is not allowed: 0 or a positive number")
        if not self.shapes:
            raise ValueError("shapes are missing: at least one named point is needed")
        for name in self.shapes:
            if not name or name in _TAKEN:
                raise ValueError(f"point {name!r} is not allowed: a name other than {', '.join(_TAKEN)}")
        self.shapes = {name: _numbers(f"shapes of {name}", shape, count) for name, shape in self.shapes.items()}
        if self.damping_ratios is not None:
            self.damping_ratios = _numbers("damping_ratios", self.damping_ratios, count)
        for name, compliance in self.static_compliances_m_n.items():
            if name not in self.shapes:
                raise ValueError(f"static compliance of {name!r} is not allowed: one of the points {list(self.shapes)}")
            if not (compliance >= 0.0 and math.isfinite(compliance)):
                raise ValueError(f"static compliance of {name} = {compliance} is not allowed: 0 or a positive number")

    def write(self, path: str | PathLike[str]) -> dict[str, Any]:
        """Writes the table of modes, and returns the ``structure`` of a scene in the same folder."""
        path = Path(path)
        columns: dict[str, Floats] = {"omega_rad_s": self.omega_rad_s}
        if self.damping_ratios is not None:
            columns["damping_ratio"] = self.damping_ratios
        columns |= self.shapes
        with path.open("w", newline="", encoding="utf-8") as file:
            table = csv.writer(file, lineterminator="\n")
            table.writerow(columns)
            table.writerows([repr(float(value)) for value in row] for row in zip(*columns.values(), strict=True))
        structure: dict[str, Any] = {"kind": "modes-file", "file": path.name}
        if self.static_compliances_m_n:
            structure["static_compliances_m_n"] = dict(self.static_compliances_m_n)
        return structure

    def modal(self) -> dict[str, Any]:
        """The same as a ``structure`` of kind ``modal``, which is part of the scene itself."""
        points: dict[str, dict[str, Any]] = {name: {"shape": shape.tolist()} for name, shape in self.shapes.items()}
        for name, compliance in self.static_compliances_m_n.items():
            points[name]["static_compliance_m_n"] = float(compliance)
        structure: dict[str, Any] = {"kind": "modal", "omega_rad_s": self.omega_rad_s.tolist(), "points": points}
        if self.damping_ratios is not None:
            structure["damping_ratios"] = self.damping_ratios.tolist()
        return structure

    def uncertain(self, location: str | None = None) -> dict[str, dict[str, list[float]]]:
        """The entry ``uncertain`` of a sweep: a normal distribution for each number with a standard deviation.

        With ``location``, shapes of other points are omitted, because they do not affect an impact there.
        """
        means: dict[str, Floats] = {"omega_rad_s": self.omega_rad_s}
        if self.damping_ratios is not None:
            means["damping_ratios"] = self.damping_ratios
        names = self.shapes if location is None else [location]
        means |= {f"points.{name}.shape": self.shapes[name] for name in names}
        found: dict[str, dict[str, list[float]]] = {}
        for name, values in means.items():
            for k, (mean, sd) in enumerate(zip(values, self.standard_deviations.get(name, ()), strict=False)):
                if sd > 0.0:
                    found[f"structure.{name}[{k}]"] = {"normal": [float(mean), float(sd)]}
        return found

    def write_sweep(self, path: str | PathLike[str], scene: Mapping[str, Any]) -> None:
        """Writes a sweep in which the numbers of this structure are uncertain; ``scene`` has all entries but ``structure``."""
        whole = {**scene, "structure": self.modal()}
        sweep = {"scene": whole, "uncertain": self.uncertain(scene.get("location"))}
        Path(path).write_text(json.dumps(sweep, indent=2) + "\n", encoding="utf-8")


def _numbers(name: str, values: ArrayLike, count: int | None = None) -> Floats:
    numbers = np.atleast_1d(np.asarray(values, dtype=np.float64))
    if count is not None and numbers.shape != (count,):
        raise ValueError(f"{name} = {numbers.size} values is not allowed: as many as there are modes, {count}")
    if not np.all(np.isfinite(numbers)):
        raise ValueError(f"{name} is not allowed: finite numbers only")
    return numbers


def direction(name: str, given: Sequence[float]) -> Floats:
    """The unit vector along which a point is struck."""
    vector = np.asarray(given, dtype=np.float64)
    length = float(np.linalg.norm(vector)) if vector.shape == (3,) else 0.0
    if not (length > 0.0 and math.isfinite(length)):
        raise ValueError(f"direction of {name} = {given} is not allowed: three numbers, not all 0")
    return vector / length


def units(length_m: float, mass_kg: float) -> tuple[float, float]:
    """The factors to SI for mass-normalised shapes and compliances of a model whose unit of time is the second."""
    for name, value in (("length_m", length_m), ("mass_kg", mass_kg)):
        if not (value > 0.0 and math.isfinite(value)):
            raise ValueError(f"{name} = {value} is not allowed: a finite number greater than 0")
    # A shape is 1/sqrt(mass); a compliance is length/force = s^2/mass.
    return mass_kg**-0.5, 1.0 / mass_kg
