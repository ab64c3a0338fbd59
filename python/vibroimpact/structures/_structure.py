"""The result of every reader, and its output."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from os import PathLike, fspath
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
            raise ValueError(f"omega_rad_s = {self.omega_rad_s.min()} is not allowed; it must be 0 or a positive number")
        if not self.shapes:
            raise ValueError("shapes are missing: at least one named point is needed")
        for name in self.shapes:
            if not name or name in _TAKEN:
                raise ValueError(f"point {name!r} is not allowed; it must be a name other than {', '.join(_TAKEN)}")
        self.shapes = {name: _numbers(f"shapes of {name}", shape, count) for name, shape in self.shapes.items()}
        if self.damping_ratios is not None:
            self.damping_ratios = _numbers("damping_ratios", self.damping_ratios, count)
            if np.any(self.damping_ratios < 0.0):
                raise ValueError(f"damping_ratios = {self.damping_ratios.min()} is not allowed; it must be 0 or a positive number")
        for name, compliance in self.static_compliances_m_n.items():
            if name not in self.shapes:
                raise ValueError(f"static compliance of {name!r} is not allowed; it must be one of the points {list(self.shapes)}")
            if not (compliance >= 0.0 and math.isfinite(compliance)):
                raise ValueError(f"static compliance of {name} = {compliance} is not allowed; it must be 0 or a positive number")

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
        """The entry ``uncertain`` of a sweep: a distribution for each number with a standard deviation.

        Frequencies and damping ratios are positive. Their distribution is lognormal, with the mean and the standard deviation
        that were measured; that of shapes is normal. With ``location``, shapes of other points are omitted, because they do
        not affect an impact there.
        """
        if location is not None and location not in self.shapes:
            raise ValueError(f"location = {location!r} is not allowed; it must be one of the points {list(self.shapes)}")
        means: dict[str, Floats] = {"omega_rad_s": self.omega_rad_s}
        if self.damping_ratios is not None:
            means["damping_ratios"] = self.damping_ratios
        names = self.shapes if location is None else [location]
        means |= {f"points.{name}.shape": self.shapes[name] for name in names}
        found: dict[str, dict[str, list[float]]] = {}
        for name, values in means.items():
            for k, (mean, sd) in enumerate(zip(values, self.standard_deviations.get(name, ()), strict=False)):
                if sd > 0.0:
                    place = f"{name}[{k}]"
                    positive = name in ("omega_rad_s", "damping_ratios")
                    found[f"structure.{place}"] = (
                        {"lognormal": _lognormal(place, float(mean), float(sd))}
                        if positive
                        else {"normal": [float(mean), float(sd)]}
                    )
        return found

    def write_sweep(self, path: str | PathLike[str], scene: Mapping[str, Any]) -> None:
        """Writes a sweep in which the numbers of this structure are uncertain; ``scene`` has all entries but ``structure``.

        The compliance of the modes that are not listed stays the same in every draw, so that the static compliance varies with
        the listed modes.
        """
        uncertain = self.uncertain(scene.get("location"))
        if not uncertain:
            raise ValueError("standard_deviations are missing: at least one number with a standard deviation is needed")
        structure = self.modal()
        for name in self.static_compliances_m_n:
            point = structure["points"][name]
            del point["static_compliance_m_n"]
            point["residual_compliance_m_n"] = self._residual_compliance_m_n(name)
        sweep = {"scene": {**scene, "structure": structure}, "uncertain": uncertain}
        Path(path).write_text(json.dumps(sweep, indent=2) + "\n", encoding="utf-8")

    def _residual_compliance_m_n(self, name: str) -> float:
        """The static compliance at a point less that of the listed modes."""
        elastic = self.omega_rad_s > 0.0
        listed = float(np.sum((self.shapes[name][elastic] / self.omega_rad_s[elastic]) ** 2))
        whole = self.static_compliances_m_n[name]
        if whole < listed * (1.0 - _ROUNDING):
            raise ValueError(f"static compliance of {name} = {whole} is not allowed; it must be not less than that of the listed modes, {listed}")
        return max(whole - listed, 0.0)


def _lognormal(name: str, mean: float, sd: float) -> list[float]:
    """Median, and standard deviation of the logarithm, of the lognormal distribution with this mean and standard deviation."""
    if mean <= 0.0:
        raise ValueError(f"{name} = {mean} with the standard deviation {sd} is not allowed; it must be positive, or have no standard deviation")
    square = math.log1p((sd / mean) ** 2)
    return [mean * math.exp(-0.5 * square), math.sqrt(square)]


def _numbers(name: str, values: ArrayLike, count: int | None = None) -> Floats:
    numbers = np.atleast_1d(np.asarray(values, dtype=np.float64))
    if count is not None and numbers.shape != (count,):
        raise ValueError(f"{name} = {numbers.size} values is not allowed; it must be as long as the number of modes, {count}")
    if not np.all(np.isfinite(numbers)):
        raise ValueError(f"{name} is not allowed; it must be a list of finite numbers")
    return numbers


# Eigenvalues below this share of the next one are those of rigid-body modes, of which a body has at most six. The frequencies then
# differ by a factor of 1000, which only an extremely soft support would cause.
_GAP = 1e-6
_MOST_RIGID = 6
# A negative eigenvalue of at most this share of the lowest positive one is zero to rounding.
_NEGATIVE = 1e-3
# Displacements of two files, or those of a file and of its modes, agree within this share of the largest.
_FROM_FILES = 1e-3
# The compliance of the listed modes may exceed the stated one by this share.
_ROUNDING = 1e-9


def frequencies(path: str | PathLike[str], eigenvalues: Floats, supported: bool = False) -> Floats:
    """Angular frequencies from the eigenvalues that a program has written; those of rigid-body modes are 0.

    A program writes the eigenvalue of a rigid-body mode with its rounding, of either sign. How large that is depends on the mesh,
    which is not known here, so that only a gap distinguishes it from an elastic mode. A structure that is known to be ``supported`` has no
    rigid-body modes.
    """
    values = np.array(eigenvalues, dtype=np.float64)
    sizes = np.sort(np.abs(values))
    last = 0 if supported else min(_MOST_RIGID, len(sizes) - 1)
    gaps = [k for k in range(1, last + 1) if sizes[k - 1] <= _GAP * sizes[k]]
    elastic = sizes[max(gaps, default=0)]
    values[np.abs(values) < elastic] = 0.0
    positive = values[values > 0.0]
    if not supported and positive.size:
        values[(values < 0.0) & (-values <= _NEGATIVE * positive.min())] = 0.0
    if np.any(values < 0.0):
        raise ValueError(
            f"{fspath(path)}: the eigenvalue {values.min()} is not allowed; it must be 0 or a positive number, because an unstable structure has no modes"
        )
    return np.asarray(np.sqrt(values))


def damping_of_modes(given: ArrayLike | None, count: int) -> Floats | None:
    """A damping ratio for each mode, from a list of them or one for all."""
    if given is None:
        return None
    ratios = np.asarray(given, dtype=np.float64)
    return _numbers("damping_ratios", np.full(count, ratios) if ratios.ndim == 0 else ratios, count)


def direction(name: str, given: Sequence[float]) -> Floats:
    """The unit vector along which a point is struck."""
    vector = np.asarray(given, dtype=np.float64)
    length = float(np.linalg.norm(vector)) if vector.shape == (3,) else 0.0
    if not (length > 0.0 and math.isfinite(length)):
        raise ValueError(f"direction of {name} = {given} is not allowed; it must be three numbers that are not all 0")
    return vector / length


def units(length_m: float, mass_kg: float) -> tuple[float, float]:
    """The factors to SI for mass-normalised shapes and compliances of a model whose unit of time is the second."""
    for name, value in (("length_m", length_m), ("mass_kg", mass_kg)):
        if not (value > 0.0 and math.isfinite(value)):
            raise ValueError(f"{name} = {value} is not allowed; it must be a finite number greater than 0")
    # A shape is 1/sqrt(mass); a compliance is length/force = s^2/mass.
    return mass_kg**-0.5, 1.0 / mass_kg


def static_compliances(
    force: float,
    omega: Floats,
    shapes: Mapping[str, Floats],
    moved: Mapping[str, Mapping[str, float]],
    files: Mapping[str, str | PathLike[str]],
) -> dict[str, float]:
    """Compliances of the points at which static loads act, in the unit of the shapes.

    ``moved`` gives, for each loaded point, the displacement of this point and of others of which the file has it. Loads and modes must
    belong together: a point moves at least as much as by its listed modes, and two points move each other equally (Maxwell's reciprocity).
    """
    if not (math.isfinite(force) and force != 0.0):
        raise ValueError(f"force = {force} is not allowed; it must be a finite number other than 0")
    elastic = omega > 0.0
    for name, displacements in moved.items():
        own = displacements[name] / force
        where = f"{fspath(files[name])}: the displacement of {name} along its direction = {displacements[name]}"
        if not own > 0.0:
            raise ValueError(
                f"{where} is not allowed; it must have the sign of the force, {force}: is the point loaded in this file, along its "
                "direction?"
            )
        listed = float(np.sum((shapes[name][elastic] / omega[elastic]) ** 2))
        if own < listed * (1.0 - _FROM_FILES):
            raise ValueError(
                f"{where} is not allowed; it must be at least {listed * abs(force)} in size, that of the listed modes: is it this point "
                f"that the file loads, by {force}?"
            )
        for other, there in displacements.items():
            if other in moved and name in moved[other]:
                back = moved[other][name]
                scale = math.sqrt(abs(displacements[name] * moved[other][other]))
                if abs(there - back) > _FROM_FILES * scale:
                    raise ValueError(
                        f"{fspath(files[name])}: the displacement of {other} = {there} is not allowed; it must be {back}, that of "
                        f"{name} in {fspath(files[other])}: does each file load the point for which it is stated?"
                    )
    return {name: displacements[name] / force for name, displacements in moved.items()}
