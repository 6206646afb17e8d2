"""Results: the keys of the result file as attributes, numbers as read-only numpy views of the solver's own memory."""

from __future__ import annotations

import html
import json
import os
import pathlib
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from . import _core

if TYPE_CHECKING:
    import pandas as pd
    from typing_extensions import TypeAlias

    from ._case import Case

FloatArray: TypeAlias = "np.ndarray[Any, np.dtype[np.float64]]"

_CONTACT = np.dtype(
    [("kind", "U6"), ("start", float), ("end", float), ("s_start", float), ("s_end", float)]
    + [("angle_start", float), ("angle_end", float), ("force_start", float), ("force_end", float)]
    + [("force_distributed", float), ("force", float), ("force_vector", float, (3,))]
    + [("pressure_min", float), ("pressure_max", float), ("pressure_mid", float)]
)
_SEGMENT = np.dtype([("kind", "U4"), ("start", float), ("end", float)])
_EVENT = np.dtype(
    [("parameter", float), ("kind", "U20"), ("S", float), ("rod_length", float), ("axial_force_end", float)]
)
_TRACE = np.dtype(
    [("parameter", float), ("rod_length", float), ("axial_force_end", float), ("torque_end", float), ("contacts", int)]
)


class Table(np.recarray[Any, Any]):
    """A structured array: `table.force` and `table["force"]` are columns, `table[0]` is a row. Read-only."""

    @classmethod
    def _of(cls, rows: list[Any], dtype: np.dtype[Any]) -> Table:
        table = np.array(rows, dtype=dtype).view(cls)
        table.flags.writeable = False
        return table

    def to_pandas(self) -> pd.DataFrame:
        """A DataFrame; a vector becomes three columns, _x, _y, _z."""
        import pandas as pd

        columns: dict[str, Any] = {}
        for name in self.dtype.names or ():
            column = np.asarray(self[name])
            if column.ndim == 1:
                columns[name] = column
            else:
                columns.update({f"{name}_{axis}": column[:, i] for i, axis in enumerate("xyz")})
        return pd.DataFrame(columns)


class Fields(Mapping[str, FloatArray]):
    """The rod along the tube, a row per place S: `fields.F3` or `fields["F3"]`, read-only views without copies.

    S along the axis, s along the unstressed rod, x, y, z in the world, delta1, delta2 (eccentricity in D1, D2), phi, gap
    to the wall, pressure, forces F1, F2, F3 and moments M1, M2, M3 in the intermediate basis, curvature kappa.
    """

    S: FloatArray
    s: FloatArray
    x: FloatArray
    y: FloatArray
    z: FloatArray
    delta1: FloatArray
    delta2: FloatArray
    phi: FloatArray
    gap: FloatArray
    pressure: FloatArray
    F1: FloatArray
    F2: FloatArray
    F3: FloatArray
    M1: FloatArray
    M2: FloatArray
    M3: FloatArray
    kappa: FloatArray

    def __init__(self, step: _core.Step, units: Mapping[str, str]) -> None:
        self.units = {name: units[name] for name in _core.FIELDS}
        self._columns = {name: step.field(i) for i, name in enumerate(_core.FIELDS)}
        vars(self).update(self._columns)

    def __getitem__(self, name: str) -> FloatArray:
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def to_pandas(self) -> pd.DataFrame:
        import pandas as pd

        return pd.DataFrame(self._columns)

    def __repr__(self) -> str:
        return f"<tendril.Fields {', '.join(self._columns)}: {len(self.S)} places>"


class _State:
    """What a step says, and a result through its last step."""

    _step: _core.Step
    _units: Mapping[str, str]

    @property
    def parameter(self) -> float | None:
        """Value of the path parameter; None without a path."""
        return self._step.parameter

    @property
    def rod_length(self) -> float:
        """Unstressed length of the rod between the ends."""
        return self._step.rod_length

    @property
    def axial_force_start(self) -> float:
        """F3 just inside the start, tension positive."""
        return self._step.axial_force_start

    @property
    def axial_force_end(self) -> float:
        """F3 just inside the end, tension positive."""
        return self._step.axial_force_end

    @property
    def torque_start(self) -> float:
        return self._step.torque_start

    @property
    def torque_end(self) -> float:
        return self._step.torque_end

    @property
    def push(self) -> float:
        """Thrust on the straight rod outside a frictionless sleeve, compression positive."""
        return self._step.push

    @property
    def stability(self) -> str:
        """ "stable", "unstable" or "unknown"."""
        return self._step.stability

    @property
    def branch(self) -> str:
        """Which of several solutions this is and how it was reached, in words."""
        return self._step.branch

    @property
    def certificate(self) -> _core.Certificate:
        """How well the state satisfies the equations; all figures dimensionless (docs/notation.md)."""
        return self._step.certificate

    @property
    def effort(self) -> _core.Effort:
        return self._step.effort

    @property
    def state(self) -> FloatArray:
        """Pattern, mesh and unknowns, opaque: what `initial` starts from."""
        return self._step.state

    @property
    def contacts(self) -> Table:
        """Contacts in order of S; what a point or a clamp does not have is NaN."""
        return Table._of(self._step.contacts(), _CONTACT)

    @property
    def segments(self) -> Table:
        """Free and line pieces in order of S."""
        return Table._of(self._step.segments(), _SEGMENT)

    @property
    def force_max(self) -> float:
        """Largest force of one contact; 0 without contact."""
        return max((float(row[10]) for row in self._step.contacts()), default=0.0)

    @property
    def fields(self) -> Fields:
        return Fields(self._step, self._units)

    # The columns in daily use, without the detour over `fields`.
    @property
    def S(self) -> FloatArray:
        return self.fields.S

    @property
    def s(self) -> FloatArray:
        return self.fields.s

    @property
    def x(self) -> FloatArray:
        return self.fields.x

    @property
    def y(self) -> FloatArray:
        return self.fields.y

    @property
    def z(self) -> FloatArray:
        return self.fields.z

    @property
    def gap(self) -> FloatArray:
        return self.fields.gap

    @property
    def pressure(self) -> FloatArray:
        return self.fields.pressure

    @property
    def units(self) -> Mapping[str, str]:
        """Unit of each number by its name; "" where the case is dimensionless."""
        return self._units

    def summary(self) -> dict[str, Any]:
        """The numbers of the step on one line; NaN where no state was reached."""
        step = self._step
        reached = len(step.state) > 0
        names = ("rod_length", "axial_force_start", "axial_force_end", "torque_start", "torque_end", "push")
        numbers = {name: getattr(step, name) if reached else np.nan for name in names}
        return {
            **({} if step.parameter is None else {"parameter": step.parameter}),
            "status": step.status,
            **numbers,
            "contacts": len(step.contacts()),
            "force_max": self.force_max if reached else np.nan,
            "stability": step.stability,
            "error": step.certificate.error if reached else np.nan,
        }


