"""Arrays of Python as a recording."""

from __future__ import annotations

from collections.abc import Mapping
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

_DOUBLE = np.dtype(np.float64)


def columns_of(samples: Mapping[str, Any]) -> list[tuple[str, bytes]]:
    """Names and doubles of the arrays that are not `None`.

    `ValueError`: an array is not one of real numbers.
    """
    unknown = [name for name in samples if name not in _DIMENSIONS]
    if unknown or samples.get("t") is None:
        what = f"found {unknown[0]!r}" if unknown else "t is missing"
        raise ValueError(f"expected arrays t, x, v, a, force; {what}")
    given = [(name, samples.get(name)) for name in _DIMENSIONS]
    return [
        (name, (values if _is_column(values) else _column(name, values)).tobytes())
        for name, values in given
        if values is not None
    ]


def _is_column(values: Any) -> bool:
    """Whether nothing needs to be changed."""
    return type(values) is np.ndarray and values.dtype is _DOUBLE and values.ndim == 1


def _column(name: str, values: Any) -> Any:
    column = np.asarray(si_of(name, values, _DIMENSIONS[name]))
    if column.dtype.kind not in "iuf" or column.dtype.itemsize > 8:
        raise ValueError(f"{name}: expected real numbers up to float64, found {column.dtype}")
    if column.ndim != 1:
        raise ValueError(f"{name}: expected one dimension, found the shape {column.shape}")
    return np.asarray(column, dtype=np.float64)


def si_of(name: str, value: Any, dimension: str) -> Any:
    """A quantity with a unit of its own, as pint has them, in SI; anything else as it is.

    `ValueError`: it is a quantity of something else.
    """
    if not hasattr(value, "to_base_units"):
        return value
    if hasattr(value, "check") and not value.check(dimension):
        raise ValueError(f"{name}: expected a quantity of {dimension}, found {value.units}")
    return value.to_base_units().magnitude
