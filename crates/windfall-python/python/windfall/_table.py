"""Tables of results, for data frames of any library."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from windfall import _native

if TYPE_CHECKING:
    from tempfile import TemporaryDirectory


class Table:
    """A table of results in a file of its own, which goes with this object.

    Every library that takes Arrow's PyCapsule reads it as it is: `polars.DataFrame(table)`,
    `pyarrow.table(table)`, `duckdb.from_arrow(table)`. Units are in the columns' metadata.
    """

    def __init__(self, folder: TemporaryDirectory[str], path: str) -> None:
        self._folder = folder
        self._path = path

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """Its rows, as Arrow's interface has them; another schema is for the caller to make."""
        return _native.arrow_stream(self._path)

    def to_arrow(self) -> Any:
        """A table of pyarrow."""
        pyarrow: Any = import_module("pyarrow")
        return pyarrow.table(self)

    def to_polars(self) -> Any:
        """A data frame of polars."""
        polars: Any = import_module("polars")
        return polars.DataFrame(self)

    def to_pandas(self) -> Any:
        """A data frame of pandas, through pyarrow."""
        return self.to_arrow().to_pandas()
