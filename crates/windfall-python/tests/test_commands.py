"""Functions of commands, beside the commands themselves."""

from __future__ import annotations

import inspect
import json
import pickle
from pathlib import Path
from typing import Any

import pandas
import polars
import pytest
import windfall as wf
from windfall import _commands

TABLE = {
    "V": [0.3, 0.3, 0.4, 0.4, 0.5, 0.5, 0.6, 0.6],
    "fruit": ["a", "b", "a", "b", "a", "b", "a", "b"],
    "k": [1.1, 1.32, 1.25, 1.41, 1.38, 1.57, 1.49, 1.7],
}


@pytest.fixture
def table(tmp_path: Path) -> Path:
    path = tmp_path / "table.csv"
    pandas.DataFrame(TABLE).to_csv(path, index=False)
    return path


def test_every_function_says_what_it_does() -> None:
    assert len(_commands.__all__) > 40
    for name in _commands.__all__:
        function = getattr(wf, name)
        assert function.__doc__ and "The command `windfall " in function.__doc__
        parameters = inspect.signature(function).parameters
        assert {"force", "also_read", "progress"} <= set(parameters)
        for parameter in set(parameters) - {"force", "also_read", "progress"}:
            assert f"* `{parameter}`: " in function.__doc__, (name, parameter)


def test_results_are_what_the_command_prints(windfall: Any, table: Path) -> None:
    words = ["--formula=k ~ V + fruit", "--format=json"]
    printed = json.loads(windfall.out("regress", str(table), *words))
    result = wf.regress(table, formula="k ~ V + fruit")
    assert result.to_dict() == printed
    assert result.terms[1].estimate == printed["terms"][1]["estimate"]
    assert result["terms"][1]["term"] == "V"
    assert "V" in result._repr_html_()
    assert pickle.loads(pickle.dumps(result)) == result
    with pytest.raises(AttributeError, match="cannot be changed"):
        result.rows = 1
    with pytest.raises(AttributeError, match="no_such"):
        result.no_such
    result.to_dict()["terms"].clear()
    assert len(result.terms) == 3


@pytest.mark.parametrize("frame", [pandas.DataFrame, polars.DataFrame])
def test_data_frames_are_tables(table: Path, frame: Any) -> None:
    expected = wf.regress(table, formula="k ~ V + fruit")
    assert wf.regress(frame(TABLE), formula="k ~ V + fruit") == expected
    assert wf.regress(str(table), formula="k ~ V + fruit") == expected
    with pytest.raises(ValueError, match="^the data frame: "):
        wf.regress(frame(TABLE), formula="k ~ W")


def test_lists_repeat_their_option(windfall: Any, table: Path) -> None:
    result = wf.summary(table, value="k", by=["V", "fruit"])
    words = ["--value=k", "--by=V,fruit", "--format=json"]
    assert result.to_dict() == json.loads(windfall.out("summary", str(table), *words))


def test_optional_values_stand_alone(windfall: Any) -> None:
    laws = wf.card_show(laws=True)
    assert laws.to_dict() == json.loads(windfall.out("card", "show", "--laws", "--format=json"))
    entry = wf.card_show(library="jonagold-2003")
    printed = windfall.out("card", "show", "--library=jonagold-2003", "--format=json")
    assert entry.to_dict() == json.loads(printed)


def test_commands_without_json_answer_in_words(windfall: Any, tmp_path: Path) -> None:
    result = wf.simulate_tap(tmp_path / "taps")
    assert "files in" in result.text


def test_wrong_requests_are_value_errors_in_the_words_of_the_command(
    windfall: Any, table: Path
) -> None:
    for words, call in [
        (["--formula=k ~ W"], lambda: wf.regress(table, formula="k ~ W")),
        (["--df=no"], lambda: wf.regress(table, formula="k ~ V", df="no")),
        ([], lambda: wf.regress(table)),
    ]:
        done = windfall("regress", str(table), *words)
        assert done.returncode == 2
        with pytest.raises(ValueError) as caught:
            call()
        said = done.stderr.split("\n\nUsage")[0].removeprefix("error: ").strip()
        assert str(caught.value).startswith(said)
    with pytest.raises(TypeError, match="expected text, a number, a path or a table"):
        wf.regress(table, formula=object())


def test_work_that_fails_raises_with_what_was_found(windfall: Any, campaign: Path) -> None:
    # None can be fitted: each says why.
    for recording in campaign.glob("raw/*.csv"):
        recording.write_text("phase_a_V,phase_b_V,force_V\n0,0,0\n0,0,0\n")
    done = windfall("fit", str(campaign), "--format=json")
    assert done.returncode == 1
    with pytest.raises(wf.WindfallError) as caught:
        wf.Campaign(campaign).fit()
    *told, error = done.stderr.splitlines()
    assert str(caught.value).splitlines() == [error.removeprefix("error: "), *told]
    assert len(caught.value.messages) == 80
    found = caught.value.result.to_dict() if caught.value.result else None
    assert found == (json.loads(done.stdout) if done.stdout else None)
    assert [own.split(": ")[0] for own in told] == ["not fitted"] * 80


def test_campaigns_and_cards_are_the_commands(windfall: Any, campaign: Path) -> None:
    own = wf.Campaign(campaign)
    fitted = own.fit()
    assert len(fitted.impacts) == 80
    assert fitted.to_dict()["impacts"] == json.loads(
        windfall.out("fit", str(campaign), "--format=json")
    )["impacts"]
    own.fit(out=campaign / "fits.parquet")
    assert polars.read_parquet(campaign / "fits.parquet").height == 80
    population = own.population(covariate="log(impact_velocity)")
    card = pickle.loads(pickle.dumps(population)).card()
    impact = card.simulate(mass="0.2 kg", velocity="0.5 m/s")
    printed = windfall.out(
        "simulate", "impact", f"--law={card.path}", "--mass=0.2 kg", "--velocity=0.5 m/s",
        "--format=json",
    )
    assert impact.to_dict() == json.loads(printed)
    with pytest.raises(ValueError, match="no-such"):
        own.fit(law="no-such")


def test_scenes_are_the_commands(windfall: Any, tmp_path: Path) -> None:
    wf.new("scene", tmp_path / "scene")
    file = tmp_path / "scene" / "scene.toml"
    result = wf.Scene(file).run(out=tmp_path / "one")
    printed = windfall.out("scene", "run", str(file), f"--out={tmp_path / 'two'}", "--format=json")
    assert result.keys() == tuple(json.loads(printed))
    for name in ("events.csv", "fruit.csv"):
        one, two = tmp_path / "one" / name, tmp_path / "two" / name
        assert one.read_bytes() == two.read_bytes()
