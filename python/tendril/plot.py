"""matplotlib pictures of results: tracks along the tube, and the response along a path. Needs `pip install tendril[plot]`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from ._result import Result, Step, Table

_INK, _CONTACT = "#2a6fb0", "#d1432f"
_WORDS = {
    "gap": "gap",
    "pressure": "wall pressure",
    "F1": "shear F1",
    "F2": "shear F2",
    "F3": "axial force",
    "M1": "bending M1",
    "M2": "bending M2",
    "M3": "torque",
    "kappa": "curvature",
    "rod_length": "rod length",
    "axial_force_end": "axial force at the end",
    "torque_end": "torque at the end",
}


def tracks(
    result: Result | Step,
    columns: Sequence[str] = ("gap", "pressure", "F3", "kappa"),
    *,
    vertical: bool = False,
    offset: float = 0.0,
    place: str = "S",
) -> Figure:
    """Columns of the fields along the tube on one common scale, contacts shaded: lines as bands, points as strokes.

    `vertical` puts the place downwards, side by side, as logs of a well are read; `offset` is added to it (a survey that
    starts at a depth).
    """
    fields = result.fields
    S = fields.S + offset
    if vertical:
        figure, axes = plt.subplots(1, len(columns), sharey=True, figsize=(2.1 * len(columns) + 0.6, 6.5), squeeze=False)
    else:
        figure, axes = plt.subplots(len(columns), 1, sharex=True, figsize=(8, 1.5 * len(columns) + 0.6), squeeze=False)
    for name, axis in zip(columns, axes.flat):
        _shade(axis, result.contacts, offset, vertical)
        value = fields[name]
        axis.plot(*((value, S) if vertical else (S, value)), color=_INK, linewidth=1.4)
        axis.grid(alpha=0.25)
        axis.margins(**({"y": 0} if vertical else {"x": 0}))
        _label(axis, "x" if vertical else "y", name, result.units)
        if name in ("gap", "pressure"):
            (axis.set_xlim if vertical else axis.set_ylim)(0, None)
    if vertical:
        axes[0, 0].invert_yaxis()
        _label(axes[0, 0], "y", "S", result.units, place)
        for axis in axes.flat:
            axis.tick_params(axis="x", labelsize="small")
            axis.xaxis.set_major_locator(MaxNLocator(3))
    else:
        _label(axes[-1, 0], "x", "S", result.units, place)
    figure.align_labels()
    figure.tight_layout()
    return figure


def response(result: Result, quantity: str = "rod_length", axes: Axes | None = None) -> Axes:
    """A quantity of the trace ("rod_length", "axial_force_end", "torque_end") over the path parameter, events marked."""
    if axes is None:
        axes = plt.subplots(figsize=(7, 4.2))[1]
    trace, events = result.trace, result.events
    axes.plot(trace.parameter, trace[quantity], color=_INK, linewidth=1.4)
    listed = [step.parameter for step in result.steps if step.parameter is not None]
    axes.plot(listed, [getattr(step, quantity) for step in result.steps][: len(listed)], "o", color=_INK, markersize=4)
    if quantity in (events.dtype.names or ()):
        for i, event in enumerate(events, 1):
            at = (event["parameter"], event[quantity])
            words = str(event["kind"]).replace("_", " ")
            axes.plot(*at, "D", color=_CONTACT, markersize=5, label=f"{i}  {words} at {event['parameter']:.5g}")
            axes.annotate(str(i), at, xytext=(6, 5), textcoords="offset points", fontsize="small", color=_CONTACT)
        if len(events):
            axes.legend(fontsize="small", handlelength=1, frameon=False)
    axes.grid(alpha=0.25)
    unit = result.units["parameter"]
    axes.set_xlabel(f"{result.case.parameter} [{unit}]" if unit else str(result.case.parameter))
    _label(axes, "y", quantity, result.units)
    return axes


def _shade(axis: Axes, contacts: Table, offset: float, vertical: bool) -> None:
    stroke: Any = axis.axhline if vertical else axis.axvline
    band: Any = axis.axhspan if vertical else axis.axvspan
    for contact in contacts:
        if contact["kind"] == "line":
            band(contact["start"] + offset, contact["end"] + offset, color=_CONTACT, alpha=0.14, linewidth=0)
        else:
            stroke(contact["start"] + offset, color=_CONTACT, alpha=0.6, linewidth=1.0)


def _label(axis: Axes, which: str, name: str, units: Mapping[str, str], words: str = "") -> None:
    unit = units.get(name, "")
    words = words or _WORDS.get(name, name)
    text = f"{words} [{unit}]" if unit else words
    (axis.set_xlabel if which == "x" else axis.set_ylabel)(text)


__all__ = ["response", "tracks"]
