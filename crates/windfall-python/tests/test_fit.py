"""Fits of arrays, beside the command on the same recording."""

from __future__ import annotations

import dataclasses
import importlib
import json
import warnings
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import pint
import pytest
import windfall as wf

LAW = "kuwabara-kono"
RIG = [
    "--rig=pendulum",
    "--inertia=0.01435 kg m^2",
    "--arm=0.505 m",
    "--mass=0.11 kg",
    "--centre-of-mass=0.3 m",
]


def fit_of_command(windfall: Any, folder: Path, arrays: dict[str, Any], *words: str) -> Any:
    """What the command prints on the arrays as a table of text, every digit of them."""
    rows = zip(*(arrays[name].tolist() for name in ("t", "x", "force")))
    lines = ["t,x,force", *(",".join(map(repr, row)) for row in rows)]
    file = folder / "recording.csv"
    file.write_text("\n".join(lines) + "\n")
    channels = ["--time=t", "--channel=position=x", "--channel=force=force"]
    return json.loads(windfall.out("fit", str(file), *RIG, *channels, "--format=json", *words))


def same(fit: wf.Fit, printed: Any) -> None:
    impact = next(own for own in printed["impacts"] if own["law"] == fit.law)
    own = fit.result.to_dict()
    assert own.pop("file") == "recording.npy"
    assert impact.pop("file") == "recording.csv"
    assert own == impact


def test_repeats_the_bits_of_the_command(
    windfall: Any, tmp_path: Path, rig: wf.Pendulum, arrays: dict[str, Any]
) -> None:
    fit = wf.fit(**arrays, rig=rig, law=LAW)
    same(fit, fit_of_command(windfall, tmp_path, arrays, f"--law={LAW}"))
    k = fit.params["k"]
    assert k.low < 753_599 < k.high
    assert k.unit == "N/m^1.5"
    assert fit.law == LAW
    assert fit.derived.peak_force > 1


def test_repeats_the_draws_of_the_command(
    windfall: Any, tmp_path: Path, rig: wf.Pendulum, arrays: dict[str, Any]
) -> None:
    fit = wf.fit(**arrays, rig=rig, law=LAW, intervals="bootstrap", replicates=100, seed=3)
    words = [f"--law={LAW}", "--intervals=bootstrap", "--replicates=100", "--seed=3"]
    same(fit, fit_of_command(windfall, tmp_path, arrays, *words))


def test_repeats_residuals_and_covariance(
    windfall: Any, tmp_path: Path, rig: wf.Pendulum, arrays: dict[str, Any]
) -> None:
    fit = wf.fit(**arrays, rig=rig, law=LAW)
    fit_of_command(windfall, tmp_path, arrays, f"--law={LAW}", f"--detail={tmp_path}")
    detail = json.loads((tmp_path / f"recording-{LAW}.json").read_text())
    assert np.array_equal(fit.cov, detail["constant_data"]["covariance"])
    assert fit.estimates == tuple(detail["coords"]["parameter"])
    k = fit.estimates.index("k")
    assert fit.cov[k, k] == pytest.approx(fit.params["k"].sd ** 2, rel=1e-9)
    assert set(fit.residuals) == {"displacement", "force"}
    for name, residuals in fit.residuals.items():
        assert np.array_equal(residuals, detail["constant_data"][f"{name}_residual"])


def test_repeats_single_fits_in_many_on_any_number_of_threads(
    rig: wf.Pendulum, recordings: list[dict[str, Any]]
) -> None:
    names = ["a", "b", "c", "d"]
    single = [
        wf.fit(**own, rig=rig, law=law, name=name)
        for name, own in zip(names, recordings)
        for law in (LAW, "hertz")
    ]
    for threads in (1, 2, None):
        many = wf.fit_many(recordings, rig=rig, law=[LAW, "hertz"], names=names, threads=threads)
        assert [own.result for own in many] == [own.result for own in single]
        assert many.failed == ()
    assert [own.id for own in single[::2]] == names
    # So many that none may wait inside of another.
    many = wf.fit_many(recordings * 100, rig=rig, law="hertz", names=names * 100, threads=2)
    assert [own.result for own in many] == [own.result for own in single[1::2]] * 100


