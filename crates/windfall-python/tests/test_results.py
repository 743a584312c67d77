"""The schemas of results, in a validator of another hand: what commands answer as JSON is valid,
has no key that its schema does not know, and lacks none but those that are left out when empty."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import jsonschema
import pytest
import windfall as wf
from conftest import Command

FILES = {
    "pendulum",
    "carriage",
    "compression",
    "relaxation",
    "acoustic",
    "repeats",
    "drop",
    "scene",
    "scene-study",
}
"""Kinds of files, which have schemas of their own (test_schema.py)."""

CARD_LAW = "kuwabara-kono(k=753599,c=1524)"
DROP_LAW = "adams-impact(k=466143.6,e=1.91,c=0.556,d=1e-6)"

CAMPAIGNS = [
    f"simulate carriage --law {CARD_LAW} --mass 0.2kg --velocity 0.5m/s"
    " --specimens 3 --repeats 2 --recordings campaign",
    f"simulate drop drops --law {DROP_LAW} --mass 4.8g --height 100mm --height 500mm --drops 1",
    f"simulate carriage --law {CARD_LAW} --mass 0.2kg --velocity 0.5m/s"
    " --specimens 1 --recordings given",
    "simulate tap taps --fruit 2",
    "simulate repeats repeated --fruit 3",
    "simulate compression pressed --law kuwabara-kono(k=300000,c=20000)",
    "new scene scene",
    "new relaxation held",
]
"""What the other lines work on."""


class Line(NamedTuple):
    """A command line whose JSON has the schema."""

    name: str
    words: str


def lines() -> Iterator[Line]:
    text = """
    simulate-recordings simulate pendulum --example example
    written new pendulum fresh
    new-from new carriage taken --from given/raw
    add add campaign
    fit fit campaign --card card.toml
    """
    yield from (Line(*line.split(" ", 1)) for line in map(str.strip, text.splitlines()) if line)
