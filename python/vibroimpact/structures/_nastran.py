"""Nastran: modes and static displacements from binary ``.op2`` files, by pyNastran."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from os import PathLike, fspath
from typing import Any

import numpy as np

from ._structure import Floats, Structure, direction, frequencies, units


def from_nastran(
    op2: str | PathLike[str],
    points: Mapping[str, tuple[int, Sequence[float]]],
    static: Mapping[str, str | PathLike[str]] | None = None,
    *,
    force: float = 1.0,
    damping_ratios: Sequence[float] | float | None = None,
    length_m: float = 1.0,
    mass_kg: float = 1.0,
) -> Structure:
    """Reads the modes of SOL 103.

    ``points`` gives the grid point and the direction of each point that may be struck, ``{"tip": (21, (0, 0, 1))}``;
    ``static`` names, for points whose compliance is needed, the ``.op2`` of SOL 101 in which ``force`` loads the
    point along its direction. Shapes of any normalisation are scaled to unit modal mass by the table of
    eigenvalues; a file without one (MYSTRAN's) must contain mass-normalised shapes, ``NORM=MASS`` of EIGRL.
    """
    shape_factor, compliance_factor = units(length_m, mass_kg)
    nodes = {name: (node, direction(name, along)) for name, (node, along) in points.items()}
    model = _read(op2)
    vectors = _first(model.eigenvectors, op2, "eigenvectors: DISPLACEMENT(PLOT) = ALL")
    count = vectors.data.shape[0]
    omega = frequencies(op2, np.asarray(vectors.eigns, dtype=np.float64))
    table = next(iter(model.eigenvalues.values()), None)
    masses = np.ones(count) if table is None else np.asarray(table.generalized_mass, dtype=np.float64)[:count]
    shapes = {
        name: _at(vectors, node, op2) @ along / np.sqrt(masses) * shape_factor for name, (node, along) in nodes.items()
    }
    compliances = {}
    for name, file in (static or {}).items():
        if name not in nodes:
            raise ValueError(f"static {name!r} is not allowed; it must be one of the points {list(nodes)}")
        node, along = nodes[name]
        loaded = _first(_read(file).displacements, file, "displacements")
        compliances[name] = float(_at(loaded, node, file)[-1] @ along) / force * compliance_factor
    damping = None if damping_ratios is None else np.broadcast_to(np.asarray(damping_ratios, dtype=float), omega.shape)
    return Structure(
        omega_rad_s=omega, shapes=shapes, damping_ratios=damping, static_compliances_m_n=compliances
    )


def _read(path: str | PathLike[str]) -> Any:
    from pyNastran.op2.op2 import OP2

    model = OP2(debug=None)
    model.read_op2(fspath(path))
    return model


def _first(results: Mapping[Any, Any], path: str | PathLike[str], what: str) -> Any:
    if not results:
        raise ValueError(f"{fspath(path)} contains no {what}")
    return next(iter(results.values()))


def _at(result: Any, node: int, path: str | PathLike[str]) -> Floats:
    """Translations of a grid point, a row for each mode or load."""
    places = np.flatnonzero(result.node_gridtype[:, 0] == node)
    if places.size == 0:
        raise ValueError(f"grid point {node} is not in {fspath(path)}")
    return np.asarray(result.data[:, places[0], :3], dtype=np.float64)
