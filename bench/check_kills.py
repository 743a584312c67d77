"""Kills windfall in the midst of its work, and looks at what is left.

Usage: check_kills.py WINDFALL [--kills N] [--seed S] [--kinds 'a; b'] [--calls] [--keep]

Of every kind of work N / (number of kinds) runs are killed (SIGKILL) at a moment that is
drawn evenly from the time that the work takes, half of them over the results of an earlier
run. --calls kills at every single call that makes, writes, renames or removes a file
instead, by strace: the first of its kind, the second, and so on until the work ends before.

What is then there must be

    inputs         with every byte as before
    results        each the one of before or the new one, byte for byte but for times of day and
                   for how much of them came from the store
    results.sqlite sound, with all results of before, and none but those and the new ones
    partial files  only under names that say so

and after the same command once more, all files must equal those of a run that was never
killed, with no file beside them, none in the folder for temporary files, no process, and
each result in the list of what windfall wrote. Exit status 1 if anything is otherwise.
Python's standard library only.
"""

import argparse
import collections
import hashlib
import os
import random
import re
import shutil
import sqlite3
import statistics
import sys
import tempfile
import time
from pathlib import Path

from kill_kinds import KINDS, is_there

# Files that only serve the work, by their names, besides those of a kind.
WORKING = re.compile(r"(\.\d+-\d+\.windfall-partial|\.partial|results\.sqlite-journal|checkpoint\.bin)$"
                     r"|\.\d+-\d+\.windfall-scratch/")
LIST = ".windfall-wrote"
LINE = re.compile(r"([0-9a-f]{64}|any)  .+")
TIMES = re.compile(rb"\d{4}-\d\d-\d\d([T ]\d\d:\d\d(:\d\d)?Z?)?")
# What results.json tells of how it came about: how much was in the store.
PASS = re.compile(rb'"(fitted|stored|up_to_date)": \w+')
# Kind of the documents that a new one replaces: it says of which results the table of results is,
# and is written last; with the one of before, the table is made anew.
REPLACED = "origin"
# Calls at which --calls kills.
CALLS = ["openat", "write", "pwrite64", "ftruncate", "fsync", "fdatasync", "rename", "renameat2",
         "link", "linkat", "unlink", "unlinkat", "mkdir", "rmdir", "fchmod"]


def content(path):
    """What a file holds, but for times of day and what was in the store; of a store its rows."""
    if path.name == "results.sqlite":
        return rows_of_store(path)
    return PASS.sub(b"PASS", TIMES.sub(b"TIME", path.read_bytes()))


def rows_of_store(path):
    """Rows of all tables, as sets; None of a store without tables. Raises where it is not sound."""
    with tempfile.TemporaryDirectory() as scratch:
        # With its journal, as the next run finds it; the original stays as it is.
        for name in [path.name, path.name + "-journal"]:
            if (path.parent / name).exists():
                shutil.copy(path.parent / name, scratch)
        store = sqlite3.connect(Path(scratch, path.name))
        verdict = store.execute("PRAGMA integrity_check").fetchone()[0]
        if verdict != "ok":
            raise ValueError(f"{path}: {verdict}")
        tables = [name for (name,) in store.execute("SELECT name FROM sqlite_master WHERE type = 'table'")]
        found = {}
        for table in tables:
            rows = store.execute(f"SELECT * FROM {table}")
            names = [own[0] for own in rows.description]
            kept = [i for i, name in enumerate(names) if name not in ("id", "run", "time")]
            kind = (lambda row: row[names.index("kind")]) if "kind" in names else lambda row: None
            # The newest comparison takes the place of the one of before, and tells its time.
            rows = [row for row in rows if kind(row) != "kept"]
            of = lambda wanted: frozenset(tuple(row[i] for i in kept) for row in rows if (kind(row) == REPLACED) == wanted)
            found[table], found[table, REPLACED] = of(False), of(True)
        store.close()
    return tuple(sorted(found.items(), key=str)) or None


def between(left, before, after=None):
    """Whether a store has all rows of before, and no others than the new ones: some work adds them in two runs.
    Of rows that are replaced it has those of before or the new ones."""
    before, left, after = dict(before or ()), dict(left or ()), dict(after or ())
    rows = lambda store, table: store.get(table, frozenset())
    def fits(table):
        old, own, new = rows(before, table), rows(left, table), rows(after, table)
        return own in (old, new) if isinstance(table, tuple) else old <= own <= new
    return all(fits(table) for table in {**before, **left})


def snapshot(folder, kind):
    """Contents of all files of a folder by name; those that differ from run to run have none."""
    found = {}
    for path in sorted(folder.rglob("*")):
        name = str(path.relative_to(folder))
        if path.name == LIST or path.is_dir() and not path.is_symlink():
            continue
        plain = path.is_file() and not path.is_symlink()
        found[name] = content(path) if plain and not kind.differs.search(name) else b""
    return {name: own for name, own in found.items() if own is not None}


