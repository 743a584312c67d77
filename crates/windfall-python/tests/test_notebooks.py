"""The notebooks of the examples run, cell by cell, in an empty folder; what they assert holds."""

from __future__ import annotations

import ast
import json
from pathlib import Path
from typing import Any

import matplotlib
import pytest

FOLDER = Path(__file__).resolve().parents[3] / "examples" / "notebooks"
NAMES = ["pendulum_study", "drop_study", "scene"]


def cells(name: str) -> list[dict[str, Any]]:
    book = json.loads((FOLDER / f"{name}.ipynb").read_text(encoding="utf-8"))
    assert book["nbformat"] == 4
    return list(book["cells"])


def run(code: str, place: str, names: dict[str, Any]) -> Any:
    """What the last line of a cell displays."""
    tree = ast.parse(code)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, place, "exec"), names)
    if last is None:
        return None
    shown = ast.Expression(last.value)  # type: ignore[attr-defined]
    return eval(compile(shown, place, "eval"), names)


def test_every_notebook_is_tried() -> None:
    assert sorted(NAMES) == sorted(path.stem for path in FOLDER.glob("*.ipynb"))


@pytest.mark.parametrize("name", NAMES)
def test_notebooks_are_kept_without_output(name: str) -> None:
    for cell in cells(name):
        if cell["cell_type"] == "code":
            assert cell["outputs"] == [] and cell["execution_count"] is None


@pytest.mark.parametrize("name", NAMES)
def test_what_notebooks_assert_holds(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Notebooks change into a folder of their own; this brings the tests back.
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    matplotlib.use("Agg")
    names: dict[str, Any] = {}
    asserted = 0
    for place, cell in enumerate(cells(name)):
        if cell["cell_type"] == "code":
            code = "".join(cell["source"])
            asserted += code.count("assert ")
            shown = run(code, f"{name}, cell {place}", names)
            # As a notebook shows it.
            if hasattr(shown, "_repr_html_"):
                shown._repr_html_()
    assert asserted > 0
