"""The one exception for wrong input, with everything that is wrong."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Issue:
    """One problem of a case: where it is, what was found, what is allowed, what to do."""

    path: str  # file as given; "--set" for a replaced value; "<case>" for a case from Python
    line: int  # 1-based; 0: the file as a whole
    column: int
    key: str  # "end.axial_force"
    message: str
    value: str = ""  # what was found
    bound: str = ""  # what is allowed
    hint: str = ""
    text: str = field(default="", repr=False)  # as the program prints it, with the line and a caret

    def __str__(self) -> str:
        return self.text or f"{self.path}: error: {self.message}"


class CaseError(ValueError):
    """Wrong input. `errors` has every problem that was found; the text is what the program prints."""

    errors: tuple[Issue, ...]

    def __init__(self, text: str, errors: Iterable[Issue] = ()) -> None:
        super().__init__(text)
        self.errors = tuple(errors)

    def __reduce__(self) -> tuple[type[CaseError], tuple[str, tuple[Issue, ...]]]:
        return type(self), (str(self), self.errors)


for _name in (Issue, CaseError):  # as users know them
    _name.__module__ = "tendril"
