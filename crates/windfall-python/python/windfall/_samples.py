"""Arrays of Python as a recording."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from io import BytesIO
from typing import Any

import numpy as np

CHANNELS = {
    "x": ("position", "m"),
    "v": ("velocity", "m/s"),
    "a": ("acceleration", "m/s^2"),
    "force": ("force", "N"),
}
"""Arguments, with the channels and units that they are."""

_DIMENSIONS = {
    "t": "[time]",
    "x": "[length]",
    "v": "[length] / [time]",
    "a": "[length] / [time] ** 2",
    "force": "[mass] * [length] / [time] ** 2",
}


def npy_of(samples: Mapping[str, Any]) -> bytes:
    """The bytes of a file of NumPy with a column for each array that is not `None`.

    `ValueError`: an array is not one of finite real numbers, is empty, or is not as long as
    the times.
    """
    unknown = [name for name in samples if name not in _DIMENSIONS]
    if unknown or samples.get("t") is None:
        what = f"found {unknown[0]!r}" if unknown else "t is missing"
        raise ValueError(f"expected arrays t, x, v, a, force; {what}")
    given = {name: values for name, values in samples.items() if values is not None}
    columns = {name: _column(name, values) for name, values in given.items()}
    length = len(columns["t"])
    for name, column in columns.items():
        if len(column) != length:
            raise ValueError(f"{name} has {len(column)} samples, and t has {length}")
    table = np.empty((length, len(columns)), dtype="<f8")
    for place, column in enumerate(columns.values()):
        table[:, place] = column
    return _head(tuple(columns), length) + table.tobytes()


@lru_cache
def _head(names: tuple[str, ...], length: int) -> bytes:
    """The head of such a file."""
    columns = np.dtype([(name, "<f8") for name in names])
    descr = np.lib.format.dtype_to_descr(columns)
    file = BytesIO()
    head = {"descr": descr, "fortran_order": False, "shape": (length,)}
    np.lib.format.write_array_header_1_0(file, head)
    return file.getvalue()


def _column(name: str, values: Any) -> Any:
    column = np.asarray(si_of(name, values, _DIMENSIONS[name]))
    if column.dtype.kind not in "iuf" or column.dtype.itemsize > 8:
        raise ValueError(f"{name}: expected real numbers up to float64, found {column.dtype}")
    if column.ndim != 1:
        raise ValueError(f"{name}: expected one dimension, found the shape {column.shape}")
    if len(column) == 0:
        raise ValueError(f"{name}: expected samples, found none")
    column = np.asarray(column, dtype=np.float64)
    if not np.isfinite(column).all():
        lost = np.flatnonzero(~np.isfinite(column))
        raise ValueError(
            f"{name}: sample {lost[0]} is {column[lost[0]]}; leave out the rows of samples that "
            f"are missing ({len(lost)} of {len(column)})"
        )
    return column


def si_of(name: str, value: Any, dimension: str) -> Any:
    """A quantity with a unit of its own, as pint has them, in SI; anything else as it is.

    `ValueError`: it is a quantity of something else.
    """
    if not hasattr(value, "to_base_units"):
        return value
    if hasattr(value, "check") and not value.check(dimension):
        raise ValueError(f"{name}: expected a quantity of {dimension}, found {value.units}")
    return value.to_base_units().magnitude
