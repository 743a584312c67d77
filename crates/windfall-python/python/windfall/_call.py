"""From the arguments of a function to the words of a command, and from what it says to a result."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping, Sequence
from importlib import import_module
from typing import TYPE_CHECKING, Any, Protocol, Union

from windfall import _native
from windfall._errors import WindfallError
from windfall._progress import bar
from windfall._result import Result

if TYPE_CHECKING:
    from tempfile import TemporaryDirectory


class ToCsv(Protocol):
    """A data frame of pandas."""

    def to_csv(self, path: Any, /, *, index: bool) -> Any: ...


class WriteCsv(Protocol):
    """A data frame of polars."""

    def write_csv(self, file: Any, /) -> Any: ...


Path = Union[str, "os.PathLike[str]"]
"""A file or a directory. One that is read may lie where fsspec finds it, "s3://bucket/study": it
is copied for the call, and what is written beside it is lost with the copy."""
Table = Union[Path, ToCsv, WriteCsv]
"""A file with a table, or a data frame of pandas (without its index) or polars."""
Value = Union[str, int, float]
"""A value as on the command line: text with a unit, a name, a number."""


_REMOTE = re.compile(r"[A-Za-z][A-Za-z0-9+.:-]+://")
"""How the place of a file begins that is not a path: "s3://", "simplecache::https://"."""

WRITTEN = frozenset(
    "--card --detail --example --export --figure --figures --out --plot --recordings "
    "--tables".split()
)
"""Options that name what is written, which goes to this machine alone."""


def call(
    command: str,
    places: Sequence[Any],
    options: Mapping[str, Any],
    *,
    json: bool,
    force: bool,
    also_read: Path | Sequence[Path],
    progress: bool,
) -> Result:
    """Runs a command.

    * `places`: arguments without names, in order; `None` is left out
    * `options`: arguments with the names that they have on the command line
    * `json`: whether the command can answer as JSON

    `ValueError`: the request was wrong. `WindfallError`: the work failed.
    """
    with Words() as words:
        given = command.split()
        for option, value in options.items():
            given += words.of_option(option, value)
        given += words.of_option("--also-read", also_read)
        given += ["--format=json"] * json + ["--force"] * force + ["--"]
        for place in places:
            given += words.of_values(place)
        with bar(progress) as tell:
            text, messages, status = _native.call(given, tell)
        messages = words.without_files(messages)
    return outcome(text, messages, status)


def outcome(text: str, messages: str, status: int) -> Result:
    """The result of a command, or what it said was wrong."""
    if status == 0:
        return Result.from_json(text, tuple(messages.splitlines()))
    # Of several the last one is that of the command itself.
    *_, last = re.finditer("^error: ", messages, re.MULTILINE)
    told = tuple(messages[: last.start()].splitlines())
    error = messages[last.end() :]
    if status == 2:
        raise ValueError("\n".join([error.rstrip(), *told]))
    result = Result.from_json(text, told) if text else None
    raise WindfallError("\n".join([error.rstrip(), *told]), result, told)


class Words:
    """Words of a command line, and the files of data frames and copies that they name."""

    def __init__(self) -> None:
        self._folder: TemporaryDirectory[str] | None = None
        self.files: list[str] = []

    def __enter__(self) -> Words:
        return self

    def __exit__(self, *_: object) -> None:
        if self._folder is not None:
            self._folder.cleanup()

    def of_option(self, option: str, value: Any) -> Iterator[str]:
        """An option once for each of its values."""
        if value is None or value is False:
            return
        if value is True:
            yield option
            return
        path = os.fspath(value) if isinstance(value, (str, os.PathLike)) else ""
        if option in WRITTEN and _REMOTE.match(str(path)):
            raise ValueError(
                f"{option} {path}: windfall writes to this machine alone; "
                "name a path here, and copy what was written"
            )
        for word in self.of_values(value):
            yield f"{option}={word}"

    def of_values(self, value: Any) -> Iterator[str]:
        """A value, or each of several."""
        if value is None:
            return
        several = isinstance(value, Sequence) and not isinstance(value, (str, bytes))
        for one in value if several else [value]:
            yield self._word(one)

    def _word(self, value: Any) -> str:
        if hasattr(value, "to_csv"):
            path = self._path()
            value.to_csv(path, index=False)
            return path
        if hasattr(value, "write_csv"):
            path = self._path()
            value.write_csv(path)
            return path
        if isinstance(value, os.PathLike):
            value = os.fsdecode(value)
        if isinstance(value, str) and _REMOTE.match(value):
            return self._copied(value)
        if isinstance(value, bool) or not isinstance(value, (str, int, float)):
            kind = type(value).__name__
            raise TypeError(f"{value!r}: expected text, a number, a path or a table, found {kind}")
        return str(value)

    def _copied(self, url: str) -> str:
        """The copy of a file or directory that fsspec finds, under its own name."""
        try:
            fsspec: Any = import_module("fsspec")
        except ImportError as error:
            raise ImportError(f"{url}: to read it, install fsspec: pip install fsspec") from error
        system, path = fsspec.core.url_to_fs(url)
        place = os.path.join(self._place(), str(len(self.files)))
        copy = os.path.join(place, os.path.basename(path.rstrip("/")))
        os.makedirs(place)
        system.get(path, copy, recursive=system.isdir(path))
        self.files.append(copy)
        return copy

    def _path(self) -> str:
        self.files.append(os.path.join(self._place(), f"{len(self.files)}.csv"))
        return self.files[-1]

    def _place(self) -> str:
        if self._folder is None:
            # Only few calls need it, and it takes as long to import as all the rest.
            from tempfile import TemporaryDirectory

            self._folder = TemporaryDirectory(prefix="windfall-")
        return self._folder.name

    def without_files(self, text: str) -> str:
        """Messages that do not name the files of data frames and the copies."""
        for file in self.files:
            text = text.replace(file, "the data frame")
        return text
