"""The same bin of apples on windfall, LAMMPS and LIGGGHTS, each by `windfall scene run`.

    compare_engines.py WINDFALL COUNT FOLDER [END_S]

Writes FOLDER/scene.toml (COUNT fruit on a lattice above the floor of an open bin), runs it on the
three engines and prints the bed's height, contacts per fruit, and quantiles of peak force and
impact speed with their differences over the standard error of the difference. Contacts of one
fruit hang together, so the errors are those of a bootstrap that draws whole fruit. The
Kolmogorov-Smirnov distance is compared with distances between halves of the fruit drawn at
random from both runs together.
"""

import csv
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
from scene_bin_toml import write_scene

LEAST, DRAWS, QUANTILES = 1.0, 400, (0.25, 0.5, 0.75, 0.9, 0.95, 0.99)
windfall, count, folder = sys.argv[1], int(sys.argv[2]), Path(sys.argv[3])
end = sys.argv[4] if len(sys.argv) > 4 else "0.4"
folder.mkdir(parents=True, exist_ok=True)
write_scene(folder / "scene.toml", count, end)


def run(engine):
    """Table of contacts (fruit, peak force, impact speed), mean height, contacts per fruit."""
    out = folder / engine
    done = out / "scene.json"
    if not done.exists():
        command = [windfall, "scene", "run", folder / "scene.toml", "--engine", engine, "--out", out]
        subprocess.run([str(word) for word in command], check=True, stdout=subprocess.DEVNULL)
    outcome = json.loads(done.read_text())
    rows, lasting = [], 0
    with open(out / "events.csv") as file:
        for row in csv.DictReader(file):
            peak = float(row["peak_force_N"])
            if row["lasting"] == "true":
                lasting += 2 if row["partner"] == "fruit" else 0
            if peak >= LEAST:
                rows.append((int(row["fruit"]) - 1, peak, float(row["normal_speed_m_s"])))
    with open(out / "fruit.csv") as file:
        heights = [float(row["z_m"]) for row in csv.DictReader(file)]
    print(
        f"{outcome['engine']}: {outcome['contacts']} contacts, account closes to "
        f"{100 * outcome['energy_closure']:.3f} %, mean height {np.mean(heights):.5f} m, "
        f"contacts with fruit {lasting / count:.3f} per fruit",
        flush=True,
    )
    return np.array(rows)


def distance(a, b):
    """Kolmogorov-Smirnov distance of two samples."""
    both = np.sort(np.concatenate([a, b]))
    below = [np.searchsorted(np.sort(own), both, side="right") / len(own) for own in (a, b)]
    return np.abs(below[0] - below[1]).max()


def by_fruit(rows, column):
    order = np.argsort(rows[:, 0], kind="stable")
    fruit, start = np.unique(rows[order, 0], return_index=True)
    return np.split(rows[order, column], start[1:])


def drawn(parts, draw):
    return np.concatenate([parts[n] for n in draw.integers(0, len(parts), len(parts))])


tables = {engine: run(engine) for engine in ("windfall", "lammps", "liggghts")}
draw = np.random.default_rng(1)
for column, name in ((1, "peak force (N)"), (2, "impact speed (m/s)")):
    own = by_fruit(tables["windfall"], column)
    flat = np.concatenate(own)
    print(f"{name}: windfall {len(flat)} contacts above {LEAST} N")
    for engine in ("lammps", "liggghts"):
        peer = by_fruit(tables[engine], column)
        other = np.concatenate(peer)
        differences = np.quantile(other, QUANTILES) - np.quantile(flat, QUANTILES)
        boots = [
            np.quantile(drawn(peer, draw), QUANTILES) - np.quantile(drawn(own, draw), QUANTILES)
            for _ in range(DRAWS)
        ]
        errors = np.std(boots, axis=0)
        print(f"  {engine} ({len(other)} contacts)")
        for q, value, change, error in zip(
            QUANTILES, np.quantile(flat, QUANTILES), differences, errors
        ):
            print(
                f"    {100 * q:4.0f} %: {value:8.4f} {change:+8.4f} ({100 * change / value:+6.2f} %), "
                f"standard error {error:.4f}, {change / error:+5.2f} of them"
            )
        found = distance(flat, other)
        pool = own + peer
        halves = []
        for _ in range(DRAWS // 4):
            order = draw.permutation(len(pool))
            first = np.concatenate([pool[n] for n in order[: len(own)]])
            second = np.concatenate([pool[n] for n in order[len(own) :]])
            halves.append(distance(first, second))
        larger = np.mean(np.array(halves) >= found)
        print(f"    Kolmogorov-Smirnov distance {found:.4f}; {100 * larger:.0f} % of random halves are farther apart")
