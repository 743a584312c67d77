"""The same simulated recordings fitted with lmfit and with windfall: a table of both.

compare_lmfit.py RECORDINGS SEED…   (from bench/compare-lmfit)
"""

import ast
import csv
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import fault_impacts
import numpy as np
import windfall as wf
from scipy.signal import lfilter

RATE = 100e3
BENCH = Path(__file__).resolve().parent
# Counts of the encoder per revolution, noise of the force (N), its persistence from sample to sample.
INSTRUMENTS = {
    "fine encoder, white noise": (360_000, 1.0, 0.0),
    "fine encoder, noise that persists": (360_000, 1.0, 0.8),
    "coarse encoder": (20_000, 0.3, 0.0),
}
TOOLS = {"SciPy + lmfit": ("lmfit_fit.py",), "windfall": ("windfall_fit.py", "1")}


def record(folder, name, instrument, rng):
    """Writes one recording of a pendulum, by SciPy; its k and c."""
    counts, sd, persistence = instrument
    k, c, velocity = fault_impacts.drawn(rng)
    at, _ = fault_impacts.motion(k, c, velocity)
    start = -fault_impacts.BEFORE - rng.uniform() / RATE
    t = start + np.arange(int((fault_impacts.BEFORE + fault_impacts.AFTER) * RATE)) / RATE
    x, force = at(t)
    noise = rng.normal(0, sd * np.sqrt(1 - persistence**2), t.size + 200)
    force = force + lfilter([1], [1, -persistence], noise)[200:]
    length = 2 * np.pi * fault_impacts.ARM / counts
    counted = np.floor(x / length + rng.uniform()) * length
    np.savez(folder / f"{name}.npz", t=t - start, x=counted, force=force, counts=counts)
    return k, c


def run(script, *words):
    """Processor time of a script, with its start and the reading of the recordings."""
    child = subprocess.Popen([sys.executable, BENCH / script, *words])
    _, status, usage = os.wait4(child.pid, 0)
    if status != 0:
        raise SystemExit(f"{script} failed")
    return usage.ru_utime + usage.ru_stime


def lines(script):
    """Lines of code: without blank ones, comments and docstrings."""
    text = (BENCH / script).read_text()
    first = ast.parse(text).body[0].end_lineno
    return sum(bool(line.strip()) and not line.strip().startswith("#") for line in text.splitlines()[first:])


def judged(path, truth):
    """Recordings without a result; for k and c the share of intervals that hold the truth, and the
    mean of the relative error, its standard error, the median of its size, its root mean square
    and its largest."""
    with open(path, newline="") as file:
        rows = {row["id"]: {key: float(row[key]) for key in row if key != "id"} for row in csv.DictReader(file)}
    found = []
    for place, name in enumerate("kc"):
        held = [row[f"{name}_low"] <= truth[own][place] <= row[f"{name}_high"] for own, row in rows.items()]
        errors = np.array([row[name] / truth[own][place] - 1 for own, row in rows.items()])
        error = errors.std(ddof=1) / np.sqrt(len(errors))
        sizes = np.abs(errors)
        spread = (np.median(sizes), np.sqrt(np.mean(errors**2)), sizes.max())
        found.append((np.mean(held), errors.mean(), error, *spread))
    return len(truth) - len(rows), found


def compare(count, seed, name, folder):
    """Two rows of the table."""
    rng = np.random.default_rng((seed, list(INSTRUMENTS).index(name)))
    truth = {f"{n:04}": record(folder, f"{n:04}", INSTRUMENTS[name], rng) for n in range(count)}
    for tool, (script, *words) in TOOLS.items():
        table = folder / f"{script}.csv"
        processor = run(script, folder, table, *words)
        missing, found = judged(table, truth)
        cells = [
            f"{held:.1%} | {bias:+.2%} ± {error:.2%} | {middle:.2%} | {rms:.2%} | {most:.1%}"
            for held, bias, error, middle, rms, most in found
        ]
        print(f"| {name} | {seed} | {tool} | {processor:.2f} s | {' | '.join(cells)} | {missing} |", flush=True)
    return [fit_many(folder, threads) for threads in (1, 2)]


def fit_many(folder, threads):
    """Seconds of `windfall.fit_many` alone, without start and reading; the median of five calls."""
    recordings = [
        {name: data[name] for name in ("t", "x", "force")}
        for data in map(np.load, sorted(folder.glob("*.npz")))
    ]
    rig = wf.Pendulum(
        inertia=fault_impacts.INERTIA,
        arm=fault_impacts.ARM,
        mass=fault_impacts.MASS,
        centre_of_mass=fault_impacts.CENTRE,
    )
    seconds = []
    for _ in range(5):
        begun = time.perf_counter()
        wf.fit_many(recordings, rig=rig, law="kuwabara-kono", threads=threads)
        seconds.append(time.perf_counter() - begun)
    return np.median(seconds)


def main(count, *seeds):
    for tool, (script, *_) in TOOLS.items():
        print(f"{tool}: {lines(script)} lines of code")
    judgement = "coverage | bias | median error | RMS | largest"
    print(f"\n| instruments | seed | tool | processor time | k: {judgement} | c: {judgement} | left out |")
    print("|---" * 15 + "|")
    elapsed = []
    for name in INSTRUMENTS:
        for seed in seeds:
            with tempfile.TemporaryDirectory() as folder:
                elapsed.append(compare(count, seed, name, Path(folder)))
    one, two = np.median(elapsed, axis=0)
    print(f"\nwindfall.fit_many alone: {one:.3f} s on one thread, {two:.3f} s on two (median)")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
