"""Tables of results, in libraries that read them through Arrow's interface."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas
import polars
import pyarrow
import pytest
import windfall as wf
from windfall import _commands

LAW = "kuwabara-kono(k=753599, c=1524)"


@pytest.fixture(scope="module")
def campaign(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("campaign") / "study"
    wf.simulate_pendulum(law=LAW, recordings=folder, specimens=3)
    return folder


def test_a_table_of_fits_is_what_the_command_writes(campaign: Path, tmp_path: Path) -> None:
    table = wf.Campaign(campaign).table()
    out = tmp_path / "fits.parquet"
    wf.fit_campaign(campaign, out=out)
    written = polars.read_parquet(out)
    for frame in (polars.DataFrame(table), table.to_polars()):
        assert frame.equals(written)
    arrow = pyarrow.table(table)
    assert arrow.schema.field("k").metadata
    assert arrow.equals(table.to_arrow())
    frame = table.to_pandas()
    assert isinstance(frame, pandas.DataFrame)
    assert frame["k"].tolist() == written["k"].to_list()


def test_a_stream_that_nobody_reads_is_closed(campaign: Path) -> None:
    table = wf.Campaign(campaign).table()
    for _ in range(100):
        table.__arrow_c_stream__()
    with pytest.raises(OSError, match="nowhere"):
        wf._native.arrow_stream("nowhere.arrow")  # type: ignore[attr-defined]


def test_a_scene_that_ran_has_its_contacts(tmp_path: Path) -> None:
    wf.new("scene", tmp_path / "scene")
    file = tmp_path / "scene" / "scene.toml"
    text = file.read_text().replace("count = 100", "count = 5")
    file.write_text(text.replace('end = "4 s"', 'end = "1 s"'))
    run = wf.Scene(file).run()
    assert run.to_dict()["schema"].startswith("scene-run/")
    written = polars.read_csv(Path(run.directory) / "events.csv")
    events = run.events.to_polars()
    assert len(events) == len(written) > 0
    assert len(run.table("fruit").to_arrow()) == run.fruit == 5
    assert run.bruised == run["bruise"]
    assert len(run.table("frames").to_arrow()) > 0
    before = file.read_text()
    fewer = wf.Scene(file).set("fruit.apples.count", 2).set("scene.end", "0.5 s")
    again = fewer.run(out=tmp_path / "fewer")
    assert (again.fruit, again.end) == (2, 0.5)
    assert [own.code for own in again.findings] == ["changed-scene"]
    assert file.read_text() == before
    with pytest.raises(ValueError, match="aples"):
        wf.Scene(file).set("fruit.aples.count", 2).run(out=tmp_path / "none")


def test_groups_of_commands_are_whole() -> None:
    for name in ("design", "plan"):
        group = getattr(wf, name)
        whole = [own for own in _commands.__all__ if own.startswith(f"{name}_")]
        assert [f"{name}_{own}" for own in group.__all__] == sorted(whole)
        for own in group.__all__:
            assert getattr(group, own) is getattr(wf, f"{name}_{own}")


def test_fits_are_frames(rig: wf.Pendulum, arrays: dict[str, Any]) -> None:
    fits = wf.fit_many([arrays, arrays], rig=rig, law=["hertz", "kuwabara-kono"])
    for frame in (fits.to_polars(), fits.to_pandas()):
        assert len(frame) == len(fits.rows()) == 6
        assert frame["value"].to_list() == [row["value"] for row in fits.rows()]
