"""Rods in motion: fed in, withdrawn and turned, step by step."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from ._case import Case
from ._result import Result, Table


class Session:
    """A rod in its tube, moved interactively.

    >>> s = tendril.Session(case)
    >>> s.advance(0.001)                # in the unit of length of the case
    >>> s.rotate(0.1)                   # rad, right-handed about the tube's axis
    >>> s.contacts, s.fed, s.state()

    The case is solved as written, without its path. `advance` then feeds rod in at the inlet where the rod's length is
    given or its tip is free, and moves the far end along the tube otherwise. Where no state follows on from the last
    one the rod jumps to the stable state found downhill in energy, and the motion says so. RuntimeError if no state is
    found at the start.
    """

    def __init__(self, case: Case) -> None:
        self.case = case
        self._core = _core.Session.begin(case._core)
        if not self._core.ready:
            raise RuntimeError(self._core.reason)

    def advance(self, distance: float) -> _core.Motion:
        """Feed `distance` [length] more; negative withdraws. A motion is true when it got there; otherwise its `reason`
        says why not, and the session stays at the last state reached."""
        return self._core.advance(_finite("distance", distance))

    def rotate(self, angle: float) -> _core.Motion:
        """Turn the inlet by `angle` [rad], right-handed about the tangent of the axis."""
        return self._core.rotate(_finite("angle", angle))

    @property
    def fed(self) -> float:
        """Length of the rod fed in, or the place of the far end [length]."""
        return self._core.fed

    @property
    def rotation(self) -> float:
        """Angle of the inlet [rad]."""
        return self._core.rotation

    def state(self, *, points: int = 401) -> Result:
        """The present state, certified and judged for stability; its `events` are those of the motion so far."""
        if points < 2:
            raise ValueError("points must be at least 2")
        return Result(self.case, self._core.state(points))

    @property
    def contacts(self) -> Table:
        """Contacts of the present state."""
        return Result(self.case, self._core.state(0)).contacts

    @property
    def events(self) -> Table:
        """What happened to the contacts so far, `parameter` being the length fed in or the place of the far end."""
        return Result(self.case, self._core.state(0)).events

    def snapshot(self) -> _core.Snapshot:
        """The present state, to come back to with `restore`."""
        return self._core.snapshot()

    def restore(self, snapshot: _core.Snapshot) -> None:
        """Back to a state of this session; later events are forgotten."""
        if not self._core.restore(snapshot):
            raise ValueError("the snapshot belongs to another case")

    def __repr__(self) -> str:
        return f"<tendril.Session: {self.fed:g} fed, turned by {self.rotation:g} rad>"


def insert(
    case: Case,
    *,
    to: float | str | None = None,
    values: ArrayLike | Sequence[str] | None = None,
    step: float | str | None = None,
    rotation: float | str | None = None,
    points: int = 401,
    max_seconds: float = 0.0,
) -> Result:
    """Feed the rod of `case` in (or withdraw it), quasi-statically, with every event on the way.

    Either `to`, reached in motions of `step` and each reported, or the `values` to report in order. They are lengths of
    rod, or places of the far end where the length is not given and the end is not free. `rotation` turns the inlet,
    spread evenly over the way. The numbers are those of the program for a case with the table [insertion], which this
    puts in place of the path or insertion that the case has. CaseError for what cannot be meant.
    """
    table: dict[str, Any] = {"to": to, "step": step, "rotation": rotation}
    if values is not None:
        table["values"] = values if isinstance(values, Sequence) else np.atleast_1d(np.asarray(values))
    whole = {key: value for key, value in table.items() if value is not None}
    return case._moved("insertion", whole).solve(points=points, max_seconds=max_seconds)


def _finite(name: str, value: float) -> float:
    number = float(value)
    if not math.isfinite(number):
        raise ValueError(f"{name} must be a finite number, not {number}")
    return number


__all__ = ["Session", "insert"]
