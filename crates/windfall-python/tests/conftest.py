"""What the tests work on: the command, and a campaign of windfall's own example."""

from __future__ import annotations

import subprocess
import sysconfig
from pathlib import Path

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


@pytest.fixture
def campaign(tmp_path: Path) -> Path:
    directory = tmp_path / "campaign"
    wf.simulate_pendulum(example=directory)
    return directory
