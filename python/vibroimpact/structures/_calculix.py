"""CalculiX: frequencies from the ``.dat`` file, shapes and static displacements from ``.frd`` files."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from os import PathLike, fspath
from pathlib import Path

import numpy as np

from ._structure import Floats, Structure, direction, frequencies, units

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

    Steps before it, such as a static preload, are passed over. ``points`` gives the node and the direction of each point that
    may be struck, ``{"tip": (293, (0, 0, 1))}``. ``static`` names, for points whose compliance is needed, the ``.frd`` of a
    job with one linear ``*STATIC`` step that loads the point by ``force`` along its direction. CalculiX writes displacements
    to the ASCII ``.frd`` with six digits; its shapes are mass-normalised.
    """
    shape_factor, compliance_factor = units(length_m, mass_kg)
    # A structure that carries a static load is supported.
    omega = frequencies(dat, _eigenvalues(Path(dat)), supported=bool(static))
    nodes = {name: (node, direction(name, along)) for name, (node, along) in points.items()}
    # A job may contain steps before that of the modes, such as a static preload.
    written = [(mode, block) for mode, block in _displacements(Path(frd)) if mode is not None]
    if [mode for mode, _ in written] != list(range(1, len(omega) + 1)):
        raise ValueError(
            f"{fspath(frd)} contains {len(written)} shapes, and {fspath(dat)} {len(omega)} frequencies: "
            "a job with one *FREQUENCY step, which writes U for every mode"
        )
    blocks = [block for _, block in written]
    shapes = {name: [_at(block, node, frd) @ along for block in blocks] for name, (node, along) in nodes.items()}
    compliances = {}
    for name, file in (static or {}).items():
        if name not in nodes:
            raise ValueError(f"static {name!r} is not allowed; it must be one of the points {list(nodes)}")
        node, along = nodes[name]
        loaded = [block for mode, block in _displacements(Path(file)) if mode is None]
        if len(loaded) != 1:
            raise ValueError(
                f"{fspath(file)} contains {len(loaded)} static displacements: a job with one linear *STATIC step, which writes U"
            )
        compliances[name] = float(_at(loaded[0], node, file) @ along) / force * compliance_factor
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


def _eigenvalues(path: Path) -> Floats:
    text = path.read_text(encoding="ascii", errors="replace")
    table = text.partition("E I G E N V A L U E   O U T P U T")[2].partition("P A R T I C I P A T I O N")[0]
    eigenvalues = [float(found[1]) for found in re.finditer(rf"^\s*\d+\s+({_NUMBER})\s+{_NUMBER}", table, re.MULTILINE)]
    if not eigenvalues:
        raise ValueError(f"{path} contains no eigenvalues: run a *FREQUENCY step")
    return np.asarray(eigenvalues)


def _displacements(path: Path) -> list[tuple[int | None, dict[int, Floats]]]:
    """The blocks ``DISP`` of an ASCII ``.frd``, node by node, in their fixed columns; each with its number if it is a mode."""
    blocks: list[tuple[int | None, dict[int, Floats]]] = []
    block: dict[int, Floats] | None = None
    mode: int | None = None
    with path.open(encoding="ascii", errors="replace") as file:
        for line in file:
            if line.startswith("    1PSTEP"):
                mode = None
            elif line.startswith("    1PMODE"):
                mode = int(line.split()[1])
            elif line.startswith(" -4"):
                block = {} if line[5:].startswith("DISP") else None
                if block is not None:
                    blocks.append((mode, block))
            elif line.startswith(" -3"):
                block = None
            elif block is not None and line.startswith(" -1"):
                block[int(line[3:13])] = np.array([float(line[13 + 12 * k : 25 + 12 * k]) for k in range(3)])
    return blocks
