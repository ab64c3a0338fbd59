"""Modes and static compliances from stiffness and mass matrices.

With ``K`` and ``M`` the pencil ``K x = omega^2 M x`` is solved for its lowest modes by Lanczos' method with a shift (scipy's
``eigsh``), and the eigenvalue of each vector is its Rayleigh quotient ``x^T K x``. The rounding of the entries of ``K`` by a
share ``e`` changes that by at most ``b = e |x|^T |K| |x|``. An eigenvalue of up to ``4 b`` is zero within rounding. It may be
that of a rigid body, or of a soft spring that is lost in the rounding of a stiff one; the matrices do not tell, so that the
number of rigid-body modes is stated. The other eigenvalues must be at least ``100 b``, so that frequencies are certain to 0.5
%. No eigenvalue may be negative: ``K`` and ``M`` are positive semidefinite if they can be factorised after every diagonal
entry is increased by ``4 e`` times the sum of the absolute values of its row. The static compliance at a point with the load
vector ``f`` is ``f^T K^-1 f``. For a structure that moves freely, it is that of the elastic modes alone: the load is balanced
by inertia, ``g = f - M R R^T f`` with the mass-normalised rigid-body modes ``R``, and the solution of ``K x + M R y = g`` is
the one with ``R^T M x = 0``.
"""

from __future__ import annotations

import bz2
import gzip
import re
import zlib
from collections.abc import Mapping, Sequence
from io import BytesIO
from os import PathLike, fspath
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ._structure import Floats, Structure, damping_of_modes, units

# Eigenvalues of rigid-body modes are below this multiple of the effect of rounding: sums of rounded entries are rounded as well.
_RIGID = 4.0
# Eigenvalues of elastic modes are at least this multiple of it.
_ELASTIC = 100.0
# A word that is not a number. scipy takes the number with which a word begins, and would read 1.5D+03 as 1.5.
_NO_NUMBER = re.compile(r"(?<!\S)(?![-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?!\S))\S+")


def from_matrices(
    stiffness: Any,
    mass: Any,
    points: Mapping[str, int | ArrayLike],
    count: int,
    *,
    rigid_modes: int = 0,
    damping_ratios: Sequence[float] | float | None = None,
    shift: float | None = None,
    rounding: float = float(np.finfo(np.float64).eps),
    length_m: float = 1.0,
    mass_kg: float = 1.0,
) -> Structure:
    """Computes the ``count`` lowest modes, of which the first ``rigid_modes`` are those of a structure that can move freely.

    ``stiffness`` and ``mass`` are Matrix Market files or scipy.sparse matrices, real and symmetric, without the fixed degrees of
    freedom. ``points`` gives, for each point that may be struck, its degree of freedom (from 0) or a vector of weights over all
    of them. ``shift`` is an eigenvalue (rad^2/s^2) near and below those to be computed. The default is slightly negative, so that
    the matrix of a structure that moves freely can be factorised. ``rounding`` is the relative rounding of the entries of the
    stiffness matrix, 1e-7 for a file with seven digits: what is zero within it is not taken for an elastic mode.
    """
    from scipy.sparse import bmat, csc_array
    from scipy.sparse.linalg import ArpackError, eigsh, splu

    k, m = _matrix("stiffness", stiffness), _matrix("mass", mass)
    size = k.shape[0]
    if m.shape != k.shape:
        raise ValueError(f"mass = {m.shape} is not allowed; it must be as large as the stiffness matrix, {k.shape}")
    if not 0 < count < size:
        raise ValueError(f"count = {count} is not allowed; it must be from 1 to {size - 1}, one less than the number of degrees of freedom")
    if not 0 <= rigid_modes < count:
        raise ValueError(f"rigid_modes = {rigid_modes} is not allowed; it must be from 0 to {count - 1}, less than the count of modes")
    if not 0.0 < rounding < 1.0:
        raise ValueError(f"rounding = {rounding} is not allowed; it must be a number between 0 and 1")
    shape_factor, compliance_factor = units(length_m, mass_kg)
    loads = {name: _load(name, point, size) for name, point in points.items()}
    _refuse_negative("stiffness", k, rounding)
    _refuse_negative("mass", m, float(np.finfo(np.float64).eps))
    if not m.diagonal().any():
        raise ValueError("mass is not allowed; it must have an entry other than 0")
    if shift is not None and not _factorises(k - shift * m):
        raise ValueError(f"shift = {shift} is not allowed; it must be less than the lowest eigenvalue")
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
    except RuntimeError as error:  # the shifted matrix is singular
        raise ValueError(
            "stiffness is not allowed; it must be such that every degree of freedom has stiffness or mass: leave out those without both"
        ) from error
    vectors = vectors / np.sqrt(np.einsum("ij,ij->j", vectors, m @ vectors))
    eigenvalues = np.einsum("ij,ij->j", vectors, k @ vectors)
    order = np.argsort(eigenvalues)
    eigenvalues, vectors = eigenvalues[order], vectors[:, order]
    rounded = rounding * np.einsum("ij,ij->j", abs(vectors), abs(k) @ abs(vectors))
    zero = np.abs(eigenvalues) <= _RIGID * rounded
    if np.any(eigenvalues[~zero] < 0.0):
        raise ValueError(
            f"stiffness is not allowed; it must be without negative eigenvalues, and {eigenvalues.min()} makes the structure unstable "
            "(if the entries have few digits, state their rounding)"
        )
    rigid = np.arange(count) < rigid_modes
    if np.any(zero != rigid):
        raise ValueError(
            f"rigid_modes = {rigid_modes} is not allowed; it must be {np.count_nonzero(zero)}, the number of eigenvalues that are zero "
            "within the rounding of the stiffness matrix, if the structure can move freely; if it cannot, a soft spring is lost in the "
            "rounding of a stiff one: make the stiff parts less stiff or rigid"
        )
    uncertain = ~rigid & (eigenvalues < _ELASTIC * rounded)
    if np.any(uncertain):
        raise ValueError(
            f"stiffness is not allowed; it must have entries from which the eigenvalue {eigenvalues[uncertain][0]} can be computed, "
            f"and their rounding changes it by up to {rounded[uncertain][0]}: make the stiff parts less stiff or rigid, or write more digits"
        )
    modes = vectors[:, rigid]
    moved = csc_array(m @ modes)
    factors = splu(bmat([[k, moved], [moved.T, None]], format="csc") if rigid.any() else k.tocsc())

    def compliance(load: Floats) -> float:
        balanced = load - m @ (modes @ (modes.T @ load))
        answer = factors.solve(np.concatenate([balanced, np.zeros(modes.shape[1])]))[:size]
        return float(balanced @ answer)

    omega = np.where(rigid, 0.0, np.sqrt(np.maximum(eigenvalues, 0.0)))
    damping = damping_of_modes(damping_ratios, count)
    return Structure(
        omega_rad_s=omega,
        shapes={name: vectors.T @ load * shape_factor for name, load in loads.items()},
        damping_ratios=damping,
        static_compliances_m_n={name: compliance(load) * compliance_factor for name, load in loads.items()},
    )


