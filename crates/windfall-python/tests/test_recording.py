"""Recordings of any format as arrays."""

from __future__ import annotations

import wave
from pathlib import Path

import numpy as np
import pandas
import pytest
import windfall as wf
import xarray


def test_channels_are_those_of_the_file(tmp_path: Path) -> None:
    file = tmp_path / "impact.csv"
    file.write_text("time (ms),Force (N),x\n0,0.1,5\n0.5,1e-3,\n1,NaN,7\n")
    recording = wf.read(file)
    assert recording.format == "text"
    force = recording[recording.keys()[1]]
    assert force.unit == "N"
    assert np.array_equal(force.values, [0.1, 1e-3, np.nan], equal_nan=True)
    assert force.values.dtype == np.float64
    assert np.allclose(recording.time, [0.0, 0.5e-3, 1e-3], rtol=1e-15)
    assert not force.values.flags.writeable
    frame = recording.to_pandas()
    assert isinstance(frame, pandas.DataFrame)
    assert list(frame.columns) == list(recording.keys())
    assert len(frame) == 3
    data = recording.to_xarray()
    assert isinstance(data, xarray.Dataset)
    assert data["Force (N)"].attrs["units"] == "N"
    assert np.array_equal(data["Force (N)"], force.values, equal_nan=True)
    assert np.array_equal(data["Force (N)"].coords["time of Force (N)"], recording.time)
    assert "Force" in recording._repr_html_()
    with pytest.raises(KeyError, match="no channel 'no'"):
        recording["no"]


def test_samples_have_the_bits_of_arrays_of_numpy(tmp_path: Path) -> None:
    samples = np.random.default_rng(1).normal(size=(1000, 2)) * [1e-300, 1e300]
    np.save(tmp_path / "array.npy", samples)
    recording = wf.read(tmp_path / "array.npy")
    columns = np.stack([own.values for own in recording], axis=1)
    assert columns.tobytes() == samples.tobytes()
    with pytest.raises(ValueError, match="does not say when"):
        recording.time


def test_rates_of_files_are_times(tmp_path: Path) -> None:
    with wave.open(str(tmp_path / "tap.wav"), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(48_000)
        file.writeframes(np.arange(100, dtype="<i2").tobytes())
    recording = wf.read(tmp_path / "tap.wav")
    assert np.array_equal(recording.time, np.arange(100) * (1 / 48_000))


def test_options_say_how_a_text_is_read(tmp_path: Path) -> None:
    file = tmp_path / "impact.txt"
    file.write_text("t;F\n0;1,5\n1;2,5\n")
    recording = wf.read(file, separator="semicolon", decimal="comma")
    assert np.array_equal(recording["F"].values, [1.5, 2.5])
    with pytest.raises(ValueError, match="no-such"):
        wf.read(file, separator="no-such")  # type: ignore[arg-type]


def test_rejects_files_that_are_no_recordings(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="absent.csv"):
        wf.read(tmp_path / "absent.csv")
    empty = tmp_path / "empty.csv"
    empty.touch()
    with pytest.raises(ValueError, match="empty"):
        wf.read(empty)
