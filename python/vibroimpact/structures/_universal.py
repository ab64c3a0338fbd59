"""Modes from frequency responses in universal files (data set 58).

At the point ``i`` of the structure, struck at ``j``, the receptance is that of the modes and of residual terms for the modes
below and above the band,

    H_i(w) = sum_k phi_ik phi_jk / (w_k^2 - w^2 + 2 i z_k w_k w) + U_i + U'_i w^2 + U''_i w^4 - L_i / w^2.

First estimates of the poles come from all responses together by the eigensystem realisation algorithm (Juang and Pappa 1985) on
their impulse responses, with more poles than requested, of which those with the largest contributions are selected. A
least-squares fit of the responses, each weighted by its own size, then refines them; shapes and residual terms are linear
parameters and are eliminated (variable projection). At the driving point the static compliance is ``sum phi_j^2 / w_k^2 + U_j``.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from os import PathLike, fspath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._structure import Floats, Structure

Complex = NDArray[np.complex128]

# Largest number of rows and columns of the Hankel matrix, which is otherwise that of the samples.
_MOST_ROWS = 400
# U, U', U'' and L
_RESIDUAL_TERMS = 4
# A pole counts as a vibration below this damping ratio.
_MOST_DAMPING = 0.3
# Kinds of response by their number in the file, and the power of i w by which a receptance is multiplied.
_KINDS = {8: 0, 11: 1, 12: 2}


def from_universal(
    path: str | PathLike[str],
    points: Mapping[str, tuple[int, int]],
    driving: str,
    count: int,
    band_hz: tuple[float, float] | None = None,
) -> Structure:
    """Identifies ``count`` modes from the responses of a file to a force at one point.

    ``points`` gives node and direction (1, 2, 3 for x, y, z) of each response; ``driving`` names the point at which the
    force acts and the response is measured. Responses are displacement, velocity or acceleration over force. Standard
    deviations follow from the residuals of the fit.
    """
    if driving not in points:
        raise ValueError(f"driving = {driving!r} is not allowed; it must be one of the points {list(points)}")
    if not 0 < count < _MOST_ROWS // 4:
        raise ValueError(f"count = {count} is not allowed; it must be from 1 to {_MOST_ROWS // 4 - 1}")
    omega, responses = _read(path, points, driving)
    if band_hz is not None:
        inside = (omega >= 2.0 * math.pi * band_hz[0]) & (omega <= 2.0 * math.pi * band_hz[1])
        omega, responses = omega[inside], responses[:, inside]
    if omega.size < 8 * count:
        raise ValueError(f"{fspath(path)}: {omega.size} lines in the band are too few for {count} modes: at least {8 * count}")
    names = list(points)
    poles, frequency_sd, damping_sd = _refined(omega, responses, _poles(omega, responses, count))
    residues, residual, scatter = _residues(omega, responses, poles)
    frequency = np.abs(poles)
    damping = -poles.real / frequency
    drive = names.index(driving)
    own = residues[drive]
    if np.any(own <= 0.0):
        wrong = frequency[own <= 0.0] / (2.0 * math.pi)
        raise ValueError(f"{fspath(path)}: the response at {driving} does not show the modes at {wrong} Hz as a driving point does")
    shapes = {name: residues[i] / np.sqrt(own) for i, name in enumerate(names)}
    # The standard deviation of a shape is that of its residue over the shape at the driving point; half of this there.
    spread = {
        f"points.{name}.shape": scatter[i] / np.sqrt(own) * (0.5 if i == drive else 1.0) for i, name in enumerate(names)
    }
    compliance = float(np.sum(own / frequency**2) + residual[drive])
    return Structure(
        omega_rad_s=frequency,
        shapes=shapes,
        damping_ratios=damping,
        static_compliances_m_n={driving: compliance} if compliance > 0.0 else {},
        standard_deviations=spread | {"omega_rad_s": frequency_sd, "damping_ratios": damping_sd},
    )


def _read(
    path: str | PathLike[str], points: Mapping[str, tuple[int, int]], driving: str
) -> tuple[Floats, Complex]:
    """Receptances at the points, in their order, over common angular frequencies."""
    import pyuff

    sets: Any = pyuff.UFF(fspath(path)).read_sets()
    found: dict[tuple[int, int], tuple[Floats, Complex]] = {}
    node, axis = points[driving]
    for data in sets if isinstance(sets, list) else [sets]:
        is_response = data.get("type") == 58 and data.get("func_type") == 4
        if not is_response or (data["ref_node"], abs(data["ref_dir"])) != (node, axis):
            continue
        kind = int(data.get("ordinate_spec_data_type", 0))
        if kind not in _KINDS:
            raise ValueError(f"{fspath(path)}: a response of kind {kind} is not allowed; it must be 8, 11 or 12 (displacement, velocity or acceleration)")
        omega = 2.0 * math.pi * np.asarray(data["x"], dtype=np.float64)
        sign = math.copysign(1.0, data["rsp_dir"]) * math.copysign(1.0, data["ref_dir"])
        with np.errstate(divide="ignore", invalid="ignore"):
            receptance = sign * np.asarray(data["data"], dtype=np.complex128) / (1j * omega) ** _KINDS[kind]
        found[int(data["rsp_node"]), abs(int(data["rsp_dir"]))] = (omega[omega > 0.0], receptance[omega > 0.0])
    missing = [name for name, (at, along) in points.items() if (at, along) not in found]
    if missing:
        raise ValueError(f"{fspath(path)} contains no response of {missing} to a force at {driving}; it contains {sorted(found)}")
    omega = found[node, axis][0]
    responses = [found[at, along] for at, along in points.values()]
    if any(len(other) != len(omega) or not np.allclose(other, omega) for other, _ in responses):
        raise ValueError(f"{fspath(path)}: the responses have different frequencies")
    return omega, np.asarray([response for _, response in responses])


def _poles(omega: Floats, responses: Complex, count: int) -> Complex:
    """Poles of vibration with positive frequency, from the lowest."""
    step = omega[1] - omega[0]
    # The band is shifted to zero: poles of its analytic impulse response are those of the structure with the same shift.
    accelerations = responses * -(omega**2)
    impulse = np.fft.ifft(accelerations, axis=1)
    interval = 2.0 * math.pi / (step * omega.size)
    length = min(omega.size // 2, 2 * _MOST_ROWS)
    rows = length // 2
    outputs = len(responses)
    # The first sample contains the contribution of modes outside the band.
    places = np.arange(rows)[:, None] + np.arange(length - rows)[None, :] + 1
    hankel = impulse[:, places].transpose(1, 0, 2).reshape(rows * outputs, -1)
    left, singular, _ = np.linalg.svd(hankel, full_matrices=False)
    order = min(2 * count + 4, len(singular))
    observed = left[:, :order]
    transition = np.linalg.lstsq(observed[:-outputs], observed[outputs:], rcond=None)[0]
    poles = np.log(np.linalg.eigvals(transition).astype(complex)) / interval
    # Frequencies are determined up to a multiple of the width of the band.
    width = 2.0 * math.pi / interval
    poles = poles.real + 1j * (np.mod(poles.imag, width) + omega[0])
    damping = -poles.real / np.abs(poles)
    inside = (poles.imag < omega[-1]) & (poles.imag > omega[0]) & (damping > 0.0) & (damping < _MOST_DAMPING)
    poles = poles[inside]
    if poles.size < count:
        raise ValueError(f"the responses show {poles.size} modes, not {count}: request fewer, or state another band")
    # The poles with the largest contributions to the responses, one by one.
    residues, _, _ = _residues(omega, responses, poles)
    strength = np.sqrt((residues**2).sum(axis=0)) / (-2.0 * poles.real * np.abs(poles))
    chosen = poles[np.argsort(-strength)[:count]]
    return np.asarray(chosen[np.argsort(np.abs(chosen))])


def _refined(omega: Floats, responses: Complex, poles: Complex) -> tuple[Complex, Floats, Floats]:
    """Poles by least squares, with the standard deviations of frequencies and damping ratios."""
    from scipy.optimize import least_squares

    count = poles.size

    def unpacked(u: Floats) -> Complex:
        frequency, damping = np.exp(u[:count]), np.exp(u[count:])
        return np.asarray(frequency * (-damping + 1j * np.sqrt(np.maximum(1.0 - damping**2, 0.0))))

    start = np.concatenate([np.log(np.abs(poles)), np.log(-poles.real / np.abs(poles))])
    found = least_squares(lambda u: _rest(omega, responses, unpacked(u))[0].ravel(), start, x_scale="jac", method="lm")
    # Residues and residual terms have been eliminated, but count as parameters.
    values = 2 * responses.size
    freedom = max(values - 2 * count - responses.shape[0] * (count + _RESIDUAL_TERMS), 1)
    covariance = np.linalg.pinv(found.jac.T @ found.jac) * float(found.fun @ found.fun) / freedom
    poles = unpacked(found.x)
    relative = np.sqrt(np.diag(covariance))
    order = np.argsort(np.abs(poles))
    damping = -poles.real / np.abs(poles)
    return poles[order], (relative[:count] * np.abs(poles))[order], (relative[count:] * damping)[order]


def _rest(omega: Floats, responses: Complex, poles: Complex) -> tuple[Floats, Floats, Floats]:
    """Residuals of each response relative to its size at each frequency, the best linear terms, and their standard
    deviations."""
    frequency = np.abs(poles)
    modes = 1.0 / (frequency**2 - omega[:, None] ** 2 - 2j * poles.real * omega[:, None])
    share = (omega[:, None] / omega[-1]) ** 2
    # The first column after the modes is the upper residual term U, a compliance.
    columns = np.hstack([modes, np.ones_like(share), share, share**2, 1.0 / share])
    rests, terms, spreads = [], [], []
    for response in responses:
        # Noise of a test is proportional to the response; a floor limits the weights of antiresonances.
        size = np.abs(response) + 1e-3 * np.median(np.abs(response))
        weighed = columns / size[:, None]
        real = np.vstack([weighed.real, weighed.imag])
        scale = np.linalg.norm(real, axis=0)
        inverse = np.linalg.pinv(real / scale) / scale[:, None]
        target = np.concatenate([(response / size).real, (response / size).imag])
        solution = inverse @ target
        rest = target - real @ solution
        variance = float(rest @ rest) / max(rest.size - solution.size, 1)
        rests.append(rest)
        terms.append(solution)
        spreads.append(np.sqrt(variance * (inverse**2).sum(axis=1)))
    return np.asarray(rests), np.asarray(terms), np.asarray(spreads)


def _residues(omega: Floats, responses: Complex, poles: Complex) -> tuple[Floats, Floats, Floats]:
    """Residues and upper residual terms of each response, and the residues' standard deviations."""
    _, terms, spreads = _rest(omega, responses, poles)
    count = poles.size
    return terms[:, :count], terms[:, count], spreads[:, :count]
