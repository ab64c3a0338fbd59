"""Modes fitted to receptances between a driving point and several points.

Between the driving point ``j`` and the point ``i`` the receptance is that of the modes, and of residual terms for the modes below and
above the band,

    H_i(w) = sum_k phi_ik phi_jk / (w_k^2 - w^2 + 2 i z_k w_k w) + U_i + U'_i w^2 + U''_i w^4 - L_i / w^2.

First estimates of the poles come from all responses together by the eigensystem realisation algorithm (Juang and Pappa 1985) on
their impulse responses, with more poles than requested. Those that describe the responses best are selected, each response weighted by
its own size, and refined by least squares; residues and residual terms are linear parameters and are eliminated (variable
projection). Where a mode is so close above the band that residual terms do not describe it, a pole above the band is added. What is
below the band remains a residual term, by which a structure that moves there is known.

Standard deviations follow from the residuals of the fit. A misfit of the model is correlated from line to line, and counts accordingly:
if ``r_l`` is the correlation over ``l`` lines, there are as many independent values as lines over ``1 + 2 sum r_l``.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ._responses import Complex
from ._structure import Floats

# Largest number of rows and columns of the Hankel matrix, which is otherwise that of the samples.
MOST_ROWS = 400
# U, U', U'' and L
_RESIDUAL_TERMS = 4
# A pole counts as a vibration below this damping ratio.
_MOST_DAMPING = 0.3
# Most evenly spaced lines on which first estimates of the poles are based.
_MOST_LINES = 1 << 16
# Numbers of poles, beside two for each mode, with which the realisation is made.
_MORE_POLES = (4, 12, 28)
# A column of which less than this share is left beside others, as a share of its square, depends on them.
_DEPENDENT = 1e-10
# Rounds of exchange of selected poles, and poles added above the band.
_ROUNDS = 4
_MOST_ABOVE = 3
# Where poles above the band are sought, relative to its end, and their damping ratio.
_ABOVE = np.array([1.02, 1.05, 1.1, 1.2, 1.4, 2.0])
_ABOVE_DAMPING = 0.01
# The misfit, relative to the responses, that is correlated from line to line: above the first a further mode is sought, which must
# reduce the sum of squares to the share; above the second the fit is no description of the responses.
_NOTICED_MISFIT = 0.01
_FURTHER_MODE = 0.25
_MOST_MISFIT = 0.1
# Most steps of a search, which takes about ten from a good start; a step costs an evaluation for each parameter.
_MOST_STEPS = 20
# Largest logarithm of a frequency or a damping ratio.
_FARTHEST = 50.0
# Relative change for derivatives of residues with respect to poles.
_CHANGE = 1e-6


@dataclass
class ModalFit:
    """Modes from the lowest; with rows for the responses, their residues (kg^-1) and standard deviations."""

    frequency: Floats
    frequency_sd: Floats
    damping: Floats
    damping_sd: Floats
    residues: Floats
    residues_sd: Floats
    # The static compliance of what is above the band: residual terms and poles.
    upper_compliance: Floats
    # What moves below the band: its part of the receptance at the lowest frequency, with the sign of a compliance.
    lower_motion: Floats
    lower_motion_sd: Floats


def fit(omega: Floats, responses: Complex, count: int) -> ModalFit:
    """``count`` modes in the band of the angular frequencies.

    Raises ``ValueError`` if the responses do not show as many modes, or show more, or are not those of modes.
    """
    candidates = _candidates(omega, responses, count)
    if candidates.size < count:
        raise ValueError(f"the responses show {candidates.size} modes, not {count}: request fewer, or state another band")
    chosen = _selected(omega, responses, candidates, count)
    u = _refined(omega, responses, _parameters(chosen))
    for _ in range(_MOST_ABOVE):
        wider = _with_pole_above(omega, responses, u, count)
        if wider is None:
            break
        u = wider
    rest = _rest(omega, responses, _poles(u))
    misfit = _correlated(rest)
    if misfit > _NOTICED_MISFIT:
        further = _best_beside(omega, responses, candidates, _poles(u))
        with_it = _rest(omega, responses, np.append(_poles(u), further))
        if np.sum(with_it**2) < _FURTHER_MODE * np.sum(rest**2):
            raise ValueError(
                f"the responses show more than {count} modes, such as one near {abs(further) / (2.0 * math.pi):.5g} Hz: "
                "request more, or state a narrower band"
            )
    if misfit > _MOST_MISFIT:
        raise ValueError(
            f"{count} modes do not describe the responses: the misfit is {100.0 * misfit:.0f} % of them, and at most "
            f"{100.0 * _MOST_MISFIT:.0f} % is allowed; request another number of modes, or state another band"
        )
    return _finished(omega, responses, u, rest, count)


def _finished(omega: Floats, responses: Complex, u: Floats, rest: Floats, count: int) -> ModalFit:
    """The modes in the band, with their standard deviations."""
    poles = _poles(u)
    frequency, damping = np.abs(poles), -poles.real / np.abs(poles)
    inside = np.flatnonzero((frequency >= omega[0]) & (frequency <= omega[-1]) & (damping < _MOST_DAMPING))
    if inside.size != count:
        raise ValueError(f"the responses show {inside.size} modes in the band, not {count}: request another number, or state another band")
    inside = inside[np.argsort(frequency[inside])]
    # The half-power width of a resonance is twice this.
    width = damping[inside] * frequency[inside]
    cut = (frequency[inside] - omega[0] < width) | (omega[-1] - frequency[inside] < width)
    if np.any(cut):
        raise ValueError(
            f"the band cuts through the resonance at {frequency[inside][cut][0] / (2.0 * math.pi):.5g} Hz, whose damping ratio is "
            f"{damping[inside][cut][0]:.2g}: state a band that contains it wholly or not at all"
        )
    outside = np.setdiff1d(np.arange(poles.size), inside)
    terms, conditional = _terms(omega, responses, poles)
    jacobian = np.empty((rest.size, u.size))
    slopes = np.empty((*terms.shape, u.size))
    for k in range(u.size):
        step = np.zeros(u.size)
        step[k] = _CHANGE
        ahead, behind = _poles(u + step), _poles(u - step)
        jacobian[:, k] = (_rest(omega, responses, ahead) - _rest(omega, responses, behind)).ravel() / (2.0 * _CHANGE)
        slopes[..., k] = (_terms(omega, responses, ahead)[0] - _terms(omega, responses, behind)[0]) / (2.0 * _CHANGE)
    # Residues and residual terms have been eliminated, but count as parameters.
    freedom = max(rest.size - u.size - responses.shape[0] * (poles.size + _RESIDUAL_TERMS), 1)
    stretch = _dependent_lines(rest)
    covariance = np.linalg.pinv(jacobian.T @ jacobian) * float(np.sum(rest**2)) / freedom * stretch
    relative = np.sqrt(np.diag(covariance))
    of_poles = np.einsum("ijk,kl,ijl->ij", slopes, covariance, slopes)
    scatter = np.sqrt(conditional**2 * stretch + of_poles)
    # The last residual term is L, relative to the end of the band.
    lowest = (omega[-1] / omega[0]) ** 2
    return ModalFit(
        frequency=frequency[inside],
        frequency_sd=(relative[: poles.size] * frequency)[inside],
        damping=damping[inside],
        damping_sd=(relative[poles.size :] * damping)[inside],
        residues=terms[:, inside],
        residues_sd=scatter[:, inside],
        upper_compliance=terms[:, poles.size] + terms[:, outside] @ (1.0 / frequency[outside] ** 2),
        lower_motion=-terms[:, -1] * lowest,
        lower_motion_sd=scatter[:, -1] * lowest,
    )


def _candidates(omega: Floats, responses: Complex, count: int) -> Complex:
    """Poles of vibration in the band, with positive frequency."""
    step = float(np.diff(omega).min())
    low, high = float(omega[0]), float(omega[-1])
    lines = min(1 + round((high - low) / step), _MOST_LINES)
    if lines != omega.size:
        # The realisation needs even spacing; estimates from what is interpolated between uneven lines are good enough to begin with.
        even = np.linspace(low, high, lines)
        responses = np.array([np.interp(even, omega, response) for response in responses])
        omega, step = even, (high - low) / (lines - 1)
    # The band is shifted to zero: poles of its analytic impulse response are those of the structure with the same shift.
    accelerations = responses * -(omega**2)
    impulse = np.fft.ifft(accelerations, axis=1)
    interval = 2.0 * math.pi / (step * omega.size)
    length = min(omega.size // 2, 2 * MOST_ROWS)
    rows = length // 2
    outputs = len(responses)
    # The first sample contains the contribution of modes outside the band.
    places = np.arange(rows)[:, None] + np.arange(length - rows)[None, :] + 1
    hankel = impulse[:, places].transpose(1, 0, 2).reshape(rows * outputs, -1)
    left, singular, _ = np.linalg.svd(hankel, full_matrices=False)
    found = []
    for more in _MORE_POLES:
        observed = left[:, : min(2 * count + more, len(singular))]
        transition = np.linalg.lstsq(observed[:-outputs], observed[outputs:], rcond=None)[0]
        found.append(np.log(np.linalg.eigvals(transition).astype(complex)) / interval)
    poles = np.concatenate(found)
    # Frequencies are determined up to a multiple of the width of the band.
    poles = poles.real + 1j * (np.mod(poles.imag, 2.0 * math.pi / interval) + low)
    damping = -poles.real / np.abs(poles)
    return np.asarray(poles[(poles.imag < high) & (poles.imag > low) & (damping > 0.0) & (damping < _MOST_DAMPING)])


def _selected(omega: Floats, responses: Complex, poles: Complex, count: int) -> Complex:
    """Those of the poles that describe the responses best: one by one, and then each exchanged for a better one."""
    columns, targets = _weighed(omega, responses, poles)
    chosen: list[int] = []
    for _ in range(count):
        chosen.append(_best(columns, targets, chosen, poles.size))
    for _ in range(_ROUNDS):
        before = list(chosen)
        for k in range(count):
            chosen[k] = _best(columns, targets, chosen[:k] + chosen[k + 1 :], poles.size)
        if chosen == before:
            break
    return np.asarray(poles[chosen])


def _best(columns: Floats, targets: Floats, chosen: Sequence[int], candidates: int) -> int:
    """The one among the first ``candidates`` poles that reduces the sum of squares most beside those chosen."""
    gain = np.zeros(candidates)
    for column, target in zip(columns, targets, strict=True):
        known = np.linalg.qr(column[:, [*chosen, *range(column.shape[1] - _RESIDUAL_TERMS, column.shape[1])]])[0]
        candidate = column[:, :candidates]
        rest = candidate - known @ (known.T @ candidate)
        size = np.einsum("ij,ij->j", rest, rest)
        size[size < _DEPENDENT * np.einsum("ij,ij->j", candidate, candidate)] = np.inf
        gain += (rest.T @ (target - known @ (known.T @ target))) ** 2 / size
    return int(np.argmax(gain))


def _best_beside(omega: Floats, responses: Complex, candidates: Complex, known: Complex) -> complex:
    """The one of the candidates that reduces the sum of squares most beside known poles."""
    columns, targets = _weighed(omega, responses, np.concatenate([candidates, known]))
    places = range(candidates.size, candidates.size + known.size)
    return complex(candidates[_best(columns, targets, places, candidates.size)])


def _with_pole_above(omega: Floats, responses: Complex, u: Floats, count: int) -> Floats | None:
    """The parameters with one more pole, above the band, if the responses show that it is there."""
    known = _poles(u)
    tried = omega[-1] * _ABOVE * (-_ABOVE_DAMPING + 1j)
    wider = _refined(omega, responses, _parameters(np.append(known, _best_beside(omega, responses, tried, known))))
    # The poles of the modes come first.
    if np.any(np.abs(_poles(wider)[count:]) <= omega[-1]):
        return None
    # Schwarz's criterion: is the gain worth two parameters of the pole and a residue for each response?
    values = 2 * responses.size
    before, after = (np.sum(_rest(omega, responses, _poles(v)) ** 2) for v in (u, wider))
    return wider if values * math.log(before / after) > (2 + len(responses)) * math.log(values) else None


def _refined(omega: Floats, responses: Complex, start: Floats) -> Floats:
    """The logarithms of frequencies and damping ratios by least squares."""
    from scipy.optimize import least_squares

    most = _MOST_STEPS * (start.size + 1)
    found = least_squares(lambda u: _rest(omega, responses, _poles(u)).ravel(), start, x_scale="jac", method="lm", max_nfev=most)
    return np.asarray(found.x, dtype=np.float64)


def _parameters(poles: Complex) -> Floats:
    return np.asarray(np.log(np.concatenate([np.abs(poles), -poles.real / np.abs(poles)])))


def _poles(u: Floats) -> Complex:
    # Steps of the search may lead far away, but not to numbers that overflow.
    frequency, damping = np.split(np.exp(np.clip(u, -_FARTHEST, _FARTHEST)), 2)
    return np.asarray(frequency * (-damping + 1j * np.sqrt(np.maximum(1.0 - damping**2, 0.0))))


def _weighed(omega: Floats, responses: Complex, poles: Complex) -> tuple[Floats, Floats]:
    """For each response, relative to its size at each frequency: columns of the poles and of the residual terms; and itself.

    Real parts and imaginary parts are one above the other.
    """
    frequency = np.abs(poles)
    modes = 1.0 / (frequency**2 - omega[:, None] ** 2 - 2j * poles.real * omega[:, None])
    share = (omega[:, None] / omega[-1]) ** 2
    # The first column after the modes is the upper residual term U, a compliance.
    columns = np.hstack([modes, np.ones_like(share), share, share**2, 1.0 / share])
    # Noise of a test is proportional to the response; a floor limits the weights of antiresonances.
    sizes = np.abs(responses) + 1e-3 * np.median(np.abs(responses), axis=1, keepdims=True)
    weighed = columns / sizes[:, :, None]
    return np.concatenate([weighed.real, weighed.imag], axis=1), np.hstack([(responses / sizes).real, (responses / sizes).imag])


def _terms(omega: Floats, responses: Complex, poles: Complex) -> tuple[Floats, Floats]:
    """The best residues and residual terms of each response, and their standard deviations at given poles."""
    solved = [_solved(column, target) for column, target in zip(*_weighed(omega, responses, poles), strict=True)]
    return np.asarray([terms for terms, _ in solved]), np.asarray([spread for _, spread in solved])


def _rest(omega: Floats, responses: Complex, poles: Complex) -> Floats:
    """What the best residues and residual terms leave of each response, relative to its size."""
    columns, targets = _weighed(omega, responses, poles)
    bases = np.linalg.qr(columns)[0]
    return np.asarray(targets - np.einsum("ijk,ik->ij", bases, np.einsum("ijk,ij->ik", bases, targets)))


def _solved(columns: Floats, target: Floats) -> tuple[Floats, Floats]:
    """The least-squares solution and its standard deviations."""
    scale = np.linalg.norm(columns, axis=0)
    inverse = np.linalg.pinv(columns / scale) / scale[:, None]
    solution = inverse @ target
    rest = target - columns @ solution
    variance = float(rest @ rest) / max(rest.size - solution.size, 1)
    return solution, np.sqrt(variance * (inverse**2).sum(axis=1))


def _lines(rest: Floats) -> Floats:
    """Real and imaginary parts of the residuals of each response, a row each."""
    return np.reshape(rest, (2 * len(rest), -1))


def _correlated(rest: Floats) -> float:
    """The root mean square of that part of the residuals that is the same from line to line, which noise is not."""
    rows = _lines(rest)
    return math.sqrt(max(float(np.mean(rows[:, 1:] * rows[:, :-1])), 0.0))


def _dependent_lines(rest: Floats) -> float:
    """The number of lines for each independent value: one plus twice the sum of the correlations, up to the first that is not positive."""
    rows = _lines(rest)
    lines = rows.shape[1]
    padded = np.fft.rfft(rows, 2 * lines, axis=1)
    products = np.fft.irfft(np.abs(padded) ** 2, axis=1)[:, :lines].sum(axis=0)
    if products[0] <= 0.0:
        return 1.0
    correlations = products[1:] / products[0]
    ends = np.flatnonzero(correlations <= 0.0)
    return float(1.0 + 2.0 * correlations[: ends[0] if ends.size else None].sum())
