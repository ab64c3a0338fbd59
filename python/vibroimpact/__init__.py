"""What happens when a compact body strikes a slender vibrating one, and when many bodies strike each other.

A scene is a mapping, or the path of a JSON or TOML file, as the command line takes it; every quantity is in SI units,
and its name says which. Results are dictionaries with the keys that the command line prints with ``--json``; histories
and tables are numpy arrays. All functions release the interpreter's lock while they compute.
"""

from ._errors import InvalidInput
from ._vibroimpact import (
    __version__,
    compare,
    emoc,
    emoc_restitution,
    fit,
    infinite_beam,
    modes,
    orbit,
    plan,
    sensitivity,
    simulate,
    sweep,
    turning_points,
)

__all__ = [
    "InvalidInput",
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
