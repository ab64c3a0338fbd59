"""Results: dictionaries with their main entries as attributes, and a method to plot them."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Columns = dict[str, NDArray[np.float64]]


class Result(dict[str, Any]):
    """The object that the command line prints with ``--json``, under the same keys, with tables as arrays.

    A notebook shows it as a table.
    """

    def _repr_html_(self) -> str:
        return _table(self)


class Impact(Result):
    """The solution of one impact."""

    @property
    def outcome(self) -> str:
        """``"rebound"``, ``"sustained"``, ``"no contact"``, or another outcome."""
        return str(self["outcome"])

    @property
    def restitution(self) -> float | None:
        """Speed of separation over speed of approach, 0 in sustained contact; ``None`` if the impact did not end."""
        return self["restitution"]  # type: ignore[no-any-return]

    @property
    def restitution_uncertainty(self) -> float | None:
        """Uncertainty of the restitution; ``None`` if that of the solver is not known."""
        return self["restitution_uncertainty"]  # type: ignore[no-any-return]

    @property
    def sub_impacts(self) -> NDArray[Any] | None:
        """The contacts as a structured array, with the columns ``start_s``, ``end_s``, ``impulse_n_s``, ``peak_force_n`` with its
        uncertainty ``peak_force_uncertainty_n`` and the parts of that (NaN where it is not known), and ``peak_compression_m``;
        ``None`` if the model does not resolve contacts."""
        return self["sub_impacts"]  # type: ignore[no-any-return]

    @property
    def history(self) -> Columns | None:
        """Motion and force over time, as columns by name; ``None`` unless requested and resolved by the model."""
        return self.get("history")

    def plot(self) -> Figure:
        """Draws motion and contact force over time. If no history was requested, the impact is solved once more."""
        history = _solved_again(self)["history"]
        if history is None:
            raise ValueError(f"nothing to plot: the model {self['choice']['model']} has no motion in time")
        figure, (motion, force) = _subplots(2, 1, sharex=True)
        time_ms = 1e3 * history["time_s"]
        # the surface of the striker, which may begin at a distance from the structure
        motion.plot(time_ms, 1e3 * (history["structure_displacement_m"] - history["compression_m"]), label="striker")
        motion.plot(time_ms, 1e3 * history["structure_displacement_m"], label="structure")
        motion.set(ylabel="displacement (mm)", title=self._headline())
        motion.legend()
        force.plot(time_ms, history["force_n"], color="C3")
        force.set(xlabel="time (ms)", ylabel="contact force (N)")
        return figure

    def _headline(self) -> str:
        if self.restitution is None:
            return self.outcome
        uncertainty = self.restitution_uncertainty
        return f"restitution {self.restitution:.4g}" + (f" ± {uncertainty:.1g}" if uncertainty else "")


class Motion(Result):
    """The solution of a scene of bodies."""

    @property
    def outcome(self) -> str:
        """The way in which the run ended."""
        return str(self["outcome"])

    @property
    def contacts(self) -> dict[str, Any]:
        """The contacts by their names; ``intervals`` of each is a structured array."""
        return self["contacts"]  # type: ignore[no-any-return]

    @property
    def history(self) -> Columns | None:
        """Gaps, forces and motions over time, as columns by name; ``None`` unless requested."""
        return self.get("history")

    def plot(self) -> Figure:
        """Draws the gap and the force of each contact over time. If no history was requested, the scene is solved once more."""
        history = _solved_again(self)["history"]
        figure, (gaps, forces) = _subplots(2, 1, sharex=True)
        for name in self.contacts:
            gaps.plot(history["time_s"], 1e3 * history[f"{name}_gap_m"], label=name)
            forces.plot(history["time_s"], history[f"{name}_force_n"])
        gaps.set(ylabel="gap (mm)")
        gaps.legend()
        forces.set(xlabel="time (s)", ylabel="contact force (N)")
        return figure


class Identification(Result):
    """Fields of a scene that were found from measurements."""

    @property
    def parameters(self) -> dict[str, float]:
        """The value of each free field."""
        return {found["field"]: found["value"] for found in self["parameters"]}

    @property
    def intervals(self) -> dict[str, tuple[float | None, float | None]]:
        """The interval of each free field by the likelihood profile; an end is ``None`` if the data do not determine it."""
        return {found["field"]: tuple(found["profile_interval"]) for found in self["parameters"]}

    def plot(self) -> Figure:
        """Draws the likelihood profile of each free field, with its interval, and the misfits in standard deviations."""
        count = len(self["profiles"]) + 1
        figure, axes = _subplots(1, count, figsize=(3.6 * count, 3.2))
        for drawn, profile in zip(axes, self["profiles"]):
            drawn.plot(profile["values"], profile["rise"], ".-")
            drawn.axhline(profile["limit"], color="grey", linestyle="--")
            for end in self.intervals[profile["field"]]:
                if end is not None:
                    drawn.axvline(end, color="grey", linewidth=0.8)
            drawn.axvline(self.parameters[profile["field"]], color="C3")
            drawn.set(xlabel=profile["field"], ylabel="rise of the sum of squares")
        for quantity in dict.fromkeys(row["quantity"] for row in self["predictions"]):
            rows = [row for row in self["predictions"] if row["quantity"] == quantity]
            misfits = [(row["measured"] - row["predicted"]) / row["measured_sd"] for row in rows]
            axes[-1].plot([row["line"] for row in rows], misfits, "o", label=quantity)
        axes[-1].axhline(0.0, color="grey", linewidth=0.8)
        axes[-1].set(xlabel="line of the table", ylabel="misfit (standard deviations)")
        if self["predictions"]:
            axes[-1].legend()
        return figure


def _solved_again(found: Result) -> Result:
    """The result with its history."""
    if "history" in found:
        return found
    from ._vibroimpact import simulate

    again: Result = simulate(found["scene"], history=True)
    return again


def _subplots(rows: int, columns: int, **settings: Any) -> tuple[Figure, Any]:
    try:
        from matplotlib import pyplot
    except ImportError as missing:
        raise ImportError("plot() needs matplotlib, which `pip install matplotlib` installs") from missing
    return pyplot.subplots(rows, columns, layout="constrained", **settings)


def _table(entries: Mapping[str, Any]) -> str:
    cells = ((escape(name), _cell(value)) for name, value in entries.items())
    rows = (f"<tr><th style='text-align: left'>{name}</th><td>{cell}</td></tr>" for name, cell in cells)
    return f"<table>{''.join(rows)}</table>"


def _cell(value: Any) -> str:
    if isinstance(value, Mapping):
        count = "1 entry" if len(value) == 1 else f"{len(value)} entries"
        return f"<details><summary>{count}</summary>{_table(value)}</details>" if value else "empty"
    if isinstance(value, np.ndarray):
        columns = f" with the columns {', '.join(value.dtype.names)}" if value.dtype.names else ""
        return escape(f"array of shape {value.shape}{columns}")
    if isinstance(value, list) and any(isinstance(entry, Mapping) for entry in value):
        return _cell({str(i): entry for i, entry in enumerate(value)})
    return escape(f"{value:.6g}" if isinstance(value, float) else str(value))
