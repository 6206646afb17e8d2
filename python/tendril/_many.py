"""Many solves side by side, on every core."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import ArrayLike

from . import _core, _toml
from ._case import Case
from ._result import FloatArray, Result, Step

if TYPE_CHECKING:
    import pandas as pd


class Results(Sequence[Result]):
    """Results in the order of their cases, and single numbers of all of them as arrays.

    None is left out: look at `converged` before using a number. What a failed solve does not have is NaN.
    """

    def __init__(self, results: list[Result], samples: Mapping[str, Any]) -> None:
        self._results = results
        self.samples = dict(samples)

    @overload
    def __getitem__(self, index: int) -> Result: ...
    @overload
    def __getitem__(self, index: slice) -> list[Result]: ...
    def __getitem__(self, index: int | slice) -> Result | list[Result]:
        return self._results[index]

    def __len__(self) -> int:
        return len(self._results)

    def __iter__(self) -> Iterator[Result]:
        return iter(self._results)

    @property
    def converged(self) -> np.ndarray[Any, np.dtype[np.bool_]]:
        return np.array([r.converged for r in self], dtype=bool)

    def values(self, name: str) -> FloatArray:
        """A number of each last step by its name in the result: "rod_length", "force_max", "push", ..."""
        return np.array([getattr(r, name) if r.converged else np.nan for r in self], dtype=float)

    def to_pandas(self) -> pd.DataFrame:
        """One row per case: its sample, status and the numbers of its last step."""
        import pandas as pd

        rows = [{**{k: v[i] for k, v in self.samples.items()}, **r.steps[-1].summary()} for i, r in enumerate(self)]
        return pd.DataFrame(rows)

    def __repr__(self) -> str:
        return f"<tendril.Results of {len(self)} cases, {int(self.converged.sum())} converged>"


def solve_many(
    cases: Case | Iterable[Case],
    samples: Mapping[str, ArrayLike | Sequence[str]] | None = None,
    *,
    threads: int = 0,
    points: int = 0,
) -> Results:
    """Solve a list of cases, or one case with arrays of values, each from nothing and on its own.

    >>> solve_many(case, {"end.axial_force": np.linspace(-1, -9, 100), "tube.clearance": 0.05})

    `samples` gives a value per solve for each key; one value serves all. The interpreter is free meanwhile. Results
    are the same bits for any number of `threads` (0: one per core). Fields along the tube are kept with `points` > 0.
    """
    if isinstance(cases, Case):
        if not samples:
            raise ValueError("one case needs `samples`: an array of values for each key that varies")
        columns = {key: _column(value) for key, value in samples.items()}
        count = max(len(column) for column in columns.values())
        wrong = [key for key, column in columns.items() if len(column) not in (1, count)]
        if wrong:
            raise ValueError(f"`{wrong[0]}` has {len(columns[wrong[0]])} values where others have {count}")
        columns = {key: column * (count if len(column) == 1 else 1) for key, column in columns.items()}
        changes = [_toml.overrides({key: column[i] for key, column in columns.items()}) for i in range(count)]
        built = [Case._of(core) for core in _core.replace_all(cases._core, changes, threads)]
    elif samples is not None:
        raise ValueError("`samples` goes with one case, not with a list of them")
    else:
        built, columns = list(cases), {}
    solved = _core.solve_all([case._core for case in built], threads, points)
    return Results([Result(case, core) for case, core in zip(built, solved)], columns)


def _column(values: Any) -> list[Any]:
    plain = _toml.plain(values)
    return list(plain) if isinstance(plain, (list, tuple, range)) else [plain]


__all__ = ["Results", "Step", "solve_many"]