def test_a_recording_that_fails_does_not_stop_the_others(
    rig: wf.Pendulum, recordings: list[dict[str, Any]]
) -> None:
    still = {name: np.zeros(500) for name in ("x", "force")} | {"t": np.arange(500) / 1e5}
    many = wf.fit_many([recordings[0], still], rig=rig, law=LAW)
    assert [own.id for own in many] == ["1"]
    assert [own.id for own in many.failed] == ["2"]
    with pytest.raises(wf.WindfallError, match="contact"):
        wf.fit(**still, rig=rig, law=LAW)
    assert list(wf.fit_many([], rig=rig, law=LAW)) == []
    with pytest.raises(ValueError, match="no-such"):
        wf.fit_many(recordings, rig=rig, law="no-such")
    with pytest.raises(ValueError, match="expected the same arrays"):
        wf.fit_many([recordings[0], {**recordings[0], "x": None}], rig=rig, law=LAW)
    with pytest.raises(ValueError, match="found 'y'"):
        wf.fit_many([{**recordings[0], "y": recordings[0]["x"]}], rig=rig, law=LAW)
    with pytest.raises(TypeError, match="rig: expected"):
        wf.fit_many(recordings, rig="pendulum", law=LAW)  # type: ignore[arg-type]


def test_takes_arrays_of_any_layout_and_real_type(
    rig: wf.Pendulum, arrays: dict[str, Any]
) -> None:
    expected = wf.fit(**arrays, rig=rig, law=LAW).result
    wide = np.zeros((len(arrays["t"]), 3, 2))
    for place, name in enumerate(("t", "x", "force")):
        wide[:, place, 1] = arrays[name]
    strided = {name: wide[:, place, 1] for place, name in enumerate(("t", "x", "force"))}
    turned = {name: own[::-1].copy()[::-1] for name, own in arrays.items()}
    fixed = {name: own.copy() for name, own in arrays.items()}
    for own in fixed.values():
        own.setflags(write=False)
    swapped = {name: own.astype(">f8") for name, own in arrays.items()}
    lists = {name: own.tolist() for name, own in arrays.items()}
    for form in (strided, turned, fixed, swapped, lists):
        assert wf.fit(**form, rig=rig, law=LAW).result == expected
    assert all(not own.flags.writeable for own in fixed.values())
    single = {name: own.astype(np.float32) for name, own in arrays.items()}
    double = {name: own.astype(np.float64) for name, own in single.items()}
    once = {"t": arrays["t"], **{name: single[name] for name in ("x", "force")}}
    again = {"t": arrays["t"], **{name: double[name] for name in ("x", "force")}}
    assert wf.fit(**once, rig=rig, law=LAW).result == wf.fit(**again, rig=rig, law=LAW).result
    whole = {**arrays, "force": np.rint(arrays["force"]).astype(np.int32)}
    same_whole = {**arrays, "force": np.rint(arrays["force"])}
    first = wf.fit(**whole, rig=rig, law=LAW).result
    assert first == wf.fit(**same_whole, rig=rig, law=LAW).result


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda own: {"force": own["force"][:-1]}, "force has .* samples, and t has"),
        (lambda own: {"x": np.where(own["t"] > 1e-3, np.nan, own["x"])}, "x: sample .* is nan"),
        (lambda own: {"force": np.where(own["t"] > 1e-3, np.inf, 0.0)}, "force: .* is inf"),
        (lambda own: {"t": np.where(own["t"] > 1e-3, -np.inf, 0.0)}, "t: .* is -inf"),
        (lambda own: {"x": np.vstack([own["x"], own["x"]])}, "x: expected one dimension"),
        (lambda own: {"x": 1.0}, "x: expected one dimension"),
        (lambda own: {"x": own["x"].astype(str)}, "x: expected real numbers"),
        (lambda own: {"x": own["x"].astype(complex)}, "x: expected real numbers"),
        (lambda own: {"x": own["x"].astype(object)}, "x: expected real numbers"),
        (lambda own: {"x": own["x"] > 0}, "x: expected real numbers"),
        (lambda own: {name: own[name][:0] for name in own}, "t: expected samples, found none"),
        (lambda own: {"law": "no-such-law"}, "no-such-law"),
        (lambda own: {"intervals": "no-such"}, "no-such"),
        (lambda own: {"no_such_option": 1}, "--no-such-option"),
        (lambda own: {"rig": wf.Carriage(mass="1 m")}, "1 m"),
        (lambda own: {"x": None, "force": None}, "name at least one channel"),
        (lambda own: {"rig": wf.Carriage(mass="0.2 kg", driving_acceleration="1 N")}, "1 N"),
    ],
)
def test_rejects_what_cannot_be_fitted(
    rig: wf.Pendulum, arrays: dict[str, Any], change: Any, told: str
) -> None:
    words = {"rig": rig, "law": LAW, **arrays}
    with pytest.raises(ValueError, match=told):
        wf.fit(**{**words, **change(arrays)})


