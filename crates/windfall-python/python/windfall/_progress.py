"""Progress bars, where tqdm is installed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib import import_module
from importlib.util import find_spec
from typing import Any

Tell = Callable[[int, int], None]


@contextmanager
def bar(shown: bool) -> Iterator[Tell | None]:
    """Shows how many items are done of how many; nothing without tqdm."""
    if not shown or find_spec("tqdm") is None:
        yield None
        return
    tqdm: Any = import_module("tqdm.auto").tqdm
    with tqdm(total=0, unit="item") as shown_bar:

        def tell(done: int, all_items: int) -> None:
            shown_bar.total = all_items
            shown_bar.update(done - shown_bar.n)

        yield tell
