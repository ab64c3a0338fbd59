from collections.abc import Iterable, Mapping
from os import PathLike
from typing import Any, overload

import numpy as np
from _typeshed import SupportsKeysAndGetItem
from numpy.typing import ArrayLike, NDArray

from ._result import Identification, Impact, Motion, Result
from .parts import Scene

__all__ = [
    "__version__",
    "compare",
    "emoc",
    "emoc_restitution",
    "fit",
    "identify",
    "infinite_beam",
    "law",
    "modes",
    "orbit",
    "plan",
    "sensitivity",
    "simulate",
    "sweep",
    "turning_points",
]

__version__: str

@overload
def simulate(scene: Scene, *, history: bool = False) -> Impact: ...
@overload
def simulate(scene: Mapping[str, Any] | str | PathLike[str], *, history: bool = False) -> Impact | Motion: ...
def plan(scene: Mapping[str, Any] | str | PathLike[str]) -> Result: ...
def compare(scene: Mapping[str, Any] | str | PathLike[str]) -> Result: ...
def sensitivity(scene: Mapping[str, Any] | str | PathLike[str], by: list[str] = ...) -> Result: ...
def modes(scene: Mapping[str, Any] | str | PathLike[str], count: int) -> dict[str, NDArray[np.float64]]: ...
def orbit(
    scene: Mapping[str, Any] | str | PathLike[str],
    *,
    periods: int = 1,
    transient: int = 100,
    search: int = 1500,
    over: str | None = None,
    from_: float | None = None,
    to: float | None = None,
    step: float = 0.02,
    branches: int = 0,
) -> Result: ...
def infinite_beam(s: float, *, history: bool = False) -> Result: ...
def turning_points(count: int) -> Result: ...
def law(
    restitution: float,
    mass_kg: float,
    speed_m_s: float,
    *,
    other_mass_kg: float | None = None,
    compression_m: float | None = None,
    step_s: float | None = None,
    law: str | None = None,
) -> Result: ...
def emoc(
    scene: Mapping[str, Any] | str | PathLike[str],
    *,
    mu0: float = 1.0,
    alpha0: float = 1.0,
    alpha1: float = 1.0,
    modes: int | None = None,
) -> Result: ...
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
) -> Result: ...
def identify(
    scene: Mapping[str, Any] | str | PathLike[str],
    data: SupportsKeysAndGetItem[str, Any] | str | PathLike[str],
    free: Mapping[str, tuple[float, float] | None] | Iterable[str],
    *,
    level: float = 0.95,
    starts: int = 4,
    candidates: SupportsKeysAndGetItem[str, Any] | str | PathLike[str] | None = None,
) -> Identification: ...
def sweep(
    definition: Mapping[str, Any] | str | PathLike[str], *, threads: int | None = None
) -> dict[str, NDArray[Any]]: ...