def test_a_request_that_is_remembered_is_no_other(
    rig: wf.Pendulum, arrays: dict[str, Any]
) -> None:
    first = wf.fit(**arrays, rig=rig, law=LAW, seed=1)
    assert wf.fit(**arrays, rig=rig, law=LAW, seed=1).result == first.result
    # Equal in Python, and an option without a value.
    with pytest.raises(ValueError, match="--seed"):
        wf.fit(**arrays, rig=rig, law=LAW, seed=True)
    heavy = dataclasses.replace(rig, inertia="0.0287 kg m^2")
    k = wf.fit(**arrays, rig=heavy, law=LAW, seed=1).params["k"].value
    assert k == pytest.approx(2 * first.params["k"].value, rel=0.5)
    assert k != first.params["k"].value
    for number in range(20):
        assert wf.fit(**arrays, rig=rig, law=LAW, seed=number).id == "recording"
    with pytest.raises(ValueError, match="expected samples, found none"):
        wf.fit(**{name: own[:0] for name, own in arrays.items()}, rig=rig, law=LAW, seed=1)


def test_takes_quantities_in_their_units(rig: wf.Pendulum, arrays: dict[str, Any]) -> None:
    expected = wf.fit(**arrays, rig=rig, law=LAW)
    unit = pint.UnitRegistry()
    # Powers of two, which change no digit.
    unit.define("halfmetre = 0.5 * metre")
    twice = {**arrays, "x": arrays["x"] * 2 * unit.halfmetre, "t": arrays["t"] * unit.second}
    assert wf.fit(**twice, rig=rig, law=LAW).result == expected.result
    with pytest.raises(ValueError, match="x: expected a quantity of .*length.*, found second"):
        wf.fit(**{**arrays, "x": arrays["x"] * unit.second}, rig=rig, law=LAW)
    for numbers in (
        wf.Pendulum(inertia=0.01435, arm=0.505, mass=0.11, centre_of_mass=0.3),
        wf.Pendulum(
            inertia=0.01435 * unit("kg m^2"),
            arm=0.505 * unit.metre,
            mass=0.11 * unit.kilogram,
            centre_of_mass=0.3 * unit.metre,
        ),
    ):
        assert wf.fit(**arrays, rig=numbers, law=LAW).result == expected.result
    with pytest.raises(ValueError, match="arm: expected a quantity of"):
        wrong = dataclasses.replace(rig, arm=0.505 * unit.kilogram)
        wf.fit(**arrays, rig=wrong, law=LAW)


def test_draws_go_to_arviz(rig: wf.Pendulum, arrays: dict[str, Any]) -> None:
    fit = wf.fit(**arrays, rig=rig, law=LAW, intervals="posterior")
    with warnings.catch_warnings():
        # It will be another package.
        warnings.simplefilter("ignore", FutureWarning)
        arviz = importlib.import_module("arviz")
    data = fit.to_arviz()
    k = data.posterior["k"]
    assert float(k.mean()) == pytest.approx(fit.params["k"].value, rel=0.01)
    assert float(k.std()) == pytest.approx(fit.params["k"].sd, rel=0.3)
    assert arviz.rhat(data)["k"] < 1.05
    assert np.array_equal(data.observed_data["force"], fit.detail["observed_data"]["force"])


def test_draws_every_quantity(rig: wf.Pendulum, arrays: dict[str, Any]) -> None:
    matplotlib.use("agg")
    fit = wf.fit(**arrays, rig=rig, law=LAW)
    panels = np.ravel(fit.plot())
    assert [own.get_ylabel() for own in panels] == ["displacement / SI", "force / SI"]
    measured, predicted = panels[1].get_lines()
    assert np.array_equal(measured.get_ydata(), fit.detail["observed_data"]["force"])
    difference = predicted.get_ydata() - measured.get_ydata()
    assert np.allclose(difference, fit.residuals["force"], atol=1e-12)


def test_writes_nothing(
    rig: wf.Pendulum, arrays: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    wf.fit(**arrays, rig=rig, law=LAW)
    for option in ("detail", "card", "figures"):
        with pytest.raises(ValueError, match="write nothing|cannot be used with"):
            wf.fit(**arrays, rig=rig, law=LAW, **{option: tmp_path / option})
    assert list(tmp_path.iterdir()) == []


def test_shows_itself_in_notebooks(rig: wf.Pendulum, arrays: dict[str, Any]) -> None:
    fit = wf.fit(**arrays, rig=rig, law=LAW)
    html = fit._repr_html_()
    assert "<td>k</td>" in html and "N/m^1.5" in html
    assert repr(fit).startswith(f"Fit({LAW}: k=")
