"""The schemas of results, in a validator of another hand: what commands answer as JSON is valid,
and has no key that its schema does not name."""

from __future__ import annotations

import json
import re
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from conftest import Command

FILES = 9
"""Kinds of files, which have schemas of their own (test_schema.py); they are listed first."""

MADE = """
simulate carriage --law kuwabara-kono(k=753599,c=1524) --mass 0.2kg --velocity 0.5m/s \
    --specimens 4 --repeats 2 --recordings campaign
simulate carriage --law kuwabara-kono(k=753599,c=1524) --mass 0.2kg --velocity 0.5m/s \
    --specimens 1 --recordings given
simulate drop drops --law adams-impact(k=466143.6,e=1.91,c=0.556,d=1e-6) --mass 4.8g \
    --height 100mm --height 500mm --drops 1
simulate tap taps --fruit 2
simulate repeats repeated --fruit 4
simulate compression pressed --law kuwabara-kono(k=300000,c=20000) --fruit 2
new scene scene
fit campaign --card card.toml
fit drops
"""
"""What the lines below work on, besides the tables."""

TABLES = {
    "design.csv": "A,B,y\n0,0,1\n1,0,2\n0,1,3\n1,1,5\n0,0.5,2\n1,0.5,4\n0.5,0.5,2.7\n0.5,0.5,3.1\n",
    "few.csv": "A,B,y\n0,0,1\n1,0,2\n0,1,3\n1,1,5\n",
    "fruit.csv": "fruit,V,k\na,1,3\na,2,4.1\na,3,5\nb,1,4\nb,2,4.7\nb,3,6\nc,1,2\nc,2,3.3\nc,3,4.5\n",
    "holes.csv": "g,y\na,1\na,2\nb,\nc,4\n",
    "bruises.csv": "bruise_width_mm,bruise_depth_mm\n10,3\n",
    "laws.toml": 'format = 1\n[laws.own]\nforce = "k*x^1.5"\n'
    'parameters.k = { unit = "N/m^1.5", start = 4e5 }\n',
    "scene/study.toml": 'format = 1\ntitle = "two"\nscene = "scene.toml"\nreplicates = 1\n'
    '[[vary]]\nname = "seed"\n'
    'levels = [{ name = "one" }, { name = "two", set = { "scene.seed" = 2 } }]\n',
    "drop.toml": """format = 1
materials = ["apple", "steel"]
[scene]
time_step = "20 us"
end = "0.1 s"
[[contacts]]
between = ["apple", "steel"]
law = "kelvin-voigt(k=6000, c=25)"
annuli = 1
friction = 0.5
[[contacts]]
between = ["apple", "apple"]
law = "kelvin-voigt(k=3000, c=12)"
annuli = 1
friction = 0.5
[[fruit]]
material = "apple"
count = 1
diameter = "70 mm"
density = "840 kg/m^3"
drop = { place = [0, 0, 0.2] }
[[walls]]
name = "floor"
material = "steel"
plane = { point = [0, 0, 0], normal = [0, 0, 1] }
""",
}

