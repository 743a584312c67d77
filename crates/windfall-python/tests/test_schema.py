"""The schemas of the TOML files, in a validator of another hand."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

import jsonschema
import pytest
import windfall as wf

KINDS = {
    "pendulum": "campaign.toml",
    "carriage": "campaign.toml",
    "compression": "campaign.toml",
    "relaxation": "campaign.toml",
    "acoustic": "campaign.toml",
    "repeats": "campaign.toml",
    "drop": "campaign.toml",
    "scene": "scene.toml",
    "scene-study": "study.toml",
}


def validator(kind: str) -> jsonschema.Draft7Validator:
    schema = wf.schema(kind).to_dict()
    jsonschema.Draft7Validator.check_schema(schema)
    return jsonschema.Draft7Validator(schema)


def template(kind: str, folder: Path) -> tuple[Path, dict[str, Any]]:
    wf.new(kind, folder)
    path = folder / KINDS[kind]
    return path, tomllib.loads(path.read_text())


@pytest.mark.parametrize("kind", KINDS)
def test_a_template_is_valid_and_an_unknown_key_is_not(kind: str, tmp_path: Path) -> None:
    _, file = template(kind, tmp_path / "new")
    own = validator(kind)
    own.validate(file)
    tables = [(file, ())]
    for name, value in file.items():
        parts = value if isinstance(value, list) else [value]
        tables += [(part, (name,)) for part in parts if isinstance(part, dict)]
    # Channels and laws have names of the user's own; `set` has keys of a scene.
    for table, place in tables:
        table["no_such_key"] = 1
        assert list(own.iter_errors(file)), place
        del table["no_such_key"]
    own.validate(file)


def words(schema: dict[str, Any]) -> list[tuple[str, str, list[str]]]:
    """Tables, keys and the words that they take."""
    found = []
    for section, own in schema["properties"].items():
        for part in own.get("anyOf", own.get("allOf", [own])):
            name = part.get("$ref", "").rpartition("/")[2]
            for key, value in schema["definitions"].get(name, {}).get("properties", {}).items():
                listed = value.get("items", value).get("enum")
                if listed:
                    found.append((section, key, listed))
    return found


@pytest.mark.parametrize("kind", ["pendulum", "acoustic", "repeats", "drop", "scene"])
def test_words_are_those_that_the_command_takes(kind: str, tmp_path: Path) -> None:
    path, _ = template(kind, tmp_path / "new")
    text = path.read_text()
    tried = 0
    for section, key, listed in words(wf.schema(kind).to_dict()):
        if key == "kind":
            continue
        lines = [line for line in text.splitlines() if not re.match(rf"#?\s*{key}\s*=", line)]
        header = f"[{section}]"
        value = '["nonsense"]' if key == "ways" else '"nonsense"'
        if header in lines:
            lines.insert(lines.index(header) + 1, f"{key} = {value}")
        else:
            lines += [header, f"{key} = {value}"]
            # Without these nothing else of the table is read.
            if section == "bruise" and key != "predictor":
                lines += ['predictor = "absorbed energy"', 'limits = ["100 mm^3"]']
                lines += ['threshold = "0.01 J"', 'susceptibility = "2 cm^3/J"']
        path.write_text("\n".join(lines) + "\n")
        with pytest.raises(ValueError) as told:
            wf.scene_run(path) if kind == "scene" else wf.fit_campaign(path.parent)
        message = str(told.value)
        said = re.findall(r'"([^"]*)"', message.split("expected", 1)[1])
        assert said == listed, f"{section}.{key}: {message}"
        tried += 1
    assert tried >= 1


def test_examples_are_valid() -> None:
    examples = Path(__file__).parents[3] / "examples"
    files = [*examples.glob("**/campaign.toml"), *examples.glob("**/scene.toml")]
    assert files
    for path in files:
        file = tomllib.loads(path.read_text())
        kind = file["rig"]["kind"] if path.name == "campaign.toml" else "scene"
        errors = [error.message for error in validator(kind).iter_errors(file)]
        assert errors == [], path
