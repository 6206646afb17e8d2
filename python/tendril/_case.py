"""Cases: read from a file or given as plain Python, solved or followed."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _core, _toml
from ._result import Result, Step


class Case:
    """A rod, its tube, ends, loads and how to solve: the model of the case file.

    Give the tables as dicts, with numpy arrays for the points of an axis, a clearance along S, or any list of numbers:

    >>> case = Case(rod={"bending_stiffness": 1.0, "torsional_stiffness": 0.75},
    ...             tube={"clearance": 0.05, "axis": {"kind": "straight", "length": 1.0}},
    ...             start={"kind": "clamped"}, end={"kind": "sleeve", "axial_force": 1.0, "torque": 0.0})

    A whole case may also be one dict, `Case(model)`. `tendril.explain("tube.axis")` says what a key means. Wrong input
    raises CaseError with everything that is wrong. A case does not change; `replace` makes another one.
    """

    def __init__(
        self,
        model: Mapping[str, Any] | None = None,
        /,
        *,
        directory: str | os.PathLike[str] = "",
        **tables: Any,
    ) -> None:
        """`directory` is where relative file names of the case start (default: the working directory)."""
        whole = {"schema": 1, **(model or {}), **tables}
        whole = {key: value for key, value in whole.items() if value is not None}
        self._core = _core.Case.parse(_toml.document(whole), "<case>", [], os.fspath(directory))

    @classmethod
    def _of(cls, core: _core.Case) -> Case:
        case = cls.__new__(cls)
        case._core = core
        return case

    # ---- what it says ----
    @property
    def title(self) -> str:
        return self._core.title

    @property
    def file(self) -> str:
        """The file as given to `load`, "<case>" for a case from Python."""
        return self._core.name

    @property
    def text(self) -> str:
        """The case as the text of a case file (before `replace`); written to a file it runs in the program."""
        return self._core.text

    @property
    def units(self) -> str:
        return "si" if self._core.si else "dimensionless"

    @property
    def length(self) -> float:
        """Length of the axis."""
        return self._core.length

    @property
    def parameter(self) -> str | None:
        """The parameter of its path, if it has one."""
        return self._core.parameter

    @property
    def notes(self) -> tuple[str, ...]:
        """Worth knowing, not wrong."""
        return tuple(self._core.notes)

    def __repr__(self) -> str:
        path = f", path in {self.parameter}" if self.parameter else ""
        return f"<tendril.Case {self.title or self.file!r}: {self._core.axis_kind} of length {self.length:g}{path}>"

    # ---- other cases from it ----
    def replace(self, changes: Mapping[str, Any]) -> Case:
        """The case with other values, by key: `case.replace({"end.axial_force": "-12 klbf"})`. None takes a key out."""
        return Case._of(self._core.replaced(_toml.overrides(changes)))

    # ---- solving ----
    def solve(
        self,
        *,
        initial: Result | Step | None = None,
        points: int = 401,
        max_seconds: float = 0.0,
    ) -> Result:
        """One state, or the states along the case's path: the numbers of `tendril run`, bit for bit.

        `initial` starts from a state that was found before; `points` is how many places along the tube the fields have;
        `max_seconds` ends a path early and keeps what was reached (0: no limit). A solve that fails does not raise: see
        `status` and `message` of the result.
        """
        if points < 2:
            raise ValueError("points must be at least 2")
        state = [] if initial is None else initial.state.tolist()
        return Result(self, self._core.solve(points, state, max_seconds))

    def follow(
        self,
        parameter: str,
        values: ArrayLike | Sequence[str],
        *,
        initial: Result | Step | None = None,
        points: int = 401,
        max_seconds: float = 0.0,
    ) -> Result:
        """Follow the solution from the case as written through each of `values`, with every event on the way.

        `parameter` is a number of the case ("end.axial_force", "tube.clearance.scale", ...); a value may be a string
        with its unit.
        """
        listed = values if isinstance(values, Sequence) else np.atleast_1d(np.asarray(values))
        case = self._moved("path", {"parameter": parameter, "values": listed})
        return case.solve(initial=initial, points=points, max_seconds=max_seconds)

    def _moved(self, table: str, keys: Mapping[str, Any]) -> Case:
        """With this [path] or [insertion] in place of the one it has."""
        has = None if self._core.parameter is None else "insertion" if self._core.inserts else "path"
        gone = {has: None} if has not in (None, table) else {}
        return self.replace({**gone, table: keys})


def load(file: str | os.PathLike[str], changes: Mapping[str, Any] | None = None) -> Case:
    """Read a case file (TOML, or JSON if it ends in .json); `changes` as in `Case.replace`.

    Raises CaseError with everything that is wrong, or OSError if the file cannot be read.
    """
    return Case._of(_core.Case.read(os.fspath(file), _toml.overrides(changes or {})))
