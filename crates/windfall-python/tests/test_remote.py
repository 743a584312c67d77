"""Files that lie where fsspec finds them."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import fsspec
import numpy as np
import pytest
import windfall as wf
from windfall._call import WRITTEN


@pytest.fixture
def memory() -> Any:
    """A file system of fsspec without a place on disk."""
    system = fsspec.filesystem("memory")
    yield system
    system.rm("/", recursive=True)


def test_reads_recordings_tables_and_campaigns(
    memory: Any, windfall: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    law = "kuwabara-kono(k=753599, c=1524)"
    wf.simulate_pendulum(law=law, specimens=2, repeats=2, recordings="study")
    memory.put("study", "/study", recursive=True)
    name = next(Path("study/raw").iterdir()).name
    far = wf.read(f"memory://study/raw/{name}")
    near = wf.read(Path("study/raw") / name)
    assert far.path == f"memory://study/raw/{name}"
    assert far.keys() == near.keys()
    assert all(np.array_equal(a.values, b.values) for a, b in zip(far, near))

    fitted = wf.fit_campaign("memory://study")
    assert not Path("study/results.sqlite").exists()
    assert fitted.impacts == wf.fit_campaign("study").impacts
    wf.fit_campaign("study", out="fits.csv")
    memory.put("fits.csv", "/fits.csv")
    here = wf.summary("fits.csv", value="k")
    assert wf.summary("memory://fits.csv", value="k").to_dict() == here.to_dict()


def test_rejects_what_is_not_there(memory: Any) -> None:
    with pytest.raises(FileNotFoundError):
        wf.read("memory://absent.csv")
    with pytest.raises(ValueError, match="[Pp]rotocol"):
        wf.read("no-such-place://a.csv")
    memory.pipe("/empty.csv", b"")
    with pytest.raises(ValueError, match="empty.csv"):
        wf.read("memory://empty.csv")


def test_rejects_results_that_would_be_lost(memory: Any, tmp_path: Path) -> None:
    memory.pipe("/fits.csv", b"id,k\na,1\n")
    with pytest.raises(ValueError, match="--out memory://fits.csv: windfall writes to this"):
        wf.summary("memory://fits.csv", value="k", out="memory://fits.csv")
    assert memory.cat("/fits.csv") == b"id,k\na,1\n"
    # Every option of the command that writes, by the list that its own tests go through.
    lists = Path(__file__).parents[2] / "windfall-cli/tests/outputs/options.rs"
    text = lists.read_text(encoding="utf-8")
    written = text[text.index("pub const WRITTEN") : text.index("pub const READ")]
    options = re.findall(r'\(\s*"[a-z ]*",\s*"(--[a-z-]+)"', written)
    assert len(options) > 50
    assert set(options) == WRITTEN
