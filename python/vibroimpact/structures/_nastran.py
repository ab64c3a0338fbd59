"""Nastran: modes and static displacements from binary ``.op2`` files, by pyNastran."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from os import PathLike, fspath
from pathlib import Path
from typing import Any

import numpy as np

from ._structure import Floats, Structure, damping_of_modes, direction, frequencies, static_compliances, units


# Eigenvalues of a table and of vectors are the same within this share, and this share of the largest.
_SAME = 1e-4
_SAME_OF_LARGEST = 1e-9


def from_nastran(
    op2: str | PathLike[str],
    points: Mapping[str, tuple[int, Sequence[float]]],
    static: Mapping[str, str | PathLike[str] | tuple[str | PathLike[str], int]] | None = None,
    *,
    subcase: int | None = None,
    modal_masses: Sequence[float] | float | None = None,
    force: float = 1.0,
    damping_ratios: Sequence[float] | float | None = None,
    length_m: float = 1.0,
    mass_kg: float = 1.0,
) -> Structure:
    """Reads the modes of SOL 103.

    ``points`` gives the grid point and the direction of each point that may be struck, ``{"tip": (21, (0, 0, 1))}``;
    ``static`` names, for points whose compliance is needed, the ``.op2`` of SOL 101 in which ``force`` loads the
    point along its direction. If a file has several subcases, ``subcase`` states that of the modes, and a pair
    ``(file, subcase)`` that of a static load. Shapes of any normalisation are scaled to unit modal mass by the generalised masses in
    the table of eigenvalues. For a file without this table (MYSTRAN's), ``modal_masses`` states them in the model's unit of mass, a number
    for each mode or one for all: 1 for shapes normalised to mass (``NORM=MASS`` of ``EIGRL``), not for ``NORM=MAX``.
    """
    shape_factor, compliance_factor = units(length_m, mass_kg)
    nodes = {name: (node, direction(name, along)) for name, (node, along) in points.items()}
    model = _read(op2)
    vectors = _of_subcase(model.eigenvectors, op2, subcase, "eigenvectors: DISPLACEMENT(PLOT) = ALL", "subcase=NUMBER")
    values = np.asarray(vectors.eigns, dtype=np.float64)
    omega = frequencies(op2, values)
    masses = _masses(model, op2, values, modal_masses)
    shapes = {name: _at(vectors, node, op2) @ along / np.sqrt(masses) for name, (node, along) in nodes.items()}
    moved: dict[str, dict[str, float]] = {}
    files: dict[str, str | PathLike[str]] = {}
    for name, load in (static or {}).items():
        if name not in nodes:
            raise ValueError(f"static {name!r} is not allowed; it must be one of the points {list(nodes)}")
        files[name], case = load if isinstance(load, tuple) else (load, None)
        file = files[name]
        loaded = _of_subcase(_read(file).displacements, file, case, "displacements", f"static={{{name!r}: (file, NUMBER)}}")
        if len(loaded.data) != 1:
            raise ValueError(f"{fspath(file)} contains {len(loaded.data)} displacements of one subcase: one linear static load is needed")
        seen = {other: pair for other, pair in nodes.items() if other == name or pair[0] in loaded.node_gridtype[:, 0]}
        moved[name] = {other: float(_at(loaded, node, file)[0] @ along) for other, (node, along) in seen.items()}
    compliances = static_compliances(force, omega, shapes, moved, files)
    damping = damping_of_modes(damping_ratios, len(omega))
    return Structure(
        omega_rad_s=omega,
        shapes={name: shape * shape_factor for name, shape in shapes.items()},
        damping_ratios=damping,
        static_compliances_m_n={name: value * compliance_factor for name, value in compliances.items()},
    )


def _read(path: str | PathLike[str]) -> Any:
    from pyNastran.op2.op2 import OP2

    if not Path(path).is_file():
        raise FileNotFoundError(f"there is no file {fspath(path)}")
    model = OP2(debug=None)
    try:
        model.read_op2(fspath(path))
    except Exception as error:  # pyNastran passes on whatever it meets in a file that is cut off
        raise ValueError(f"{fspath(path)} cannot be read; it must be a whole .op2 file: is it cut off?") from error
    return model


def _of_subcase(results: Mapping[Any, Any], path: str | PathLike[str], subcase: int | None, what: str, argument: str) -> Any:
    """The result of a subcase, which need not be stated if there is only one."""
    if not results:
        raise ValueError(f"{fspath(path)} contains no {what}")
    cases = [int(result.isubcase) for result in results.values()]
    chosen = [result for result, case in zip(results.values(), cases, strict=True) if subcase in (None, case)]
    if not chosen:
        raise ValueError(f"{fspath(path)}: subcase = {subcase} is not allowed; it must be one of {sorted(set(cases))}")
    if len(chosen) > 1:
        labels = [f"{case} {result.subtitle or result.label or ''}".strip() for case, result in zip(cases, results.values(), strict=True)]
        state = f"state one by {argument}" if len(set(cases)) == len(cases) else "a file with one result for each subcase is needed"
        raise ValueError(f"{fspath(path)} contains {len(chosen)} results, of the subcases {labels}: {state}")
    if np.iscomplexobj(chosen[0].data):
        raise ValueError(f"{fspath(path)} contains complex {what}: real ones are needed, of SOL 103 or 101")
    return chosen[0]


def _masses(model: Any, path: str | PathLike[str], values: Floats, stated: Sequence[float] | float | None) -> Floats:
    """The generalised masses, from the table with the eigenvalues of the vectors if the file has it."""
    largest = float(np.abs(values).max())
    for table in model.eigenvalues.values():
        same = np.asarray(table.eigenvalues, dtype=np.float64)[: values.size]
        if same.shape == values.shape and np.allclose(same, values, rtol=_SAME, atol=_SAME_OF_LARGEST * largest):
            if stated is not None:
                raise ValueError(f"modal_masses = {stated} is not allowed; it must be left out, because {fspath(path)} contains them")
            found = np.asarray(table.generalized_mass, dtype=np.float64)[: values.size]
            what = f"{fspath(path)}: generalised mass"
            break
    else:
        if stated is None:
            raise ValueError(
                f"{fspath(path)} contains no table of eigenvalues with the generalised masses of its shapes: state modal_masses, "
                "1 if they are normalised to mass (NORM=MASS of EIGRL, not NORM=MAX)"
            )
        found = np.asarray(stated, dtype=np.float64)
        if found.shape not in ((), values.shape):
            allowed = f"one number, or one for each of {values.size} modes"
            raise ValueError(f"modal_masses = {found.size} numbers is not allowed; it must be {allowed}")
        found, what = np.broadcast_to(found, values.shape), "modal_masses"
    if not np.all((found > 0.0) & np.isfinite(found)):
        raise ValueError(f"{what} = {found.min()} is not allowed; it must be a positive number")
    return found


def _at(result: Any, node: int, path: str | PathLike[str]) -> Floats:
    """Translations of a grid point, a row for each mode or load."""
    places = np.flatnonzero(result.node_gridtype[:, 0] == node)
    if places.size == 0:
        raise ValueError(f"grid point {node} is not in {fspath(path)}")
    return np.asarray(result.data[:, places[0], :3], dtype=np.float64)
