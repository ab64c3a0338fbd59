"""CalculiX: frequencies from the ``.dat`` file, shapes and static displacements from ``.frd`` files."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path

import numpy as np

from ._structure import Floats, Structure, direction, units

_NUMBER = r"[-+]?\d\.\d+E[-+]\d+"


def from_calculix(
    dat: str | PathLike[str],
    frd: str | PathLike[str],
    points: Mapping[str, tuple[int, Sequence[float]]],
    static: Mapping[str, str | PathLike[str]] | None = None,
    *,
    force: float = 1.0,
    damping_ratios: Sequence[float] | float | None = None,
    length_m: float = 1.0,
    mass_kg: float = 1.0,
) -> Structure:
    """Modes of a ``*FREQUENCY`` step.

    ``points`` gives the node and the direction of each point that may be struck, ``{"tip": (293, (0, 0, 1))}``.
    ``static`` names, for points whose compliance is needed, the ``.frd`` of a ``*STATIC`` step that loads the point
    by ``force`` along its direction. CalculiX writes displacements to the ASCII ``.frd`` with six digits; its shapes are
    mass-normalised.
    """
    shape_factor, compliance_factor = units(length_m, mass_kg)
    omega = _frequencies(Path(dat))
    nodes = {name: (node, direction(name, along)) for name, (node, along) in points.items()}
    blocks = _displacements(Path(frd))
    if len(blocks) < len(omega):
        raise ValueError(f"{frd} contains {len(blocks)} shapes, and {dat} {len(omega)} frequencies: write U for every mode")
    shapes = {name: [_at(block, node, frd) @ along for block in blocks[: len(omega)]] for name, (node, along) in nodes.items()}
    compliances = {}
    for name, file in (static or {}).items():
        if name not in nodes:
            raise ValueError(f"static {name!r} is not allowed: one of the points {list(nodes)}")
        node, along = nodes[name]
        loaded = _displacements(Path(file))
        if not loaded:
            raise ValueError(f"{file} contains no displacements: *NODE FILE with U")
        compliances[name] = float(_at(loaded[-1], node, file) @ along) / force * compliance_factor
    damping = None if damping_ratios is None else np.broadcast_to(np.asarray(damping_ratios, dtype=float), omega.shape)
    return Structure(
        omega_rad_s=omega,
        shapes={name: np.asarray(shape) * shape_factor for name, shape in shapes.items()},
        damping_ratios=damping,
        static_compliances_m_n=compliances,
    )


def _at(block: dict[int, Floats], node: int, file: str | PathLike[str]) -> Floats:
    if node not in block:
        raise ValueError(f"node {node} is not in {file}: add it to the NSET of *NODE FILE")
    return block[node]


def _frequencies(path: Path) -> Floats:
    """Angular frequencies; an eigenvalue that is zero to rounding is that of a rigid-body mode."""
    text = path.read_text(encoding="ascii", errors="replace")
    table = text.partition("E I G E N V A L U E   O U T P U T")[2].partition("P A R T I C I P A T I O N")[0]
    eigenvalues = [float(found[1]) for found in re.finditer(rf"^\s*\d+\s+({_NUMBER})\s+{_NUMBER}", table, re.MULTILINE)]
    if not eigenvalues:
        raise ValueError(f"{path} contains no eigenvalues: run a *FREQUENCY step")
    values = np.asarray(eigenvalues)
    # An eigenvalue that is negligible relative to the largest is that of a rigid-body mode.
    values[np.abs(values) < 1e-9 * np.abs(values).max()] = 0.0
    if np.any(values < 0.0):
        raise ValueError(f"{path} contains the eigenvalue {values.min()}: an unstable structure has no modes")
    return np.asarray(np.sqrt(values))


def _displacements(path: Path) -> list[dict[int, Floats]]:
    """The blocks ``DISP`` of an ASCII ``.frd``, node by node, in their fixed columns."""
    blocks: list[dict[int, Floats]] = []
    block: dict[int, Floats] | None = None
    with path.open(encoding="ascii", errors="replace") as file:
        for line in file:
            if line.startswith(" -4"):
                block = {} if line[5:].startswith("DISP") else None
                if block is not None:
                    blocks.append(block)
            elif line.startswith(" -3"):
                block = None
            elif block is not None and line.startswith(" -1"):
                block[int(line[3:13])] = np.array([float(line[13 + 12 * k : 25 + 12 * k]) for k in range(3)])
    return blocks