def _matrix(name: str, given: Any) -> Any:
    from scipy.sparse import csr_array

    matrix = csr_array(_read(given) if isinstance(given, (str, PathLike)) else given)
    if np.iscomplexobj(matrix.data):
        if np.any(matrix.data.imag != 0.0):
            raise ValueError(f"{name} is not allowed; it must be a matrix of real numbers: state damping by damping_ratios")
        matrix = matrix.real
    matrix = matrix.astype(np.float64)
    if matrix.shape[0] != matrix.shape[1]:
        raise ValueError(f"{name} = {matrix.shape} is not allowed; it must be a square matrix")
    if not np.all(np.isfinite(matrix.data)):
        raise ValueError(f"{name} is not allowed; it must be a matrix of finite numbers")
    if abs(matrix - matrix.T).max() > 1e-9 * abs(matrix).max():
        raise ValueError(f"{name} is not allowed; it must be a symmetric matrix")
    return matrix


def _read(path: str | PathLike[str]) -> Any:
    """The matrix of a Matrix Market file, which may be compressed."""
    from scipy.io import mmread

    content = Path(path).read_bytes()
    unpack = {".gz": gzip.decompress, ".bz2": bz2.decompress}.get(Path(path).suffix)
    try:
        content = unpack(content) if unpack else content
    except (EOFError, OSError, ValueError, zlib.error) as error:
        raise ValueError(f"{fspath(path)} is not a whole compressed file: {error}") from error
    if not content.lower().startswith(b"%%matrixmarket"):
        raise ValueError(f"{fspath(path)} is not a Matrix Market file: it must begin with %%MatrixMarket")
    numbers = re.sub(r"^[ \t]*%.*$", "", content.decode("ascii", errors="replace"), flags=re.MULTILINE)
    if wrong := _NO_NUMBER.search(numbers):
        line = 1 + numbers.count("\n", 0, wrong.start())
        raise ValueError(f"{fspath(path)}, line {line}: {wrong[0]!r} is not allowed; it must be a number, such as 1.5e+03")
    if b"pattern" in content.splitlines()[0].lower().split():
        raise ValueError(f"{fspath(path)}, line 1: pattern is not allowed; it must be real, integer or complex, with the values of the entries")
    # 1.5e+03 that is cut to 1.5e+0 is a number as well, and programs end each line.
    if not numbers[-1:].isspace():
        line, last = 1 + numbers.count("\n"), numbers.rpartition("\n")[2]
        raise ValueError(
            f"{fspath(path)} is not a whole Matrix Market file: line {line}, {last!r}, must end with a line break, without which its last "
            "number may be cut"
        )
    try:
        return mmread(BytesIO(content + b"\n"))
    except ValueError as error:
        raise ValueError(f"{fspath(path)} is not a whole Matrix Market file: {error}") from error


def _refuse_negative(name: str, matrix: Any, rounding: float) -> None:
    """A matrix with negative eigenvalues beyond the rounding of its entries is not that of a structure."""
    from scipy.sparse import diags_array

    rows = np.asarray(abs(matrix).sum(axis=1)).ravel()
    # Degrees of freedom without any mass.
    used = np.flatnonzero(rows > 0.0)
    raised = (matrix + diags_array(_RIGID * rounding * rows)).tocsr()[used][:, used]
    if used.size and not _factorises(raised):
        raise ValueError(
            f"{name} is not allowed; it must be without negative eigenvalues beyond the rounding of its entries, a share of {rounding:.3g} "
            "(if the stiffness has few digits, state its rounding)"
        )


def _factorises(matrix: Any) -> bool:
    """Whether a symmetric matrix is positive definite: elimination without exchange of rows then has positive pivots."""
    from scipy.sparse.linalg import splu

    try:
        factors = splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    except RuntimeError:  # a pivot that is exactly 0
        return False
    return bool(np.array_equal(factors.perm_r, factors.perm_c) and np.all(factors.U.diagonal() > 0.0))


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