def list_problems(folder, given=None):
    """What is wrong with the lists of what was written. given: whether a file is the user's; all others must be listed"""
    problems = []
    for path in folder.rglob(LIST):
        text = path.read_text()
        lines = text.splitlines()
        problems += [f"{path.name} has the line {line!r}" for line in lines if not LINE.fullmatch(line)]
        if text and not text.endswith("\n"):
            problems.append(f"{path.name} ends within a line")
        if given is None:
            continue
        for own in path.parent.iterdir():
            name = str(own.relative_to(folder))
            if own.name in (LIST, "results.sqlite") or not own.is_file() or given(name):
                continue
            digest = hashlib.sha256(own.read_bytes()).hexdigest()
            if f"{digest}  {own.name}" not in lines and f"any  {own.name}" not in lines:
                problems.append(f"{name} is in no list")
    return problems


def processes_in(folder):
    """Programs that still run in a folder."""
    found = []
    for own in Path("/proc").glob("[0-9]*"):
        try:
            if Path(os.readlink(own / "cwd")).is_relative_to(folder.resolve()):
                found.append(f"{own.name} {(own / 'comm').read_text().strip()}")
        except OSError:
            pass
    return found


class Study:
    """All that is needed of one kind of work: its files before and after, and how long it takes."""

    def __init__(self, program, name, scratch):
        self.program, self.name, self.kind = program, name, KINDS[name]
        self.scratch = scratch / name.replace(" ", "-")
        self.scratch.mkdir()
        self.problems, self.phases, self.parts = [], collections.Counter(), []
        fresh, over = self.scratch / "fresh", self.scratch / "over"
        fresh.mkdir()
        self.kind.make(program, fresh)
        self.inputs = snapshot(fresh, self.kind)
        shutil.copytree(fresh, over, symlinks=True)
        self.kind.earlier(program, over)
        if not self.kind.changes_inputs and {name: own for name, own in snapshot(over, self.kind).items() if name in self.inputs} != self.inputs:
            raise SystemExit(f"{name}: inputs have changed without a kill")
        self.starts = [fresh, over]
        self.states, times = [], []
        for start in self.starts:
            folder = self.copy(start, "whole")
            self.states.append(self.kind.whole(program, folder, lambda: snapshot(folder, self.kind), times))
        # The first runs read the program from the disk.
        for _ in range(2):
            folder = self.copy(self.starts[0], "whole")
            self.kind.whole(program, folder, dict, times)
        self.time = statistics.median(times[1:])
        shutil.rmtree(folder)

    def copy(self, start, name):
        folder = self.scratch / name
        for own in [folder, self.scratch / (name + ".tmp")]:
            shutil.rmtree(own, ignore_errors=True)
        shutil.copytree(start, folder, symlinks=True)
        return folder

    def trial(self, over, moment, before=(), keep=False, alone=False):
        """One kill; whether it came before the work had ended.

        over: whether results of an earlier run are there
        moment: part of the time that the work takes; none where `before` kills
        before: words before the command, of who kills
        """
        folder = self.copy(self.starts[over], "killed")
        states = self.states[over]
        begin = time.monotonic()
        run = self.kind.launch(self.program, folder, before)
        killed, done = self.kind.kill_at(run, moment and moment * self.time, alone)
        if not killed and moment is not None:
            # The machine was busier before: later moments are drawn from what it takes now.
            self.time = min(self.time, time.monotonic() - begin)
        problems = self.what_is_left(folder, states, done)
        found = self.phase(folder, states) if killed else "ended before"
        self.phases[found] += 1
        if killed and moment is not None:
            self.parts.append(moment)
        if problems and keep:
            shutil.copytree(folder, self.scratch / f"problem-{len(self.problems)}", symlinks=True)
        problems += self.after_the_next_run(folder, states[-1], done)
        where = f"{self.name}, {'over an earlier run' if over else 'first run'}, "
        where += f"at {moment:.3f} of the time" if moment is not None else "at " + " ".join(before)[-40:]
        self.problems += [f"{where}, {found}: {problem}" for problem in problems]
        return killed

    def what_is_left(self, folder, states, done):
        """done: states that the work has reached for certain"""
        try:
            left = snapshot(folder, self.kind)
        except Exception as error:
            return [f"cannot be read: {error}"]
        problems = list_problems(folder)
        allowed = states[done : done + 2]
        working = lambda name: WORKING.search(name) or self.kind.working.search(name)
        for name in sorted({*left, *(name for state in allowed for name in state)}):
            wanted = [state.get(name) for state in allowed]
            if left.get(name) in wanted or name not in allowed[0] and name not in left:
                continue
            if name.endswith("results.sqlite") and between(left.get(name), *wanted):
                continue
            if name not in left:
                # Set aside until the new one is there.
                if left.get(name.replace(*self.kind.aside)) != wanted[0]:
                    problems.append(f"{name} is lost")
            elif name in self.inputs and wanted[0] == wanted[-1]:
                problems.append(f"the input {name} has changed")
            elif any(own is not None for own in wanted):
                problems.append(f"{name} is neither the one of before nor the new one")
            elif not working(name):
                problems.append(f"{name} is no name of an unfinished file")
        return problems

    def phase(self, folder, states):
        """How far the writing was, at the end of a kill."""
        try:
            left = snapshot(folder, self.kind)
        except Exception:
            return "not readable"
        if left == states[0]:
            return "nothing written yet"
        return "all written" if left == states[-1] else "while writing"

    def after_the_next_run(self, folder, wanted, done):
        problems = self.kind.finish(self.program, folder, done)
        try:
            found = snapshot(folder, self.kind)
        except Exception as error:
            return [*problems, f"after the next run: cannot be read: {error}"]
        for name in sorted({*found, *wanted}):
            if found.get(name) != wanted.get(name):
                what = "is missing" if name not in found else "stays" if name not in wanted else "differs"
                problems.append(f"after the next run: {name} {what}")
        given = lambda name: name in self.inputs or self.kind.given.search(name)
        problems += [f"after the next run: {own}" for own in list_problems(folder, given)]
        temporary = folder.parent / (folder.name + ".tmp")
        problems += [f"after the next run: {own.name} stays in the folder for temporary files"
                     for own in temporary.iterdir()]
        for _ in range(50):
            running = processes_in(folder)
            if not running:
                break
            time.sleep(0.1)
        return problems + [f"after the next run: process {own} still runs" for own in running]