LINES = """
written: new pendulum fresh
new-from: new carriage taken --from given/raw
add: add campaign given/raw/specimen-01.csv
inspect: inspect campaign/raw/specimen-01-01.csv
inspect-presets: inspect --presets
fit: fit campaign
fit: fit campaign --intervals profile
fit: fit campaign --intervals bootstrap --replicates 100
fit: fit campaign --intervals posterior --draws 100
fit: fit campaign --joint
fit: fit campaign --law hertz
fit: fit drops
fit: fit taps
fit: fit repeated
fit: fit pressed
fit-shard: fit campaign --shard 1/2 --out part.csv
laws: laws campaign --law kuwabara-kono --law kelvin-voigt
population: population campaign
population: population campaign --posterior --draws 100
report: report campaign
calibrate: calibrate drops
calibrate: calibrate drops --way waveform
card: card show --file card.toml
card-laws: card show --laws
card-laws: card show --laws laws.toml
card-library: card show --library golden-delicious-regression --at "V=0.1 m/s, R=50 mm, t=6 ms"
card-library: card show --library
card-transfer: card transfer --file card.toml --from 40mm,plane --to 40mm,20mm
simulate-recordings: simulate pendulum --example example
simulate-impact: simulate impact --law kuwabara-kono(k=753599,c=1524) --mass 0.2kg --velocity 1m/s
simulate-impact: simulate impact --laws laws.toml --law own(k=9e5) --mass 0.2kg --velocity 1m/s
simulate-motion: simulate pendulum --law hertz(k=9e5)
simulate-motion: simulate drop --law hertz(k=9e5) --mass 5g --height 100mm --sampling-rate 10kHz
simulate-motion: simulate drop --law hertz(k=9e5) --mass 5g --height 100mm --radius 10mm \
    --offset 3mm --sampling-rate 10kHz
simulate-drop: simulate drop --law hertz(k=9e5) --mass 5g --height 100mm
simulate-drop: simulate drop --law kelvin-voigt(k=900,c=9) --mass 5g --height 1mm --impacts 9
simulate-eccentric-drop: simulate drop --law hertz(k=9e5) --mass 5g --height 100mm --radius 10mm \
    --offset 3mm
simulate-eccentric-drop: simulate drop --law hertz(k=9e5) --mass 5g --height 100mm \
    --semi-axes 12mm,10mm
design: design ccd --factor A=0..1 --factor B=0..1
design: design factorial --factor A=0..1 --factor B=red,green
regress: regress design.csv --response y --terms A+B
regress: regress design.csv --formula y~A+B --select backward --p-remove 0.05
regress: regress design.csv --formula log(y)~A+B --predict few.csv
regress: regress few.csv --formula y~A*B
regress: regress fruit.csv --formula k~V+fruit --variance fruit --means fruit
regress: regress fruit.csv --formula k~V+fruit --means fruit
regress: regress fruit.csv --formula k~V --random fruit --predict fruit.csv
surface: surface design.csv --factor A --factor B --response y --model A+B
surface: surface design.csv --factor A --factor B --response y --model A*B \
    --goal "y = maximum" --grid A,B --grid-points 3
surface: surface few.csv --factor A --factor B --response y --model A*B
compare: compare fruit.csv --value k --by fruit
compare: compare fruit.csv --value k --by V --paired fruit
compare-agreement: compare design.csv --measured y --predicted B
summary: summary design.csv --value y --by A
summary: summary holes.csv --value y --by g
plan: plan mean --sd 1 --half-width 1
plan: plan difference --sd 1 --difference 1 --power 0.8
plan: plan groups --means 1,2 --sd 1 --power 0.8
plan: plan slope --slope 1 --x 1,2 --sd 1 --power 0.8
plan: plan model fruit.csv --formula k~V+(1|fruit) --fruit 4 --simulations 50
plan: plan surface design.csv --factor A --factor B --model A+B --coefficients A=1 --sd 1 --fruit 2
plan: plan population card.toml --parameter k --within 0.05 --fruit 4
plan: plan critical-energy --median 1 --spread 0.5 --energies 0.5,1,2 --fruit 8 --simulations 50
plan-achieved: plan achieved fruit.csv --formula k~V+(1|fruit)
scene-run: scene run scene/scene.toml
scene-study: scene study scene/study.toml
scene-picture: scene picture scene/scene.run
scene-vtk: scene vtk scene/scene.run
scene-table: scene table scene/scene.run fruit --out fruit.parquet
scene-deck: scene export drop.toml --engine lammps --out deck
scene-contacts: scene export scene/scene.toml --engine yade
radius: radius --diameters 70mm,68mm,72mm
bounces: bounces --intervals 547,412,314ms
bruise: bruise --widths 10mm,12mm --depth 3mm
explain: explain clipped
licences: licences
licences: licences --texts
"""
"""Schemas and command lines that answer by them."""


def split(text: str) -> list[str]:
    return [line for line in re.sub(r"\\\n\s*", "", text).splitlines() if line]


def schema_of(windfall: Command, name: str) -> dict[str, Any]:
    schema: dict[str, Any] = json.loads(windfall.out("schema", name))
    jsonschema.Draft202012Validator.check_schema(schema)
    return schema


def closed(schema: dict[str, Any], whole: bool = True) -> dict[str, Any]:
    """Forbids all keys that a schema does not name.

    Of parts that make up one object together, only the whole is closed.
    """
    own = dict(schema)
    for word in ("properties", "$defs"):
        if word in own:
            of = word == "properties"
            own[word] = {name: closed(part, of) for name, part in own[word].items()}
    for word in ("items", "additionalProperties"):
        if isinstance(own.get(word), dict):
            own[word] = closed(own[word])
    for word in ("allOf", "anyOf", "prefixItems"):
        if word in own:
            own[word] = [closed(part, word == "prefixItems") for part in own[word]]
    if whole and own.keys() & {"properties", "allOf", "anyOf", "$ref"}:
        own["unevaluatedProperties"] = False
    return own


def results(windfall: Command) -> list[str]:
    """Names of all results, which an unknown name is answered with."""
    told = windfall("schema", "nothing-like-it")
    assert told.returncode == 2
    listed = re.search(r"possible values: ([^\]]*)\]", told.stderr)
    assert listed, told.stderr
    return listed[1].split(", ")[FILES:]


