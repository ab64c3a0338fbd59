"""CalculiX: frequencies from the ``.dat`` file, shapes and static displacements from ``.frd`` files."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path

import numpy as np

from ._structure import Floats, Structure, damping_of_modes, direction, frequencies, static_compliances, units

_NUMBER = r"[-+]?\d\.\d+E[-+]\d+"
# Relative difference of the eigenvalues of a mode in two files, which have six and seven digits.
_SAME = 2e-5
# The format of an ASCII file with ten digits for a node.
_LONG = 1


@dataclass
class _Block:
    """Displacements node by node; of a mode with its number and its eigenvalue."""

    mode: int | None
    eigenvalue: float | None
    nodes: dict[int, Floats]


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
    to the ASCII ``.frd`` with six digits; its shapes are mass-normalised. Nodes of shells and beams have their own numbers
    only with ``OUTPUT=2D``; without it they are expanded to solids with other nodes.
    """
    shape_factor, compliance_factor = units(length_m, mass_kg)
    # A structure that carries a static load is supported.
    eigenvalues = _eigenvalues(Path(dat))
    omega = frequencies(dat, eigenvalues, supported=bool(static))
    nodes = {name: (node, direction(name, along)) for name, (node, along) in points.items()}
    # A job may contain steps before that of the modes, such as a static preload.
    blocks = [block for block in _displacements(Path(frd)) if block.mode is not None]
    if [block.mode for block in blocks] != list(range(1, len(omega) + 1)):
        raise ValueError(
            f"{fspath(frd)} contains {len(blocks)} shapes, and {fspath(dat)} {len(omega)} frequencies: "
            "a job with one *FREQUENCY step, which writes U for every mode"
        )
    for block, value in zip(blocks, eigenvalues, strict=True):
        if block.eigenvalue is not None and not math.isclose(block.eigenvalue, value, rel_tol=_SAME):
            raise ValueError(
                f"{fspath(frd)}: the eigenvalue of mode {block.mode} = {block.eigenvalue} is not allowed; it must be {value}, that in "
                f"{fspath(dat)}: are both files of the same job?"
            )
    shapes = {name: np.array([_at(block, node, frd) @ along for block in blocks]) for name, (node, along) in nodes.items()}
    moved: dict[str, dict[str, float]] = {}
    for name, file in (static or {}).items():
        if name not in nodes:
            raise ValueError(f"static {name!r} is not allowed; it must be one of the points {list(nodes)}")
        loaded = [block for block in _displacements(Path(file)) if block.mode is None]
        if len(loaded) != 1:
            raise ValueError(
                f"{fspath(file)} contains {len(loaded)} static displacements: a job with one linear *STATIC step, which writes U"
            )
        seen = {other: pair for other, pair in nodes.items() if other == name or pair[0] in loaded[0].nodes}
        moved[name] = {other: float(_at(loaded[0], node, file) @ along) for other, (node, along) in seen.items()}
    compliances = static_compliances(force, omega, shapes, moved, static or {})
    damping = damping_of_modes(damping_ratios, len(omega))
    return Structure(
        omega_rad_s=omega,
        shapes={name: shape * shape_factor for name, shape in shapes.items()},
        damping_ratios=damping,
        static_compliances_m_n={name: value * compliance_factor for name, value in compliances.items()},
    )


def _at(block: _Block, node: int, file: str | PathLike[str]) -> Floats:
    if node not in block.nodes:
        raise ValueError(
            f"node {node} is not in {fspath(file)}: add it to the NSET of *NODE FILE; if it belongs to a shell or a beam, write it with "
            "OUTPUT=2D"
        )
    return block.nodes[node]


def _eigenvalues(path: Path) -> Floats:
    text = path.read_text(encoding="ascii", errors="replace")
    table = text.partition("E I G E N V A L U E   O U T P U T")[2].partition("P A R T I C I P A T I O N")[0]
    eigenvalues = [float(found[1]) for found in re.finditer(rf"^\s*\d+\s+({_NUMBER})\s+{_NUMBER}", table, re.MULTILINE)]
    if not eigenvalues:
        raise ValueError(f"{path} contains no eigenvalues: run a *FREQUENCY step")
    return np.asarray(eigenvalues)


def _displacements(path: Path) -> list[_Block]:
    """The blocks ``DISP`` of an ASCII ``.frd``, in its fixed columns."""
    blocks: list[_Block] = []
    nodes: dict[int, Floats] | None = None
    mode: int | None = None
    eigenvalue: float | None = None
    stated = 0
    lines = path.read_text(encoding="ascii", errors="replace").rstrip().splitlines()
    if not lines or lines[-1].lstrip() != "9999":
        raise ValueError(f"{path} is not a whole .frd file: it must end with the line 9999; is it cut off, or is the job still running?")
    for number, line in enumerate(lines, start=1):
        try:
            if line.startswith("    1PSTEP"):
                mode = eigenvalue = None
            elif line.startswith("    1PMODE"):
                mode = int(line.split()[1])
            elif line.startswith("    1PGK"):
                eigenvalue = float(line.split()[1])
            elif line.startswith("  100C"):
                stated, kind = int(line[24:36]), int(line[73:75])
                if kind != _LONG:
                    raise ValueError(f"format {kind} of its results is not allowed; it must be {_LONG}, text with long node numbers")
            elif line.startswith(" -4"):
                nodes = {} if line[5:].startswith("DISP") else None
                if nodes is not None:
                    blocks.append(_Block(mode, eigenvalue if mode is not None else None, nodes))
            elif line.startswith(" -3"):
                if nodes is not None and len(nodes) != stated:
                    raise ValueError(f"{len(nodes)} displacements are not allowed; there must be {stated}, as their head states")
                nodes = None
            elif nodes is not None and line.startswith(" -1"):
                nodes[int(line[3:13])] = np.array([float(line[13 + 12 * k : 25 + 12 * k]) for k in range(3)])
        except (ValueError, IndexError) as error:
            raise ValueError(f"{path}, line {number}: {error}") from error
    return blocks