def at_moments(study, kills, draw, keep):
    killed = 0
    for attempt in range(3 * kills):
        if killed == kills:
            return
        # A run that was faster than usual has ended: another moment.
        killed += study.trial(attempt % 2, draw.random(), keep=keep, alone=draw.random() < 0.3)


def at_calls(study, keep, most):
    """Kills at each call in turn; how many."""
    count = 0
    for over in (0, 1):
        for call in CALLS:
            for number in range(1, most + 1):
                trace = ["strace", "-f", "-qq", "-o", "/dev/null", "-e", f"trace={call}",
                         "-e", f"inject={call}:signal=SIGKILL:when={number}"]
                if not study.trial(over, None, trace, keep=keep):
                    break
                count += 1
    return count


def histogram(parts):
    counts = collections.Counter(min(int(10 * part), 9) for part in parts)
    for tenth in range(10):
        count = counts[tenth]
        print(f"  {tenth / 10:.1f} to {(tenth + 1) / 10:.1f} of the time  {count:5}  {'#' * round(count / max(counts.values()) * 40)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=lambda text: str(Path(text).resolve()))
    parser.add_argument("--kills", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kinds", default=";".join(KINDS))
    parser.add_argument("--calls", action="store_true")
    parser.add_argument("--most", type=int, default=100_000, help="calls of one kind")
    parser.add_argument("--keep", action="store_true", help="keep what problems were found in")
    own = parser.parse_args()
    draw = random.Random(own.seed)
    names = [name.strip() for name in own.kinds.split(";")]
    for name in [name for name in names if not is_there(KINDS[name])]:
        print(f"not made, because {KINDS[name].needs} is not installed: {name}")
        names.remove(name)
    scratch = Path(tempfile.mkdtemp(prefix="windfall-kills-"))
    problems, parts, total = [], [], 0
    print(f"{'work':28}{'time':>8}{'kills':>7}  when")
    for number, name in enumerate(names):
        study = Study(own.program, name, scratch)
        if own.calls:
            at_calls(study, own.keep, own.most)
        else:
            at_moments(study, own.kills * (number + 1) // len(names) - own.kills * number // len(names), draw, own.keep)
        kills = sum(count for phase, count in study.phases.items() if phase != "ended before")
        phases = ", ".join(f"{count} {phase}" for phase, count in sorted(study.phases.items()))
        print(f"{name:28}{study.time:6.2f} s{kills:7}  {phases}", flush=True)
        for problem in study.problems[:20]:
            print(f"  PROBLEM {problem}", flush=True)
        problems += study.problems
        parts += study.parts
        total += kills
        if not own.keep:
            shutil.rmtree(study.scratch)
    if parts:
        histogram(parts)
    print(f"{total} kills, {len(problems)} problems" + (f"; what is left is in {scratch}" if own.keep else ""))
    if not own.keep:
        shutil.rmtree(scratch)
    return bool(problems)


if __name__ == "__main__":
    sys.exit(main())
