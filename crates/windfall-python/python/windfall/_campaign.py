"""Campaigns, law cards and scenes as objects; what they do are the commands."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Literal

from windfall import _commands
from windfall._call import Path, Value
from windfall._result import Result
from windfall._table import Table

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from tempfile import TemporaryDirectory



class Campaign:
    """A campaign directory. Keyword arguments of its methods are those of the commands."""

    def __init__(self, directory: Path) -> None:
        self.directory = os.fsdecode(directory)

    def add(self, *files: Path, **options: Any) -> Result:
        """Lists further recordings: `add`."""
        return _commands.add(self.directory, list(files), **options)

    def fit(self, law: Value | list[Value] | None = None, **options: Any) -> Result:
        """Fits force laws to its impacts: `fit_campaign`."""
        return _commands.fit_campaign(self.directory, law=law, **options)

    def table(self, law: Value | list[Value] | None = None, **options: Any) -> Table:
        """The table of its fits, a row for each impact and law: `fit_campaign` with `out`."""
        return _table(
            lambda out: _commands.fit_campaign(self.directory, law=law, out=out, **options)
        )

    def laws(self, law: list[Value] | None = None, **options: Any) -> Result:
        """Compares force laws: `laws`."""
        return _commands.laws(self.directory, law=law, **options)

    def population(self, **options: Any) -> Population:
        """Estimates how the law varies between fruit: `population`."""
        found = _commands.population(self.directory, **options)
        return Population(self.directory, options, found)

    def calibrate(self, **options: Any) -> Result:
        """Calibrates the law of dropped fruit: `calibrate`."""
        return _commands.calibrate(self.directory, **options)

    def report(self, **options: Any) -> Result:
        """Writes figures, tables and a page: `report`."""
        return _commands.report(self.directory, **options)

    def __repr__(self) -> str:
        return f"Campaign({self.directory!r})"


class Population(Result):
    """A population of fruit, as `population` found it."""

    __slots__ = ("_directory", "_options")

    def __init__(self, directory: str, options: dict[str, Any], found: Result) -> None:
        super().__init__(found.to_dict(), found.messages)
        object.__setattr__(self, "_directory", directory)
        object.__setattr__(self, "_options", options)

    def __reduce__(self) -> Any:
        found = Result(self.to_dict(), self.messages)
        return Population, (self._directory, self._options, found)

    def card(self, path: Path | None = None, **options: Any) -> Card:
        """Its law card, written to `path`, or for as long as the card is used."""
        folder = None
        if path is None:
            from tempfile import TemporaryDirectory

            folder = TemporaryDirectory(prefix="windfall-")
            path = os.path.join(folder.name, "law.toml")
        _commands.population(self._directory, card=path, **{**self._options, **options})
        return Card(path, folder)


class Card:
    """A law card in a file."""

    def __init__(self, path: Path, folder: TemporaryDirectory[str] | None = None) -> None:
        self.path = os.fsdecode(path)
        # A card that was not asked for as a file goes with its object.
        self._folder = folder

    def show(self) -> Result:
        """What it says: `card_show`."""
        return _commands.card_show(file=self.path)

    def simulate(self, *, mass: Value, velocity: Value | None = None, **options: Any) -> Result:
        """One impact under its law: `simulate_impact`."""
        return _commands.simulate_impact(law=self.path, mass=mass, velocity=velocity, **options)

    def __repr__(self) -> str:
        return f"Card({self.path!r})"


class Run(Result):
    """A scene that has run."""

    __slots__ = ()

    def __init__(self, found: Result) -> None:
        super().__init__(found.to_dict(), found.messages)

    def __reduce__(self) -> Any:
        return Run, (Result(self.to_dict(), self.messages),)

    @property
    def directory(self) -> str:
        """Where its files lie."""
        return os.path.dirname(str(self["files"][0]))

    @property
    def events(self) -> Table:
        """All contacts: `table("events")`."""
        return self.table("events")

    def table(self, table: Literal["events", "fruit", "frames"]) -> Table:
        """Its contacts, its fruit, or where they are in recorded frames: `scene_table`."""
        return _table(lambda out: _commands.scene_table(self.directory, table, out=out))

    @property
    def bruised(self) -> Any:
        """Shares of bruised fruit, if the scene says what bruises."""
        return self["bruise"]


def _table(write: Callable[[str], object]) -> Table:
    """A table in a file that lasts as long as it."""
    from tempfile import TemporaryDirectory

    folder = TemporaryDirectory(prefix="windfall-")
    path = os.path.join(folder.name, "table.arrow")
    write(path)
    return Table(folder, path)


class Scene:
    """A scene file: many fruit in a machine."""

    def __init__(self, file: Path, set: Sequence[str] = ()) -> None:
        self.file = os.fsdecode(file)
        self._set = tuple(set)

    def set(self, key: str, value: Any) -> Scene:
        """The scene with another value: `set("walls.edge.material", "foam")`. Its file stays."""
        import json

        # Texts, numbers and lists are written alike in TOML.
        return Scene(self.file, [*self._set, f"{key}={json.dumps(value, ensure_ascii=False)}"])

    def run(self, **options: Any) -> Run:
        """Runs it: `scene_run`."""
        return Run(_commands.scene_run(self.file, set=self._set, **options))

    def export(self, engine: Any, **options: Any) -> Result:
        """Writes it for another engine: `scene_export`."""
        return _commands.scene_export(self.file, engine=engine, **options)

    def __repr__(self) -> str:
        return f"Scene({self.file!r})"
