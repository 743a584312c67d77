"""What the tests work on: a campaign of windfall's own example, and one of its recordings."""

from __future__ import annotations

import subprocess
import sysconfig
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import windfall as wf


class Command:
    """The command that the package brings along."""

    path = str(Path(sysconfig.get_path("scripts")) / "windfall")

    def __call__(self, *words: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
        return subprocess.run([self.path, *words], capture_output=True, text=True, cwd=cwd)

    def out(self, *words: str) -> str:
        """Standard output of a command that succeeds."""
        done = self(*words)
        assert done.returncode == 0, done.stderr
        return done.stdout


@pytest.fixture(scope="session")
def windfall() -> Command:
    return Command()


@pytest.fixture(scope="session")
def rig() -> wf.Pendulum:
    return wf.Pendulum(
        inertia="0.01435 kg m^2", arm="0.505 m", mass="0.11 kg", centre_of_mass="0.3 m"
    )


@pytest.fixture
def campaign(tmp_path: Path) -> Path:
    directory = tmp_path / "campaign"
    wf.simulate_pendulum(example=directory)
    return directory


@pytest.fixture(scope="session")
def recordings(tmp_path_factory: pytest.TempPathFactory) -> list[dict[str, Any]]:
    """Impacts of four simulated fruit: times, position and force, in SI."""
    directory = tmp_path_factory.mktemp("recordings") / "campaign"
    wf.simulate_pendulum(
        law="kuwabara-kono(k=753599, c=1524)",
        recordings=directory,
        specimens=4,
        encoder="counts",
        rate="100 kHz",
    )
    return [arrays_of(wf.read(path)) for path in sorted((directory / "raw").iterdir())]


def arrays_of(recording: wf.Recording) -> dict[str, Any]:
    counts, volts = recording["count"].values, recording["force_V"].values
    return {
        "t": np.arange(len(counts)) / 100_000.0,
        "x": 0.505 * np.sin(counts * (2 * np.pi / 360_000.0)),
        "force": volts / 0.011,
    }


@pytest.fixture(scope="session")
def arrays(recordings: list[dict[str, Any]]) -> dict[str, Any]:
    return recordings[0]