@pytest.fixture(scope="module")
def folder(windfall: Command, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("results")
    for line in split(MADE):
        done = windfall(*shlex.split(line), cwd=folder)
        assert done.returncode == 0, f"{line}: {done.stderr}"
    for name, text in TABLES.items():
        (folder / name).write_text(text)
    scene = folder / "scene" / "scene.toml"
    text = scene.read_text().replace("count = 100", "count = 3")
    scene.write_text(text.replace('end = "4 s"', 'end = "0.2 s"'))
    return folder


@pytest.fixture(scope="module")
def answers(windfall: Command, folder: Path) -> list[tuple[str, str, dict[str, Any]]]:
    """Schema, command line and answer of each line."""
    found = []
    for line in split(LINES):
        name, words = line.split(": ", 1)
        done = windfall(*shlex.split(words), "--format", "json", cwd=folder)
        assert done.returncode == 0, f"{words}: {done.stderr}"
        found.append((name, words, json.loads(done.stdout)))
    return found


def test_answers_are_valid_and_have_no_other_keys(
    windfall: Command, answers: list[tuple[str, str, dict[str, Any]]]
) -> None:
    wrong = []
    for name, words, answer in answers:
        assert answer["schema"].split("/")[0] == name, words
        schema = schema_of(windfall, answer["schema"])
        own = jsonschema.Draft202012Validator(closed(schema))
        errors = [jsonschema.exceptions.best_match([error]) for error in own.iter_errors(answer)]
        wrong += [f"{words}: {error.json_path}: {error.message[:200]}" for error in errors if error]
    assert wrong == []


def test_every_result_has_an_answer(
    windfall: Command, answers: list[tuple[str, str, dict[str, Any]]]
) -> None:
    # A study is a file, too, so its result is called by its number.
    names = {name.split("/")[0] for name in results(windfall)}
    assert names == {name for name, _, _ in answers}
    assert len(names) >= 40


def objects(value: Any) -> Iterator[dict[str, Any]]:
    """All objects below a value."""
    if isinstance(value, dict):
        yield value
    for part in value.values() if isinstance(value, dict) else value:
        if isinstance(part, (dict, list)):
            yield from objects(part)


def test_what_is_wrong_is_found(
    windfall: Command, answers: list[tuple[str, str, dict[str, Any]]]
) -> None:
    first = {name: answer for name, _, answer in reversed(answers)}
    for name, answer in first.items():
        schema = schema_of(windfall, answer["schema"])
        open_, own = (
            jsonschema.Draft202012Validator(either) for either in (schema, closed(schema))
        )
        # A key more: allowed by the schema, as later versions may have it.
        answer["no_such_key"] = 1
        assert open_.is_valid(answer) and not own.is_valid(answer), name
        del answer["no_such_key"]
        # A key less.
        for key in schema["required"]:
            kept = answer.pop(key)
            assert not open_.is_valid(answer), f"{name}: {key}"
            answer[key] = kept
        # Another shape.
        assert not open_.is_valid({**answer, "schema": f"{name}/0"}), name
        # What stands deeper; values under names of the user's have any name.
        inner = [own for own in objects(answer) if own is not answer and own][:20]
        tried = [wrongs(own, open_, answer) for own in inner]
        assert all(tried), f"{name}: {inner[tried.index(False)]}"


def wrongs(part: dict[str, Any], own: Any, answer: dict[str, Any]) -> bool:
    """Whether a value of no possible type is found in a part of an answer."""
    key = next(iter(part))
    kept = part[key]
    part[key] = {"no": [{"such": "type"}]}
    found = not own.is_valid(answer)
    part[key] = kept
    return found


def test_keys_that_may_be_missing_are_missing_somewhere(
    windfall: Command, answers: list[tuple[str, str, dict[str, Any]]]
) -> None:
    """A key that is always written is required."""
    optional: set[str] = set()
    for name in results(windfall):
        schema = schema_of(windfall, name)
        for part in [schema, *schema["$defs"].values()]:
            for every in [part, *part.get("allOf", []), *part.get("anyOf", [])]:
                keys = every.get("properties", {}).keys() - set(every.get("required", []))
                optional |= keys
    assert optional == {
        # intervals and profiles of a fit
        "replicates",
        "failed",
        "chains",
        "draws",
        "divergences",
        "mixing",
        "drawn",
        "profiles",
        "open",
        # a bootstrap of laws, a posterior of a population
        "aicc_low",
        "aicc_high",
        "posterior",
        # parts of recordings, what was wrong with one
        "parts",
        "findings",
        # law cards
        "cautions",
        "covariates",
        "meaning",
        "parameters",
        "unloading",
        # bodies that turn: of a disc or of an ellipse
        "radius",
        "offset",
        "semi_axes",
    }


def test_a_name_that_is_nearly_right_is_suggested(windfall: Command) -> None:
    told = windfall("schema", "regres")
    assert told.returncode == 2 and "'regress'" in told.stderr.split("tip:")[1]
    # By what stands in the JSON, too; the file of a study and its result are not the same.
    assert windfall.out("schema", "regress/1") == windfall.out("schema", "regress")
    assert windfall.out("schema", "scene-study/1") != windfall.out("schema", "scene-study")