class Step(_State):
    """One listed state of a path, or the only one."""

    def __init__(self, step: _core.Step, units: Mapping[str, str]) -> None:
        self._step = step
        self._units = units

    @property
    def status(self) -> str:
        """ "converged", "not_converged" or "outside_validity"."""
        return self._step.status

    @property
    def converged(self) -> bool:
        return self.status == "converged"

    @property
    def message(self) -> str:
        """Why, where and what was tried; empty when converged."""
        return self._step.message

    def __repr__(self) -> str:
        at = "" if self.parameter is None else f" at {self.parameter:g}"
        return f"<tendril.Step{at}: {self.status}, {_count(len(self.contacts), 'contact')}, {self.stability}>"


class Result(_State):
    """What a solve found: `steps`, `events` and `trace`; fields, contacts and numbers are those of the last step."""

    def __init__(self, case: Case, core: _core.Result) -> None:
        self.case = case
        self._core = core
        self._units = dict(core.units())
        self.steps: tuple[Step, ...] = tuple(Step(core.step(i), self._units) for i in range(len(core)))
        self._step = self.steps[-1]._step

    @property
    def status(self) -> str:
        """The worst of the steps: "converged", "not_converged" or "outside_validity"."""
        return self._core.status

    @property
    def converged(self) -> bool:
        return self.status == "converged"

    @property
    def message(self) -> str:
        """Why, where and what was tried; empty when converged."""
        return self._core.message

    @property
    def events(self) -> Table:
        """Events on the path in the order met."""
        return Table._of(self._core.events(), _EVENT)

    @property
    def trace(self) -> Table:
        """Intermediate states of the path."""
        return Table._of(self._core.trace(), _TRACE)

    def to_pandas(self) -> pd.DataFrame:
        """One row per step. `contacts`, `events`, `trace` and `fields` have a `to_pandas` of their own."""
        import pandas as pd

        return pd.DataFrame([step.summary() for step in self.steps])

    def to_json(self, *, fields: bool = True) -> str:
        """The text of the result file, as the program writes it."""
        return self._core.json(fields)

    def to_dict(self, *, fields: bool = True) -> dict[str, Any]:
        """The result file as plain Python."""
        whole: dict[str, Any] = json.loads(self.to_json(fields=fields))
        return whole

    def save(self, path: str | os.PathLike[str], *, fields: bool = True) -> pathlib.Path:
        """Write the result file (.json), or without that suffix the directory of `tendril run --out`: result.json,
        contacts.csv, fields.csv and files for ParaView."""
        target = pathlib.Path(path)
        if target.suffix == ".json":
            target.write_text(self.to_json(fields=fields), encoding="utf-8")
        else:
            self._core.write(os.fspath(target))
        return target

    @overload
    def report(self) -> str: ...
    @overload
    def report(self, path: str | os.PathLike[str]) -> pathlib.Path: ...
    def report(self, path: str | os.PathLike[str] | None = None) -> str | pathlib.Path:
        """The result as one self-contained HTML page, returned or written to `path`."""
        if not _core.HAS_PAGE:
            raise RuntimeError("this build of tendril has no report page: it needs Node 18 or later with npm when built")
        page = self._core.page()
        if path is None:
            return page
        target = pathlib.Path(path)
        target.write_text(page, encoding="utf-8")
        return target

    def svg(self, step: int = -1) -> str:
        """A step as a picture: the rod in its tube, gap, pressure and axial force along it."""
        return self._core.picture(range(len(self.steps))[step])

    def _repr_html_(self) -> str:
        """In a notebook: the page of the result, or its picture in a build without the page."""
        if _core.HAS_PAGE:
            page = html.escape(self._core.page(), quote=True)
            return f'<iframe srcdoc="{page}" width="100%" height="720" style="border:0" title="Tendril result"></iframe>'
        return self.svg() if len(self.fields.S) else f"<pre>{html.escape(repr(self))}</pre>"

    def __repr__(self) -> str:
        contacts = _count(len(self.contacts), "contact")
        if len(self.steps) == 1:
            return f"<tendril.Result {self.status}: {contacts}, {self.stability}>"
        events = _count(len(self.events), "event")
        return f"<tendril.Result {self.status}: {len(self.steps)} steps, {events}, {contacts} in the last>"


def _count(number: int, word: str) -> str:
    return f"{number} {word}{'' if number == 1 else 's'}"
