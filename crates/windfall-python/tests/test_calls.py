"""Calls of one process: at once, stopped, and with the files of the user."""

from __future__ import annotations

import os
import signal
import sqlite3
import subprocess
import sys
import threading
import time
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
import tqdm.auto
import windfall as wf


def table(path: Path, text: str = "a,b\n1,2\n2,4\n3,7\n") -> Path:
    path.write_text(text)
    return path


def test_files_of_others_are_replaced_by_the_call_alone_that_says_force(tmp_path: Path) -> None:
    source = table(tmp_path / "source.csv")
    for _ in range(2):
        mine = table(tmp_path / "mine.csv", "mine")
        with pytest.raises(ValueError, match="--force"):
            wf.inspect(source, export=mine)
        assert mine.read_text() == "mine"
        wf.inspect(source, export=mine, force=True)
        assert mine.read_text() != "mine"


def test_directories_are_read_by_the_call_alone_that_names_them(tmp_path: Path) -> None:
    (tmp_path / "laws").mkdir()
    (tmp_path / "other").mkdir()
    force = "displacement_m,force_N\n0,0\n0.001,10\n0.002,40\n"
    law = table(tmp_path / "other" / "force.csv", force)
    file = table(tmp_path / "laws" / "laws.toml", f'[laws.spring]\ntable = "{law}"\n')
    for also in (law.parent, str(law.parent), [law.parent]):
        with pytest.raises(ValueError, match="--also-read"):
            wf.card_show(laws=file)
        assert wf.card_show(laws=file, also_read=also).laws[0].name == "spring"


def test_inputs_are_never_replaced(tmp_path: Path) -> None:
    source = table(tmp_path / "source.csv")
    text = source.read_text()
    with pytest.raises(ValueError, match="input"):
        wf.inspect(source, export=source, force=True)
    assert source.read_text() == text


def test_two_threads_are_kept_from_each_others_force(tmp_path: Path) -> None:
    source, mine = table(tmp_path / "source.csv"), table(tmp_path / "mine.csv", "mine")
    ended = threading.Event()

    def force() -> None:
        while not ended.is_set():
            theirs = table(tmp_path / "theirs.csv", "theirs")
            wf.inspect(table(tmp_path / "other.csv"), export=theirs, force=True)

    other = threading.Thread(target=force)
    other.start()
    try:
        for _ in range(50):
            with pytest.raises(ValueError):
                wf.inspect(source, export=mine)
    finally:
        ended.set()
        other.join()
    assert mine.read_text() == "mine"


def test_other_threads_go_on_during_the_work(campaign: Path) -> None:
    counted, ended = [0], threading.Event()

    def count() -> None:
        while not ended.is_set():
            counted[0] += 1
            time.sleep(0.001)

    other = threading.Thread(target=count)
    other.start()
    before = counted[0]
    started = time.monotonic()
    wf.Campaign(campaign).fit(law=["kuwabara-kono", "hertz"], refit=True)
    took = time.monotonic() - started
    after = counted[0]
    ended.set()
    other.join()
    # At most a thousand in a second; a call that kept the interpreter would leave none.
    assert after - before > took * 1000 / 20


SLOW = """
import sys, windfall as wf
print("ready", flush=True)
try:
    wf.Campaign(sys.argv[1]).fit(intervals="bootstrap", replicates=20000)
except KeyboardInterrupt:
    print("stopped", flush=True)
    sys.exit(7)
"""


def test_ctrl_c_stops_the_work_and_leaves_nothing_half_written(campaign: Path) -> None:
    before = {path: path.read_bytes() for path in campaign.rglob("*") if path.is_file()}
    work = subprocess.Popen(
        [sys.executable, "-c", SLOW, str(campaign)], stdout=subprocess.PIPE, text=True
    )
    assert work.stdout is not None
    assert work.stdout.readline() == "ready\n"
    time.sleep(2)
    os.kill(work.pid, signal.SIGINT)
    out, _ = work.communicate(timeout=120)
    assert (out, work.returncode) == ("stopped\n", 7)
    # Nothing but the store of what was done until then, which is whole and holds no run.
    store = campaign / "results.sqlite"
    after = {path: path.read_bytes() for path in campaign.rglob("*") if path.is_file()}
    del after[store]
    assert after == before
    with closing(sqlite3.connect(store)) as results:
        assert results.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
        assert results.execute("SELECT COUNT(*) FROM runs").fetchall() == [(0,)]
        ((kept,),) = results.execute("SELECT COUNT(*) FROM results").fetchall()
    rows = (campaign / "impacts.csv").read_text().count("\n") - 1
    assert 0 < kept < rows


def test_the_command_is_ended_by_ctrl_c(windfall: Any, campaign: Path) -> None:
    work = subprocess.Popen(
        [windfall.path, "fit", str(campaign), "--watch"], stderr=subprocess.PIPE, text=True
    )
    assert work.stderr is not None
    assert "watching" in work.stderr.readline()
    os.kill(work.pid, signal.SIGINT)
    work.communicate(timeout=60)
    assert work.returncode == -signal.SIGINT


def test_the_command_answers_like_windfall(windfall: Any) -> None:
    assert windfall.out("--version").startswith("windfall ")
    assert windfall("no-such").returncode == 2
    assert "Usage" in windfall.out("regress", "--help")


def test_progress_is_told_to_tqdm(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], campaign: Path
) -> None:
    told: list[tuple[float, float | None]] = []

    class Told(tqdm.auto.tqdm):  # type: ignore[type-arg]
        def update(self, n: float | None = 1) -> bool | None:
            shown = super().update(n)
            told.append((self.n, self.total))
            return shown

    monkeypatch.setattr(tqdm.auto, "tqdm", Told)
    wf.Campaign(campaign).fit(progress=True, intervals="bootstrap", replicates=100)
    assert told[-1] == (80, 80)
    assert told == sorted(told)
    assert "80/80" in capsys.readouterr().err
    told.clear()
    wf.Campaign(campaign).fit()
    assert told == []
