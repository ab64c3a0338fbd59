"""Frequency responses in universal files (data sets 58 and 164), as receptances in SI units.

A response at the point ``i`` to a force at ``j`` equals that at ``j`` to a force at ``i`` (Maxwell's reciprocity). A file of a roving
hammer, with one accelerometer that stays at the driving point, therefore contains the same receptances as one with many
accelerometers and a hammer that stays.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from os import PathLike, fspath
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from ._structure import Floats

Complex = NDArray[np.complex128]
# A node and its direction, 1 to 3 for x to z.
Place = tuple[int, int]

# Numbers by which the format names kinds of data.
_UNITS = 164
_FUNCTION = 58
_RESPONSE = 4
_FREQUENCY = 18
_FORCE = 13
# Kinds of response, and the power of i w by which a receptance is multiplied.
_KINDS = {8: 0, 11: 1, 12: 2}
# Complex ordinates of single and double precision.
_COMPLEX = (5, 6)

# Factors to SI of length and force, by which a file divides, for each code of a system of units but that of the user (9).
_FOOT, _INCH, _POUND, _KILOGRAM = 1 / 0.3048, 1 / 0.0254, 1 / 4.4482216152605, 1 / 9.80665
_SYSTEMS = {
    1: (1.0, 1.0),
    2: (_FOOT, _POUND),
    3: (1.0, _KILOGRAM),
    4: (_FOOT, 1 / 0.138254954376),
    5: (1e3, 1e3),
    6: (1e2, 1e2),
    7: (_INCH, _POUND),
    8: (1e3, _KILOGRAM),
}
# Units in labels of axes, with which a label begins, in SI.
_LENGTHS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "in": 0.0254, "inch": 0.0254, "ft": 0.3048, "g": 9.80665}
_FORCES = {"n": 1.0, "kn": 1e3, "lb": 4.4482216152605, "lbf": 4.4482216152605, "kgf": 9.80665, "dyn": 1e-5}
_FREQUENCIES = {"hz": 1.0, "khz": 1e3, "rpm": 1 / 60, "rad": 0.5 / math.pi}
# The line before and after a data set, which may be filled with blanks.
_END = re.compile(rb"    -1(?=[\r\n]|\Z| {74})")
# Relative difference at which units are no longer the same: files round their factors.
_SAME_UNIT = 1e-3
# Frequencies of two responses are the same within this share of the smallest distance of lines.
_SAME_LINE = 1e-3


def receptances(path: str | PathLike[str], points: Mapping[str, tuple[int, int]], driving: str) -> tuple[Floats, Complex]:
    """Receptances (m/N) between the driving point and each point, in their order, over common angular frequencies."""
    for name, place in points.items():
        if len(place) != 2 or place[1] not in (1, 2, 3):
            raise ValueError(f"point {name} = {place} is not allowed; it must be a node and a direction, 1, 2 or 3 for x, y or z")
    file = _File(path)
    drive = points[driving]
    wanted = set(points.values())
    found: dict[Place, int] = {}
    exchanged: dict[Place, int] = {}
    seen = []
    for number, header in file.functions():
        response, force = _places(header)
        seen.append((response, force))
        for here, other, place in ((found, force, response), (exchanged, response, force)):
            if other != drive or place not in wanted:
                continue
            if place in here:
                what = f"a response of {response} to a force at {force}"
                file.refuse(number, what, "another", f"the only one, and data set {here[place]} is one")
            here[place] = number
    chosen = exchanged | found
    missing = [name for name, place in points.items() if place not in chosen]
    if missing:
        raise ValueError(
            f"{fspath(path)} contains no response of {missing} to a force at {driving}, nor the reverse; it contains "
            f"(node and direction of response and force) {sorted(set(seen))}"
        )
    read = {place: file.receptance(chosen[place]) for place in wanted}
    omega = read[drive][0]
    step = np.diff(omega).min() if omega.size > 1 else 0.0
    for place in wanted:
        other_omega = read[place][0]
        if other_omega.shape != omega.shape or np.abs(other_omega - omega).max(initial=0.0) > _SAME_LINE * step:
            raise ValueError(f"{fspath(path)}: data sets {chosen[drive]} and {chosen[place]} have different frequencies")
    return omega, np.asarray([read[place][1] for place in points.values()])


class _File:
    """The data sets of a file, by their numbers from 1."""

    def __init__(self, path: str | PathLike[str]) -> None:
        import pyuff

        self.path = fspath(path)
        ends = len(_END.findall(Path(path).read_bytes()))
        if ends % 2:
            raise ValueError(f"{self.path} is not a whole universal file: it has {ends} lines -1, one before and one after each data set")
        self.file: Any = pyuff.UFF(self.path)
        self.types = [int(kind) for kind in self.file.get_set_types()] if self.file.get_n_sets() else []
        for number, kind in enumerate(self.types, start=1):
            if kind == 0:
                self.refuse(number, "type", "none", "a number; is a data set before it without its last line, -1?")
        self.length, self.force = self._units()

    def refuse(self, number: int, what: str, value: object, allowed: str) -> NoReturn:
        raise ValueError(f"{self.path}: data set {number}: {what} = {value} is not allowed; it must be {allowed}")

    def _read(self, number: int, header_only: bool = False) -> Any:
        try:
            return self.file.read_sets(number - 1, header_only=header_only)
        except Exception as error:  # pyuff raises nothing more special
            kind = self.types[number - 1]
            raise ValueError(f"{self.path}: data set {number} cannot be read; it must be a whole data set {kind} ({error})") from error

    def functions(self) -> list[tuple[int, Any]]:
        """The headers of all frequency responses."""
        headers = [(n, self._read(n, header_only=True)) for n, kind in enumerate(self.types, start=1) if kind == _FUNCTION]
        return [(number, header) for number, header in headers if header["func_type"] == _RESPONSE]

    def _units(self) -> tuple[float, float]:
        """The numbers of the file's units of length and force in a metre and a newton."""
        system: tuple[float, float] | None = None
        for number, kind in enumerate(self.types, start=1):
            if kind != _UNITS:
                continue
            units = self._read(number)
            here = (float(units["length"]), float(units["force"]))
            if not all(factor > 0.0 and math.isfinite(factor) for factor in here):
                self.refuse(number, "factors of length and force", here, "positive numbers")
            code = int(units["units_code"])
            known = _SYSTEMS.get(code, here)
            if not np.allclose(here, known, rtol=_SAME_UNIT, atol=0.0):
                self.refuse(number, "factors of length and force", here, f"{known}, those of its code of units {code}, or have the code 9")
            if system is None and _FUNCTION in self.types[: number - 1]:
                self.refuse(number, "place of the units", "after functions", "before the functions (58) whose units they are")
            if system is not None and not np.allclose(here, system, rtol=_SAME_UNIT, atol=0.0):
                self.refuse(number, "factors of length and force", here, f"{system}, those of the data set of units before it")
            system = here
        return system or (1.0, 1.0)

    def receptance(self, number: int) -> tuple[Floats, Complex]:
        """Angular frequencies above 0 (rad/s) and the receptance there (m/N)."""
        data = self._read(number)
        for what, key, allowed in (
            ("load case", "load_case_id", {0: "0: excitation at a single point"}),
            ("data type of the ordinate", "ord_data_type", dict.fromkeys(_COMPLEX, "5 or 6: complex numbers")),
            ("kind of the abscissa", "abscissa_spec_data_type", {_FREQUENCY: "18: frequency"}),
            ("kind of the ordinate", "ordinate_spec_data_type", dict.fromkeys(_KINDS, "8, 11 or 12: displacement, velocity, acceleration")),
            ("kind of the denominator", "orddenom_spec_data_type", {_FORCE: "13: excitation force"}),
        ):
            if int(data[key]) not in allowed:
                self.refuse(number, what, int(data[key]), next(iter(allowed.values())))
        kind = int(data["ordinate_spec_data_type"])
        for what, key, sizes, unit in (
            ("unit of the abscissa", "abscissa_axis_units_lab", _FREQUENCIES, 1.0),
            ("unit of the ordinate", "ordinate_axis_units_lab", _LENGTHS, 1.0 / self.length),
            ("unit of the denominator", "orddenom_axis_units_lab", _FORCES, 1.0 / self.force),
        ):
            label = str(data.get(key, ""))
            size = sizes.get(_first_word(label))
            if size is not None and abs(size / unit - 1.0) > _SAME_UNIT:
                own = f"the unit of the file's numbers, which is {unit:g} in SI (by data set 164, or without it 1)"
                self.refuse(number, what, repr(label.strip()), own)
        frequency, values = np.asarray(data["x"], dtype=np.float64), np.asarray(data["data"], dtype=np.complex128)
        stated = int(data["num_pts"])
        if not len(frequency) == len(values) == stated:
            self.refuse(number, "number of values", len(values), f"{stated}, as its header states: is the file cut off?")
        if not (np.all(np.isfinite(values)) and np.all(np.isfinite(frequency))):
            self.refuse(number, "a value", "not a finite number", "a finite number")
        if np.any(np.diff(frequency) <= 0.0) or np.any(frequency < 0.0):
            self.refuse(number, "frequencies", "not ascending from 0 or above", "positive and ascending")
        above = frequency > 0.0
        omega = 2.0 * math.pi * frequency[above]
        sign = math.copysign(1.0, data["rsp_dir"]) * math.copysign(1.0, data["ref_dir"])
        return omega, sign * self.force / self.length * values[above] / (1j * omega) ** _KINDS[kind]


def _places(header: Any) -> tuple[Place, Place]:
    """Where the response is measured, and where the force acts."""
    return (
        (int(header["rsp_node"]), abs(int(header["rsp_dir"]))),
        (int(header["ref_node"]), abs(int(header["ref_dir"]))),
    )


def _first_word(label: str) -> str:
    word = re.match(r"[\s(\[]*([a-zµμ]+)", label.lower())
    return word[1].replace("µ", "u").replace("μ", "u") if word else ""
