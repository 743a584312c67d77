"""Examples run."""

from __future__ import annotations

from pathlib import Path

import examples
import pytest


def test_examples_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    examples.main(tmp_path)
    lines = capsys.readouterr().out.splitlines()
    value, low, high = map(float, lines[0].split())
    assert low < value < high
    assert "absent.csv" in lines[-1]
