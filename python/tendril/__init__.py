"""Slender elastic rods held inside or around tubes.

>>> case = tendril.load("case.toml")        # or tendril.Case(rod=..., tube=..., start=..., end=...)
>>> r = case.solve()
>>> r.contacts.force, r.fields.F3, r.x
>>> path = case.follow("end.axial_force", [-10, -20, -30])
>>> path.events.to_pandas()

The numbers are those of the program `tendril`, bit for bit.
"""

import json as _json
from typing import Any as _Any

from . import _core
from ._case import Case, load
from ._core import Certificate, Effort, __version__
from ._errors import CaseError, Issue
from ._many import Results, solve_many
from ._result import Fields, Result, Step, Table
from ._session import Session, insert


def explain(key: str = "") -> str:
    """What a key of the case means; a table lists its keys, "" lists the tables."""
    text = _core.explain(key)
    if not text:
        raise KeyError(key)
    return text


def schema() -> "dict[str, _Any]":
    """JSON Schema (draft-07) of a case."""
    whole: dict[str, _Any] = _json.loads(_core.json_schema())
    return whole


__all__ = [
    "Case",
    "CaseError",
    "Certificate",
    "Effort",
    "Fields",
    "Issue",
    "Result",
    "Results",
    "Session",
    "Step",
    "Table",
    "__version__",
    "explain",
    "insert",
    "load",
    "schema",
    "solve_many",
]
