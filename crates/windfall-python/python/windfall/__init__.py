"""Contact-force laws of fruit from impact recordings, with calibrated uncertainty.

Every command of windfall is a function here: `regress`, `surface`, `card_show`, `scene_run`, …
They take files, or data frames where the command takes a table, and return what the command
prints as JSON. `fit` fits arrays, `read` reads recordings, `Campaign` and `Scene` are what the
commands work on. Numbers are SI; texts carry their unit.

A wrong request is a `ValueError`; work that failed is a `WindfallError`.
"""

from windfall import _commands, design, plan
from windfall._campaign import Campaign, Card, Population, Run, Scene
from windfall._commands import *  # noqa: F403
from windfall._errors import WindfallError
from windfall._fit import Carriage, Fit, Fits, Pendulum, fit, fit_many
from windfall._recording import Channel, Recording, read
from windfall._result import Result
from windfall._table import Table

__all__ = [
    "Campaign",
    "Card",
    "Carriage",
    "Channel",
    "Fit",
    "Fits",
    "Pendulum",
    "Population",
    "Recording",
    "Result",
    "Run",
    "Scene",
    "Table",
    "WindfallError",
    "design",
    "fit",
    "fit_many",
    "plan",
    "read",
    *_commands.__all__,
]
