from collections.abc import Mapping
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "__version__",
    "compare",
    "emoc",
    "emoc_restitution",
    "fit",
    "infinite_beam",
    "modes",
    "orbit",
    "plan",
    "sensitivity",
    "simulate",
    "sweep",
    "turning_points",
]

__version__: str

def simulate(scene: Mapping[str, Any] | str | PathLike[str], *, history: bool = False) -> dict[str, Any]: ...
def plan(scene: Mapping[str, Any] | str | PathLike[str]) -> dict[str, Any]: ...
def compare(scene: Mapping[str, Any] | str | PathLike[str]) -> dict[str, Any]: ...
def sensitivity(scene: Mapping[str, Any] | str | PathLike[str], by: list[str] = ...) -> dict[str, Any]: ...
def modes(scene: Mapping[str, Any] | str | PathLike[str], count: int) -> dict[str, NDArray[np.float64]]: ...
def orbit(
    scene: Mapping[str, Any] | str | PathLike[str],
    *,
    periods: int = 1,
    transient: int = 100,
    over: str | None = None,
    from_: float | None = None,
    to: float | None = None,
    step: float = 0.02,
) -> dict[str, Any]: ...
def infinite_beam(s: float, *, history: bool = False) -> dict[str, Any]: ...
def turning_points(count: int) -> dict[str, Any]: ...
def emoc(
    scene: Mapping[str, Any] | str | PathLike[str],
    *,
    mu0: float = 1.0,
    alpha0: float = 1.0,
    alpha1: float = 1.0,
    modes: int | None = None,
) -> dict[str, Any]: ...
def emoc_restitution(
    mass_kg: ArrayLike,
    shapes: ArrayLike,
    *,
    mu0: float = 1.0,
    alpha0: float = 1.0,
    alpha1: float = 1.0,
) -> NDArray[np.float64]: ...
def fit(
    scene: Mapping[str, Any] | str | PathLike[str],
    mass_kg: ArrayLike,
    location_m: ArrayLike,
    restitution: ArrayLike,
    *,
    modes: int = 50,
) -> dict[str, Any]: ...
def sweep(
    definition: Mapping[str, Any] | str | PathLike[str], *, threads: int | None = None
) -> dict[str, NDArray[Any]]: ...
