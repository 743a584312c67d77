"""Results: the JSON of a command, with attributes."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

_SCALARS = (str, int, float, bool, type(None))


class Result:
    """What a command found: `result.terms[0].estimate` is `result["terms"][0]["estimate"]`.

    All numbers are SI. Nothing in it can be changed; `to_dict` gives a copy that can. Lists are
    tuples. A command that answers in words alone has them in `text`.

    * `messages`: what else the command said, a message each
    """

    __slots__ = ("_held", "messages")
    _held: Any
    messages: tuple[str, ...]

    def __init__(self, held: Any, messages: tuple[str, ...] = ()) -> None:
        object.__setattr__(self, "_held", held)
        object.__setattr__(self, "messages", messages)

    @property
    def _data(self) -> Any:
        """What is held: JSON, as text until it is first asked for."""
        if isinstance(self._held, str):
            object.__setattr__(self, "_held", json.loads(self._held))
        return self._held

    @classmethod
    def from_json(cls, text: str, messages: tuple[str, ...] = ()) -> Result:
        """The result that a command printed."""
        if not text.startswith(("{", "[")):
            return cls({"text": text}, messages)
        return cls(text, messages)

    def to_dict(self) -> Any:
        """What `json.loads` makes of the command's JSON: dictionaries, lists and numbers."""
        return _copy(self._data)

    def keys(self) -> tuple[Any, ...]:
        """Names, or positions in a list."""
        return tuple(self._data if isinstance(self._data, dict) else range(len(self._data)))

    @property
    def findings(self) -> tuple[Any, ...]:
        """What a reader must know, of the whole and of its parts."""
        return tuple(_frozen(found) for found in _findings(self._data))

    def __getitem__(self, key: Any) -> Any:
        return _frozen(self._data[key])

    def __getattr__(self, name: str) -> Any:
        data = object.__getattribute__(self, "_data")
        if isinstance(data, dict) and name in data:
            return _frozen(data[name])
        known = ", ".join(data) if isinstance(data, dict) else f"{len(data)} items"
        raise AttributeError(f"no {name!r} in this result; it has {known}")

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError("a result cannot be changed; take a copy: to_dict()")

    def __delattr__(self, name: str) -> None:
        raise AttributeError("a result cannot be changed; take a copy: to_dict()")

    def __getstate__(self) -> tuple[Any, tuple[str, ...]]:
        return self._data, self.messages

    def __setstate__(self, state: tuple[Any, tuple[str, ...]]) -> None:
        object.__setattr__(self, "_held", state[0])
        object.__setattr__(self, "messages", state[1])

    def __contains__(self, key: object) -> bool:
        return key in self._data

    def __iter__(self) -> Iterator[Any]:
        return iter(self.keys() if isinstance(self._data, dict) else _frozen(self._data))

    def __len__(self) -> int:
        return len(self._data)

    def __eq__(self, other: object) -> bool:
        return self._data == other._data if isinstance(other, Result) else NotImplemented

    def __hash__(self) -> int:
        return hash(json.dumps(self._data, sort_keys=True))

    def __dir__(self) -> list[str]:
        names = self._data if isinstance(self._data, dict) else ()
        return sorted({*object.__dir__(self), *names})

    def __repr__(self) -> str:
        text = json.dumps(self._data, ensure_ascii=False)
        return f"Result({text if len(text) <= 300 else text[:297] + '...'})"

    def _repr_html_(self) -> str | None:
        """Its first table, for notebooks."""
        rows = _first_table(self._data)
        return None if rows is None else table_html(rows)


def _frozen(value: Any) -> Any:
    if isinstance(value, dict):
        return Result(value)
    if isinstance(value, list):
        return tuple(_frozen(item) for item in value)
    return value


def _copy(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _copy(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_copy(item) for item in value]
    return value


def _findings(value: Any) -> Iterator[Any]:
    if isinstance(value, list):
        for item in value:
            yield from _findings(item)
    elif isinstance(value, dict):
        for key, item in value.items():
            if key == "findings" and isinstance(item, list):
                yield from item
            else:
                yield from _findings(item)


def _first_table(value: Any) -> list[dict[str, Any]] | None:
    if isinstance(value, list):
        return value if value and all(isinstance(row, dict) for row in value) else None
    if isinstance(value, dict):
        return next(filter(None, map(_first_table, value.values())), None)
    return None


def table_html(rows: list[dict[str, Any]]) -> str:
    """Rows as a table: columns are what holds a single value in any of them."""
    from html import escape

    columns = dict.fromkeys(
        key for row in rows for key, cell in row.items() if isinstance(cell, _SCALARS)
    )
    head = "".join(f"<th>{escape(str(name))}</th>" for name in columns)
    lines = (
        "<tr>" + "".join(f"<td>{escape(_cell(row.get(name)))}</td>" for name in columns) + "</tr>"
        for row in rows
    )
    return f"<table><thead><tr>{head}</tr></thead><tbody>{''.join(lines)}</tbody></table>"


def _cell(value: Any) -> str:
    if value is None or not isinstance(value, _SCALARS):
        return ""
    return format(value, ".5g") if isinstance(value, float) else str(value)
