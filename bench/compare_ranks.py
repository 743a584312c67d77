"""Processor time of a bin of apples on plain LAMMPS, and of the same deck followed by windfall.

    compare_ranks.py WINDFALL COUNT FOLDER END_S

Peak forces and impact speeds of all runs are compared by quantiles, with standard errors from a
bootstrap that draws whole fruit.
"""

import csv
import os
import re
import resource
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
from scene_bin_toml import write_scene

LEAST, DRAWS, QUANTILES = 1.0, 200, (0.25, 0.5, 0.75, 0.9, 0.95, 0.99)
windfall, count, folder, end = sys.argv[1], int(sys.argv[2]), Path(sys.argv[3]), sys.argv[4]
lammps = os.environ.get("LAMMPS", "lmp")
folder.mkdir(parents=True, exist_ok=True)
write_scene(folder / "scene.toml", count, end)


def timed(command, directory=folder):
    """Processor time of a command and of all that it starts, its elapsed time, and its memory."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    begun = time.perf_counter()
    done = subprocess.run(
        [str(word) for word in command], cwd=directory, capture_output=True, text=True
    )
    if done.returncode:
        sys.exit(f"{command}: {done.stderr}{done.stdout}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
    return spent, time.perf_counter() - begun


def pulses(name):
    """Rows of fruit, peak force and impact speed."""
    with open(folder / name / "events.csv") as file:
        rows = [
            (int(row["fruit"]), float(row["peak_force_N"]), float(row["normal_speed_m_s"]))
            for row in csv.DictReader(file)
        ]
    return np.array([row for row in rows if row[1] >= LEAST])


def by_fruit(rows, column):
    order = np.argsort(rows[:, 0], kind="stable")
    _, start = np.unique(rows[order, 0], return_index=True)
    return np.split(rows[order, column], start[1:])


def drawn(parts, draw):
    return np.concatenate([parts[n] for n in draw.integers(0, len(parts), len(parts))])


timed([windfall, "scene", "export", "scene.toml", "--engine", "lammps", "--out", "plain"])
deck = (folder / "plain/in.scene").read_text()
steps = re.search(r"^dump frames all custom (\d+) .*$", deck, re.M)
(folder / "plain/in.plain").write_text(deck.replace(steps.group(0) + "\n", ""))
print(f"{count} fruit, {end} s, a frame every {steps.group(1)} steps", flush=True)
plain, elapsed = timed([lammps, "-in", "in.plain", "-log", "none"], folder / "plain")
print(f"plain LAMMPS: {plain:.1f} s of processor time, {elapsed:.1f} s elapsed", flush=True)
engine = ["--engine", "lammps", "--engine-program", lammps, "--threads", "1"]
runs = {
    "own": ["--threads", "1"],
    "1 rank": engine,
    "2 ranks": engine + ["--ranks", "2"],
    "4 ranks": engine + ["--ranks", "4"],
    "frames": engine + ["--engine-frames"],
}
tables = {}
for name, arguments in runs.items():
    command = [windfall, "scene", "run", "scene.toml", "--out", name.replace(" ", "-")]
    spent, elapsed = timed(command + arguments)
    tables[name] = pulses(name.replace(" ", "-"))
    print(
        f"{name}: {spent:.1f} s of processor time, {spent / plain:.2f} times plain LAMMPS, "
        f"{elapsed:.1f} s elapsed, {len(tables[name])} pulses above {LEAST} N",
        flush=True,
    )
draw = np.random.default_rng(1)
for column, title in ((1, "peak force (N)"), (2, "impact speed (m/s)")):
    own = by_fruit(tables["own"], column)
    flat = np.concatenate(own)
    values = np.quantile(flat, QUANTILES)
    print(f"{title}: windfall's own engine " + " ".join(f"{value:.4f}" for value in values))
    for name in list(runs)[1:]:
        peer = by_fruit(tables[name], column)
        other = np.concatenate(peer)
        changes = np.quantile(other, QUANTILES) - values
        boots = [
            np.quantile(drawn(peer, draw), QUANTILES) - np.quantile(drawn(own, draw), QUANTILES)
            for _ in range(DRAWS)
        ]
        parts = changes / np.std(boots, axis=0)
        print(f"  {name}: differences in standard errors " + " ".join(f"{x:+.2f}" for x in parts))
