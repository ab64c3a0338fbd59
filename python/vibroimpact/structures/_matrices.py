"""Modes and static compliances from stiffness and mass matrices.

With ``K`` and ``M`` the pencil ``K x = omega^2 M x`` is solved for its lowest modes by Lanczos' method with a shift
(scipy's ``eigsh``), and the eigenvalue of each vector is its Rayleigh quotient ``x^T K x``. The rounding of the entries
of ``K`` by a share ``e`` changes that by at most ``e |x|^T |K| |x|``; a mode whose eigenvalue is of this size is one of a rigid
body. The static compliance at a point with the load vector ``f`` is ``f^T K^-1 f``. For a structure that moves freely, it is
that of the elastic modes alone: the load is balanced by inertia, ``g = f - M R R^T f`` with the mass-normalised rigid-body
modes ``R``, and the solution of ``K x + M R y = g`` is the one with ``R^T M x = 0``.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ._structure import Floats, Structure, units

# Eigenvalues of rigid-body modes are below this multiple of the effect of rounding: sums of rounded entries are rounded as well.
_RIGID = 4.0


def from_matrices(
    stiffness: Any,
    mass: Any,
    points: Mapping[str, int | ArrayLike],
    count: int,
    *,
    damping_ratios: Sequence[float] | float | None = None,
    shift: float | None = None,
    rounding: float = float(np.finfo(np.float64).eps),
    length_m: float = 1.0,
    mass_kg: float = 1.0,
) -> Structure:
    """Computes the ``count`` lowest modes.

    ``stiffness`` and ``mass`` are Matrix Market files or scipy.sparse matrices, symmetric, without the fixed degrees of freedom.
    ``points`` gives, for each point that may be struck, its degree of freedom (from 0) or a vector of weights over all
    of them. ``shift`` is an eigenvalue (rad^2/s^2) near and below those to be computed. The default is slightly negative, so that
    the matrix of a structure that moves freely can be factorised. ``rounding`` is the relative rounding of the entries of the
    stiffness matrix, which distinguishes rigid-body modes from elastic ones: 1e-7 for a file with seven digits.
    """
    from scipy.sparse import bmat, csc_array
    from scipy.sparse.linalg import ArpackError, eigsh, splu

    k, m = _matrix("stiffness", stiffness), _matrix("mass", mass)
    size = k.shape[0]
    if m.shape != k.shape:
        raise ValueError(f"mass = {m.shape} is not allowed; it must be as large as the stiffness matrix, {k.shape}")
    if not 0 < count < size:
        raise ValueError(f"count = {count} is not allowed; it must be from 1 to {size - 1}, one less than the number of degrees of freedom")
    if not 0.0 < rounding < 1.0:
        raise ValueError(f"rounding = {rounding} is not allowed; it must be a number between 0 and 1")
    shape_factor, compliance_factor = units(length_m, mass_kg)
    loads = {name: _load(name, point, size) for name, point in points.items()}
    if shift is None:
        # This is far below any elastic mode of a reasonable mesh, but above rounding.
        shift = -1e-9 * float(abs(k.diagonal()).sum() / abs(m.diagonal()).sum())
    # A random start would make every run differ.
    start = np.random.default_rng(0).standard_normal(size)
    try:
        _, vectors = eigsh(k, count, m, sigma=shift, which="LM", v0=start)
    except ArpackError as error:
        raise ValueError(
            f"count = {count} is not allowed; it must be a number of modes that stiffness and mass have: fewer than the degrees of "
            f"freedom with mass, and a mass matrix without negative eigenvalues ({error})"
        ) from error
    vectors = vectors / np.sqrt(np.einsum("ij,ij->j", vectors, m @ vectors))
    eigenvalues = np.einsum("ij,ij->j", vectors, k @ vectors)
    order = np.argsort(eigenvalues)
    eigenvalues, vectors = eigenvalues[order], vectors[:, order]
    rounded = rounding * np.einsum("ij,ij->j", abs(vectors), abs(k) @ abs(vectors))
    rigid = np.abs(eigenvalues) <= _RIGID * rounded
    if np.any(eigenvalues[~rigid] < 0.0):
        raise ValueError(
            f"stiffness is not allowed; it must be without negative eigenvalues, and {eigenvalues.min()} makes the structure unstable "
            "(if the entries have few digits, state their rounding)"
        )
    if rigid.all():
        raise ValueError(f"count = {count} is not allowed; it must be more than the {count} rigid-body modes that were found")
    modes = vectors[:, rigid]
    moved = csc_array(m @ modes)
    factors = splu(bmat([[k, moved], [moved.T, None]], format="csc") if rigid.any() else k.tocsc())

    def compliance(load: Floats) -> float:
        balanced = load - m @ (modes @ (modes.T @ load))
        answer = factors.solve(np.concatenate([balanced, np.zeros(modes.shape[1])]))[:size]
        return float(balanced @ answer)

    omega = np.where(rigid, 0.0, np.sqrt(np.maximum(eigenvalues, 0.0)))
    damping = None if damping_ratios is None else np.broadcast_to(np.asarray(damping_ratios, dtype=float), omega.shape)
    return Structure(
        omega_rad_s=omega,
        shapes={name: vectors.T @ load * shape_factor for name, load in loads.items()},
        damping_ratios=damping,
        static_compliances_m_n={name: compliance(load) * compliance_factor for name, load in loads.items()},
    )


def _matrix(name: str, given: Any) -> Any:
    from scipy.io import mmread
    from scipy.sparse import csr_array

    matrix = csr_array(mmread(given) if isinstance(given, (str, PathLike)) else given)
    if matrix.shape[0] != matrix.shape[1]:
        raise ValueError(f"{name} = {matrix.shape} is not allowed; it must be a square matrix")
    if not np.all(np.isfinite(matrix.data)):
        raise ValueError(f"{name} is not allowed; it must be a matrix of finite numbers")
    if abs(matrix - matrix.T).max() > 1e-9 * abs(matrix).max():
        raise ValueError(f"{name} is not allowed; it must be a symmetric matrix")
    return matrix


def _load(name: str, point: int | ArrayLike, size: int) -> Floats:
    if isinstance(point, (int, np.integer)):
        if not 0 <= point < size:
            raise ValueError(f"point {name} = {point} is not allowed; it must be a degree of freedom from 0 to {size - 1}")
        load = np.zeros(size)
        load[point] = 1.0
        return load
    load = np.asarray(point, dtype=np.float64)
    if load.shape != (size,) or not np.all(np.isfinite(load)) or not load.any():
        raise ValueError(f"point {name} is not allowed; it must be a degree of freedom, or {size} finite weights, not all 0")
    return load
