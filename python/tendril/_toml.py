"""Plain Python and numpy values as the text of a case file, so that they meet the same reader as any case file.

Numbers keep every bit: the shortest decimal that reads back as the same double.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Mapping
from typing import Any

from ._errors import CaseError, Issue

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")


def _refuse(key: str, value: object) -> CaseError:
    hint = "leave the key out" if value is None else "use numbers, strings, lists, dicts or numpy arrays"
    issue = Issue("<case>", 0, 0, key, f"`{key}` cannot be {type(value).__name__}", value=repr(value), hint=hint)
    text = f"<case>: error: {issue.message}\n        found: {issue.value}\n         hint: {hint}"
    return CaseError(text, [issue])


def plain(value: Any) -> Any:
    """numpy scalars and arrays, and whatever else knows `tolist`, as plain Python."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    return value


def _string(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _key(name: object) -> str:
    text = str(name)
    return text if _BARE_KEY.fullmatch(text) else _string(text)


def inline(value: Any, key: str) -> str:
    """A value on one line."""
    value = plain(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value)  # inf and nan too: the reader refuses them with their place
    if isinstance(value, str):
        return _string(value)
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_key(k)} = {inline(v, f'{key}.{k}')}" for k, v in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(inline(item, key) for item in value) + "]"
    raise _refuse(key, value)


def _rows(value: list[Any] | tuple[Any, ...], key: str) -> str:
    """Lists of lists (points, tables), a row on each line, so that an error names its row."""
    return "[\n" + "".join(f"  {inline(row, key)},\n" for row in value) + "]"


def document(model: Mapping[str, Any], path: str = "") -> str:
    """A table with its members: values first, then a section for each table in it."""
    values: list[str] = []
    sections: list[str] = []
    for name, given in model.items():
        value = plain(given)
        key = f"{path}.{_key(name)}" if path else _key(name)
        if isinstance(value, Mapping):
            sections.append(f"\n[{key}]\n{document(value, key)}")
        elif isinstance(value, (list, tuple)) and any(isinstance(plain(row), (list, tuple)) for row in value):
            values.append(f"{_key(name)} = {_rows(value, key)}\n")
        else:
            values.append(f"{_key(name)} = {inline(value, key)}\n")
    return "".join(values + sections)


def overrides(changes: Mapping[str, Any]) -> list[str]:
    """Changes as `key=value`; None takes the key out."""
    return [f"{key}=" if value is None else f"{key}={inline(value, key)}" for key, value in changes.items()]
