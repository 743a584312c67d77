"""Recordings of any format."""

from __future__ import annotations

import os
from collections.abc import Iterator
from importlib import import_module
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from windfall import _native
from windfall._call import Path, Value, Words
from windfall._result import table_html

if TYPE_CHECKING:
    from numpy.typing import NDArray


def numbers(data: bytes) -> NDArray[np.float64]:
    """The numbers that bytes stand for; they cannot be changed."""
    return np.frombuffer(data, dtype=np.float64)


class Channel:
    """A channel of a recording.

    * `name`: as in the file, and unique in it
    * `unit`: as the file or its name says, if either does
    * `values`: samples in this unit; NaN where a sample is missing
    * `time`: when they were taken, in s; `None` where the file does not say it
    """

    def __init__(
        self,
        name: str,
        unit: str | None,
        values: NDArray[np.float64],
        time: NDArray[np.float64] | None,
    ) -> None:
        self.name = name
        self.unit = unit
        self.values = values
        self.time = time

    def __len__(self) -> int:
        return len(self.values)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        return np.array(self.values, dtype=dtype, copy=copy)

    def __repr__(self) -> str:
        unit = f" in {self.unit}" if self.unit else ""
        return f"Channel({self.name!r}, {len(self.values)} samples{unit})"


class Recording:
    """What a file holds: channels by their names, in the order of the file.

    * `path`: the file
    * `format`: its format
    * `notes`: what is odd about it, code and sentence
    """

    def __init__(self, path: str, native: _native.Recording) -> None:
        self.path = path
        self.format = native.format
        self.notes = tuple(native.notes)
        self._channels = {}
        for place, (name, unit) in enumerate(native.channels):
            times = native.times(place)
            time = None if times is None else numbers(times)
            self._channels[name] = Channel(name, unit, numbers(native.samples(place)), time)

    @property
    def time(self) -> NDArray[np.float64]:
        """Times of the channels in s, where all of them have the same."""
        times = [channel.time for channel in self if channel.time is not None]
        if not times:
            raise ValueError(f"{self.path}: the file does not say when samples were taken")
        if not all(np.array_equal(times[0], other, equal_nan=True) for other in times[1:]):
            names = ", ".join(map(repr, self.keys()))
            raise ValueError(
                f"{self.path}: channels have times of their own; take those of one of {names}: "
                "recording[name].time"
            )
        return times[0]

    def keys(self) -> tuple[str, ...]:
        """Names of the channels."""
        return tuple(self._channels)

    def __getitem__(self, name: str) -> Channel:
        try:
            return self._channels[name]
        except KeyError:
            names = ", ".join(map(repr, self._channels))
            raise KeyError(f"{self.path} has no channel {name!r}; it has {names}") from None

    def __contains__(self, name: object) -> bool:
        return name in self._channels

    def __iter__(self) -> Iterator[Channel]:
        return iter(self._channels.values())

    def __len__(self) -> int:
        return len(self._channels)

    def __repr__(self) -> str:
        return f"Recording({self.path!r}, {self.format}, {list(self._channels)})"

    def _repr_html_(self) -> str:
        rows = [
            {"channel": own.name, "unit": own.unit or "", "samples": len(own)} for own in self
        ]
        return table_html(rows)

    def to_pandas(self) -> Any:
        """A `pandas.DataFrame` with a column for each channel; shorter ones end with NaN."""
        pandas: Any = import_module("pandas")
        columns = {own.name: pandas.Series(own.values.copy()) for own in self}
        return pandas.DataFrame(columns)

    def to_xarray(self) -> Any:
        """An `xarray.Dataset` with a variable for each channel, over its time in s."""
        xarray: Any = import_module("xarray")
        variables = {}
        for own in self:
            dimension = f"time of {own.name}"
            array = xarray.DataArray(own.values.copy(), dims=dimension, name=own.name)
            if own.time is not None:
                array = array.assign_coords({dimension: own.time})
            array.attrs["units"] = own.unit or ""
            variables[own.name] = array
        return xarray.Dataset(variables, attrs={"source": self.path, "format": self.format})


def read(
    path: Path,
    *,
    file_format: str | None = None,
    separator: Literal["comma", "semicolon", "tab", "bar", "blanks"] | None = None,
    decimal: Literal["point", "comma"] | None = None,
    thousands: Literal["point", "comma", "apostrophe", "space"] | None = None,
    encoding: str | None = None,
    header_line: int | None = None,
    comment: str | None = None,
    missing: Value | list[Value] | None = None,
    footer: int | None = None,
) -> Recording:
    """Reads a recording: text, LVM, TDMS, MAT, HDF5, WAV, UFF58, sigrok, xlsx, ods, npy, zip.

    * `path`: a file, or where fsspec finds it: "s3://bucket/apple.tdms"

    What is left out is found out; the arguments are those of `inspect`. Samples are those of
    the file, in its units.
    """
    options = {
        "--file-format": file_format,
        "--separator": separator,
        "--decimal": decimal,
        "--thousands": thousands,
        "--encoding": encoding,
        "--header-line": header_line,
        "--comment": comment,
        "--missing": missing,
        "--footer": footer,
    }
    with Words() as words:
        given = [word for option in options.items() for word in words.of_option(*option)]
        native = _native.read([*given, "--", *words.of_values(path)])
    return Recording(os.fsdecode(path), native)
