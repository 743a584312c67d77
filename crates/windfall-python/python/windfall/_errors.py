"""What is raised."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from windfall._result import Result


class WindfallError(RuntimeError):
    """The work failed, although the request was in order.

    * `result`: what was found nevertheless, if anything
    * `messages`: what else the command said, a message each
    """

    def __init__(
        self, text: str, result: Result | None = None, messages: tuple[str, ...] = ()
    ) -> None:
        super().__init__(text)
        self.result = result
        self.messages = messages
