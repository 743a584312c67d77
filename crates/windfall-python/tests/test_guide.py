"""The page of the guide: what it shows is what is printed."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

PAGE = Path(__file__).resolve().parents[3] / "docs" / "guide" / "src" / "python.md"
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def shown(text: str) -> re.Pattern[str]:
    """Text in which "…" stands for anything within a line."""
    parts = map(re.escape, text.split("…"))
    return re.compile("[^\n]*".join(parts))


def test_the_page_prints_what_it_shows(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    blocks = BLOCK.findall(PAGE.read_text())
    names: dict[str, Any] = {}
    assert [kind for kind, _ in blocks] == ["python", "text"] * 8
    for (_, code), (_, text) in zip(blocks[::2], blocks[1::2]):
        exec(compile(code, str(PAGE), "exec"), names)
        printed = capsys.readouterr().out
        assert shown(text).fullmatch(printed), f"shown:\n{text}\nprinted:\n{printed}"
