"""Runs windfall on campaigns, scenes, studies, cards and tables in which something is wrong.

Usage: check_mutants.py WINDFALL [NUMBER [SEED]] [--data FOLDER] [--only NAME] [--show]

Each mutant is a file of mutant_bases.py with one change: a value of a wrong type, unit, sign
or size, NaN, a key that is misspelt, missing or there twice, a table of another name, a cell
of a CSV, a line or file that is cut, bytes that are others. It is used by a command that fits,
runs or shows what is in it, with 2 GB of memory and 20 s of a processor. Then

    no panic, no signal, no end of the time; status 0, 1 or 2
    status 2   names the file; where one value, key or cell was changed, also its line and key
    status 0   shows no NaN or infinity, and in JSON no null that is not null otherwise
    inputs     have every byte as before

Exit status 1 if anything is otherwise. Python's standard library only.
"""

import argparse
import collections
import concurrent.futures
import json
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from mutant_bases import bases

SECONDS = 20
LIMITS = f'ulimit -v {2 << 20}; ulimit -t {SECONDS}; ulimit -c 0; exec "$@"'
KEY = re.compile(r"^(?P<off># )?(?P<key>\w+) *= *(?P<value>[^\s#].*?)(?P<rest> +#.*)?$")
INNER = re.compile(r'("[^"]*"|[\w.]+) *= *')
TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|' + r"'[^']*'|(?<![\w.])[-+]?[\d.]+(?:[eE][-+]?\d+)?(?![\w.])")
QUANTITY = re.compile(r"^([-+]?[\d.]+(?:[eE][-+]?\d+)?) ?(.*)$")
NUMBERS = ["0", "-1", "1e300", "-1e300", "1e-300", "1e999", "nan", "inf", "-inf", "NaN", "1e12", "1000000000000",
           "9223372036854775807", "9223372036854775808", "0x10", "1_000", "1,5", "5.0.1", "٣", "1e-9", "0.5", "2", "65537"]
UNITS = ["kg", "m", "s", "N", "Hz", "J", "m/s", "N/m^1.5", "parsec", "kg kg", "%", "", "m^999", "µ", "°"]
VALUES = ["true", "[]", "{}", '""', '" "', "1979-05-27", "[[]]", '"x"', '"\\u0000"', '"a\\nb"', '"\u202e"', "'''", '"',
          '["a", 1]', '{ a = 1 }', "-5", "5", "0", "1e999", "nan", "inf", "1000000000000", "[" * 3000, '"' + "y" * 100_000 + '"',
          '"1e300 kg"', '"../../../etc/passwd"', '"/dev/zero"', '"c"']
CELLS = ["", " ", "NaN", "inf", "-1", "0", "1e300", "1e999", "x", "1,5", "-", "=1+1", '"', "5 kg", "y" * 10_000, "../x.csv",
         "/dev/zero", "\0", "1e12", "١", "1e-300"]
# A change of these is a fault elsewhere: of what refers to them, or of what they choose.
ELSEWHERE = {"kind", "materials", "name", "material", "between", "format", "title", "value"}
# A change of these may be a fault of how they and others fit together, which is told of the table.
TOGETHER = {"diameter", "diameter_sd", "drop", "pour", "plane", "plate", "box", "low", "high", "move", "levels"}
# Names that are free: one that nothing else uses is missed where it is used.
FREE = re.compile(r"^(properties|parameters)$|^[a-z]$")
# A number of these may ask for more work than there is time for.
WORK = {"replicates", "draws", "chains", "count", "end", "time_step", "time_step_error", "frames", "scene.end",
        # A plate that is hardly damped rings for long.
        "plate_damping"}
WRONG = re.compile(r"(?<![\w.-])(NaN|-?nan|[-+]?inf(inity)?)(?![\w-])")
# Where JSON has null for what cannot be known: of one value, of a recording that was not fitted.
UNKNOWN = re.compile(r"\.(sd|robust_sd|cv|low|high|press|r2_predicted)$|\.failed\[\]\.law$|\.influence\[\]\.\w+$|\.runs_z$|\.simulated$"
                     # Scenes without a table [bruise].
                     r"|^\.bruise$")


class Mutant:
    """A changed text: what, on which line, and which words of the line a message may name."""

    def __init__(self, data, what, line=None, names=()):
        self.data, self.what, self.line, self.names = data, what, line, [name for name in names if name]


def other_value(draw, value, whole=0.3):
    """A value in the place of another one: of a wrong type, or its number or unit is another."""
    tokens = list(TOKEN.finditer(value))
    if not tokens or draw.random() < whole:
        return draw.choice(VALUES)
    token = draw.choice(tokens)
    text = token[0]
    if text[0] not in "\"'":
        new = draw.choice(NUMBERS)
    else:
        inner = QUANTITY.match(text[1:-1])
        if inner:
            number, unit = inner.groups()
            new = draw.choice([f"{draw.choice(NUMBERS)} {unit}", f"{number} {draw.choice(UNITS)}", number,
                               f"-{number} {unit}", unit, f"{number}{unit}{unit}"]).strip()
        else:
            numbers = list(re.finditer(r"[\d.]+(?:e-?\d+)?", text[1:-1]))
            at = draw.choice(numbers) if numbers else None
            new = text[1:-1]
            if at and draw.random() < 0.6:
                new = new[:at.start()] + draw.choice(NUMBERS) + new[at.end():]
            else:
                new = draw.choice([new[:-1], new + "x", new.upper(), "", new[::-1], new + " " + new, f"({new})"])
        new = text[0] + new + text[0]
    return value[:token.start()] + new + value[token.end():]


def change_toml(draw, text):
    lines = text.split("\n")
    places = [i for i, line in enumerate(lines) if KEY.match(line) or line.strip()[:1] == "{" and TOKEN.search(line)]
    at = draw.choice(places)
    found = KEY.match(lines[at])
    # A list over several lines is one value.
    whole = not found or found["value"][-1] not in "[,"
    way = draw.choice(["value"] * 8 + ["key", "remove", "twice", "table", "cut", "bytes", "end", "deep"])
    join = lambda: "\n".join(lines).encode()
    inner = [name.strip('"') for name in INNER.findall(lines[at].removeprefix("# "))]
    if way == "value":
        if found:
            value = other_value(draw, found["value"])
            lines[at] = f"{found['key']} = {value}{found['rest'] or ''}"
        else:
            lines[at] = other_value(draw, lines[at], 0)
        # What was a remark may be in the way of another key; what is not closed ends elsewhere.
        closed = lines[at].count("[") == lines[at].count("]") and lines[at].count('"') % 2 == 0 and "'''" not in lines[at]
        elsewhere = (ELSEWHERE | TOGETHER) & set(inner) or any(FREE.match(name) for name in inner)
        known = whole and closed and not (found and found["off"]) and not elsewhere
        return Mutant(join(), f"line {at + 1}: {lines[at][:120]}", at + 1 if known else None, inner)
    if way == "key" and found and whole:
        key = found["key"]
        spot = draw.randrange(len(key))
        new = draw.choice([key[:spot] + key[spot + 1:], key + "s", key[:spot] + "x" + key[spot:], key.upper(), f"{key}.{key}"])
        # Without its key the line may be read as something else; so may a name that is free.
        strict = new not in ("", key) and not ELSEWHERE & {key} and not FREE.match(key) and not found["off"]
        lines[at] = f"{new} = {found['value']}"
        return Mutant(join(), f"line {at + 1}: {lines[at][:120]}", at + 1 if strict and new else None, [new.split(".")[0]])
    if way == "twice" and found:
        lines.insert(at + 1, lines[at].removeprefix("# "))
        return Mutant(join(), f"line {at + 1} twice: {lines[at][:120]}", None, inner)
    if way == "table":
        tables = [i for i, line in enumerate(lines) if line.startswith("[")]
        if tables:
            at = draw.choice(tables)
            old = lines[at]
            name = old.strip("[]")
            lines[at] = draw.choice([old.replace(name, name + "x"), old.replace(name, name[1:]), old[:-1], f"[{old}]",
                                     old.strip("[]"), "", f"{old}\n{old}", old.replace(name, f"a.{name}")])
            return Mutant(join(), f"line {at + 1}: {old} is {lines[at]!r}")
    if way == "cut":
        lines[at] = lines[at][: draw.randrange(len(lines[at]))]
        return Mutant(join(), f"line {at + 1} cut: {lines[at][:120]}")
    if way == "deep":
        key = found["key"] if found else "a"
        opened = draw.choice(["[", "{a=", "[{a=["])
        lines[at] = f"{key} = " + opened * draw.choice([10, 200, 20_000])
        return Mutant(join(), f"line {at + 1}: {opened} many times")
    if way == "remove":
        line = lines.pop(at)
        return Mutant(join(), f"line {at + 1} removed: {line[:120]}", None, inner)
    return change_bytes(draw, text.encode(), way)


def change_bytes(draw, data, way):
    data = bytearray(data)
    if way == "end":
        at = draw.randrange(len(data) + 1)
        return Mutant(bytes(data[:at]), f"cut after {at} bytes")
    spots = sorted(draw.randrange(len(data)) for _ in range(draw.choice([1, 1, 2, 5, 20])))
    for spot in spots:
        data[spot] = draw.randrange(256)
    return Mutant(bytes(data), f"other bytes at {spots}")


def change_csv(draw, text):
    lines = text.split("\n")
    rows = [i for i, line in enumerate(lines) if line and not line.startswith("#")]
    header = lines[rows[0]].split(",")
    at = draw.choice(rows[:1] + rows[1:] * 8 if len(rows) < 30 else rows)
    cells = lines[at].split(",")
    column = draw.randrange(len(cells))
    way = draw.choice(["cell"] * 6 + ["short", "long", "twice", "remove", "bytes", "end"])
    join = lambda: "\n".join(lines).encode()
    if way == "cell":
        old = cells[column]
        number = QUANTITY.match(old) if draw.random() < 0.5 else None
        cells[column] = draw.choice(NUMBERS) if number else draw.choice(CELLS)
        lines[at] = ",".join(cells)
        name = header[column] if column < len(header) else ""
        # What identifies a row is missed where it is referred to.
        known = at != rows[0] and name not in ("id", "specimen", "fruit", "file", "time_s") and not set(',"') & set(cells[column])
        return Mutant(join(), f"line {at + 1}, {name}: {cells[column][:60]!r} for {old!r}", at + 1 if known else None, [name])
    if way == "short":
        lines[at] = ",".join(cells[:column])
    elif way == "long":
        lines[at] += ",x,y"
    elif way == "twice":
        lines.insert(at, lines[at])
    elif way == "remove":
        lines.pop(at)
    else:
        return change_bytes(draw, text.encode(), way)
    return Mutant(join(), f"line {at + 1} {way}")


def changed(draw, path):
    data = path.read_bytes()
    try:
        text = data.decode()
        if path.suffix == ".toml":
            return change_toml(draw, text)
        if path.suffix == ".csv":
            return change_csv(draw, text)
    except UnicodeDecodeError:
        pass
    return change_bytes(draw, data, draw.choice(["end", "bytes"]))


def nulls(value, path=""):
    """Paths of a document at which there is nothing."""
    if value is None:
        yield path
    elif isinstance(value, dict):
        for key, own in value.items():
            yield from nulls(own, f"{path}.{key}")
    elif isinstance(value, list):
        for own in value:
            yield from nulls(own, path + "[]")


def problems_of(mutant, name, own, words, usual):
    """What is wrong with what a command did. own: its status and what it told; none where it did not end"""
    if own is None:
        return ["no end"]
    told = " ".join(own.stderr.split())
    if "panicked" in told or "overflowed its stack" in told or "memory allocation" in told:
        return [f"panic: {told[:400]}"]
    if own.returncode in (-9, 137):
        return [] if WORK & set(mutant.names) else [f"no end within {SECONDS} s of a processor"]
    if own.returncode not in (0, 1, 2):
        return [f"status {own.returncode}: {told[:400]}"]
    if own.returncode == 0:
        # A text that the user wrote is shown as it is.
        shown = own.stdout.replace(mutant.what, "")
        found = WRONG.search(shown)
        if found and not WRONG.search(mutant.what):
            around = shown[max(found.start() - 60, 0):found.end() + 60]
            return [f"shows {found[0]}: {around!r}"]
        if "json" in words:
            new = sorted(set(nulls(json.loads(own.stdout))) - usual)
            return [f"null at {path}" for path in new if not UNKNOWN.search(path)]
        return []
    if own.returncode == 1:
        return []
    # A scene whose values are all possible may still come to no end of its run.
    # A formula that lacks a parameter may be wrong, or its list of parameters.
    if "the scene was stopped: at" in told or "is declared but not used in the formula" in told:
        return []
    # What is in a recording may be wrong only for what is asked of it; another file or option
    # may be what does not fit what was changed.
    elsewhere = "raw" in Path(name).parts or mutant.line is None and re.search(r"\w\.(toml|csv)|error: --", told)
    if Path(name).name not in told and not elsewhere:
        return [f"does not name the file: {told[:400]}"]
    # A number in a recording is a sample, whatever it is; a blank cell of specimens.csv is
    # missed on the line of impacts.csv that needs it.
    sample = "raw" in Path(name).parts and re.search(r": '[-+\d.e]+' for", mutant.what)
    blank = name.endswith("specimens.csv") and re.search(r": ' *' for", mutant.what) and "specimens.csv" in told
    if mutant.line is not None and not sample and not blank:
        # Where a table must rise, either of two rows may be wrong.
        lines = f"({mutant.line}|{mutant.line + 1})" if name == "force.csv" else str(mutant.line)
        if not re.search(rf"{re.escape(Path(name).name)}, line {lines}\b", told):
            return [f"does not name the line: {told[:400]}"]
        if mutant.names and not any(own in told for own in mutant.names):
            return [f"does not name the key: {told[:400]}"]
    return []


def try_one(program, base, seed, scratch, usual):
    """Runs one mutant; its status and its problems."""
    draw = random.Random(seed)
    names = [name for name, weight in base.files.items() for _ in range(weight)]
    name = draw.choice(names)
    words = draw.choice(base.commands)
    with tempfile.TemporaryDirectory(dir=scratch) as folder:
        folder = Path(folder, "w")
        shutil.copytree(base.folder, folder)
        mutant = changed(draw, folder / name)
        (folder / name).write_bytes(mutant.data)
        before = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
        try:
            own = subprocess.run(["sh", "-c", LIMITS, "sh", program, *words], cwd=folder, capture_output=True, text=True,
                                 errors="replace", timeout=6 * SECONDS, stdin=subprocess.DEVNULL)
        except subprocess.TimeoutExpired:
            own = None
        problems = problems_of(mutant, name, own, words, usual)
        problems += [f"has changed {path.name}" for path, data in before.items()
                     if not path.is_file() or path.read_bytes() != data]
    where = f"{base.name}, {name}, {mutant.what}; {' '.join(words)}"
    return (own.returncode if own else "none"), [f"{where}: {problem}" for problem in problems], where


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=lambda text: str(Path(text).resolve()))
    parser.add_argument("number", type=int, nargs="?", default=5000)
    parser.add_argument("seed", type=int, nargs="?", default=1)
    parser.add_argument("--data", type=Path, default=os.environ.get("WINDFALL_DATA"))
    parser.add_argument("--only", help="this base alone")
    parser.add_argument("--first", type=int, default=0, help="number of the first mutant")
    parser.add_argument("--show", action="store_true", help="every mutant with its status")
    own = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="windfall-mutants-") as scratch:
        scratch = Path(scratch)
        data = own.data.resolve() if own.data and own.data.is_dir() else None
        made = bases(own.program, scratch, data)
        usual = set()
        for base in made:
            for words, shown in zip(base.commands, base.usual):
                usual |= set(nulls(json.loads(shown))) if "json" in words else set()
        chosen = [base for base in made if own.only in (None, base.name)]
        statuses, problems = collections.Counter(), []
        one = lambda index: try_one(own.program, chosen[index % len(chosen)], f"{own.seed} {index}", scratch, usual)
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            for index, (status, found, where) in enumerate(pool.map(one, range(own.first, own.first + own.number)), own.first):
                statuses[chosen[index % len(chosen)].name, status] += 1
                problems += found
                if own.show:
                    print(f"{index} {status} {where}")
                for problem in found:
                    print(f"PROBLEM {index} {problem}", flush=True)
    for base in chosen:
        counts = ", ".join(f"{statuses[base.name, status]} with status {status}"
                           for status in (0, 1, 2, "none") if statuses[base.name, status])
        print(f"{base.name:16} {counts}")
    print(f"{own.number} mutants of {len(chosen)} kinds{'' if data else ', without real recordings'}: {len(problems)} problems")
    return bool(problems)


if __name__ == "__main__":
    sys.exit(main())
