"""Modes from frequency responses in universal files (data set 58)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from os import PathLike, fspath

import numpy as np

from ._modal_fit import MOST_ROWS, fit
from ._responses import receptances
from ._structure import Structure

# A residue at the driving point smaller than this multiple of its standard deviation does not show a mode.
_SHOWN = 3.0
# Motion below the band, as a share of the static compliance and as a multiple of its standard deviation, that is more than an error.
_LOWER_MOTION = 0.005
_LOWER_SHOWN = 4.0
# The share that the motion below the band may be, with two standard deviations.
_LOWER_POSSIBLE = 0.03


def from_universal(
    path: str | PathLike[str],
    points: Mapping[str, tuple[int, int]],
    driving: str,
    count: int,
    band_hz: tuple[float, float] | None = None,
    *,
    free: bool = False,
) -> Structure:
    """Identifies ``count`` modes from the responses of a file between one point and others.

    ``points`` gives node and direction (1, 2, 3 for x, y, z) of each point; ``driving`` names that at which both force and response
    are measured. At the others the response to a force at the driving point is measured, or, with a roving hammer, the response at
    the driving point to a force there. Responses are displacement, velocity or acceleration over force, in SI units or those that
    a data set 164 states. At the driving point the static compliance is that of the modes and of the residual terms. With ``free`` the
    structure hangs freely: what moves below the band is its rigid-body motion, and the compliance is that of the elastic modes. Standard
    deviations follow from the residuals of the fit.
    """
    if driving not in points:
        raise ValueError(f"driving = {driving!r} is not allowed; it must be one of the points {list(points)}")
    if not 0 < count < MOST_ROWS // 4:
        raise ValueError(f"count = {count} is not allowed; it must be from 1 to {MOST_ROWS // 4 - 1}")
    omega, responses = receptances(path, points, driving)
    if band_hz is not None:
        inside = (omega >= 2.0 * math.pi * band_hz[0]) & (omega <= 2.0 * math.pi * band_hz[1])
        omega, responses = omega[inside], responses[:, inside]
    if omega.size < 8 * count:
        raise ValueError(f"{fspath(path)}: {omega.size} lines in the band are too few for {count} modes: at least {8 * count}")
    try:
        found = fit(omega, responses, count)
    except ValueError as error:
        raise ValueError(f"{fspath(path)}: {error}") from error
    names = list(points)
    drive = names.index(driving)
    own, own_sd = found.residues[drive], found.residues_sd[drive]
    compliance = float(np.sum(own / found.frequency**2) + found.upper_compliance[drive])
    below, below_sd = float(found.lower_motion[drive]), float(found.lower_motion_sd[drive])
    moves_below = below > max(_LOWER_MOTION * compliance, _LOWER_SHOWN * below_sd)
    if not free and (moves_below or below + 2.0 * below_sd > _LOWER_POSSIBLE * compliance):
        raise ValueError(
            f"{fspath(path)}: the response at {driving} {'shows' if moves_below else 'does not exclude'} motion below "
            f"{omega[0] / (2.0 * math.pi):.4g} Hz, whose compliance is not known: let the band begin below the lowest mode, or state "
            "free=True if the structure hangs freely"
        )
    if np.any(own <= 0.0):
        wrong = found.frequency[own <= 0.0] / (2.0 * math.pi)
        raise ValueError(f"{fspath(path)}: the response at {driving} does not show the modes at {wrong} Hz as a driving point does")
    if np.any(own <= _SHOWN * own_sd):
        unsure = found.frequency[own <= _SHOWN * own_sd] / (2.0 * math.pi)
        raise ValueError(
            f"{fspath(path)}: the response at {driving} shows the modes at {unsure} Hz within less than {_SHOWN:g} standard deviations: "
            "request fewer modes, state another band, or choose a driving point that these modes move more"
        )
    shapes = {name: found.residues[i] / np.sqrt(own) for i, name in enumerate(names)}
    # The standard deviation of a shape is that of its residue over the shape at the driving point; half of this there.
    spread = {
        f"points.{name}.shape": found.residues_sd[i] / np.sqrt(own) * (0.5 if i == drive else 1.0) for i, name in enumerate(names)
    }
    return Structure(
        omega_rad_s=found.frequency,
        shapes=shapes,
        damping_ratios=found.damping,
        static_compliances_m_n={driving: compliance} if compliance > 0.0 else {},
        standard_deviations=spread | {"omega_rad_s": found.frequency_sd, "damping_ratios": found.damping_sd},
    )
