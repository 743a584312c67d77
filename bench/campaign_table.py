"""Table of bench/campaign; needs the standard library only.

    campaign_table.py PROGRAM [--recordings N] [--rounds N] [--in-python]
"""

import argparse
import csv
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
from statistics import median

# Processor time of windfall, seconds per thousand recordings.
TARGET = 1.2

# The same fit in Python; its result is not looked at.
IN_PYTHON = "import sys, windfall; windfall.Campaign(sys.argv[1]).fit(threads=1)"

LAW = "kuwabara-kono(k=394931, c=681)"
REPEATS = 10


def timed(words, out=os.devnull):
    """User and system seconds of a process."""
    with open(out, "w") as output:
        child = subprocess.Popen(words, stdout=output, stderr=subprocess.DEVNULL)
        _, status, used = os.wait4(child.pid, 0)
    if status:
        sys.exit(f"{words} failed")
    return used.ru_utime, used.ru_stime


def read_table(path):
    with open(path, newline="") as table:
        return list(csv.DictReader(table))


def parameters(law):
    """Values in a law such as "kuwabara-kono(k=394931, c=681)"."""
    return {name: float(value) for name, value in re.findall(r"(\w+)=([^,)]+)", law)}


def off(pairs):
    """Median relative distance."""
    return median(abs(found / true - 1) for found, true in pairs)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--recordings", type=int, default=1000)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--in-python", action="store_true")
    asked = parser.parse_args()
    script = str(pathlib.Path(__file__).with_name("campaign_fit.py"))
    with tempfile.TemporaryDirectory() as scratch:
        campaign = pathlib.Path(scratch, "campaign")

        def simulate(folder, specimens, repeats):
            words = ["--specimens", str(specimens), "--repeats", str(repeats), "--recordings", str(folder)]
            spread = ["--spread", "k=60000", "--spread", "c=130"]
            timed([asked.program, "simulate", "pendulum", "--law", LAW, *words, *spread])

        simulate(campaign, max(1, asked.recordings // REPEATS), REPEATS)
        few = pathlib.Path(scratch, "few")
        simulate(few, 2, 1)
        # Fills numba's cache.
        timed([sys.executable, script, str(few), os.path.join(scratch, "few.csv")])

        store, found, table = campaign / "results.sqlite", os.path.join(scratch, "w.json"), os.path.join(scratch, "s.csv")
        fit = [asked.program, "fit", str(campaign), "--threads", "1", "--format", "json"]
        rows = {"windfall, from text": [], "windfall, from its store": [], "NumPy, SciPy, numba": []}
        for _ in range(asked.rounds):
            store.unlink(missing_ok=True)
            rows["windfall, from text"].append(timed(fit, found))
            rows["windfall, from its store"].append(timed(fit))
            if asked.in_python:
                store.unlink()
                same = timed([sys.executable, "-c", IN_PYTHON, str(campaign)])
                rows.setdefault("windfall in Python", []).append(same)
                start = timed([sys.executable, "-c", "import numpy"])
                rows.setdefault("Python with NumPy, its start", []).append(start)
            rows["NumPy, SciPy, numba"].append(timed([sys.executable, script, str(campaign), table]))

        truth = {row["id"]: parameters(row["law"]) for row in read_table(campaign / "truth.csv")}
        ours = {row["id"]: row["parameters"] for row in json.loads(pathlib.Path(found).read_text())["impacts"]}
        theirs = {row["id"]: row for row in read_table(table)}
        count = len(ours)

    total = lambda own: [user + system for user, system in own]
    first = total(rows["windfall, from text"])
    print(f"\n{count} recordings, one core, median of {asked.rounds} rounds; seconds of processor time")
    print(f"{'':28}{'user':>8}{'system':>8}{'total':>8}{'per recording':>16}{'times windfall':>16}")
    for name, own in rows.items():
        user, system = (median(part) for part in zip(*own))
        times = median(mine / windfall for mine, windfall in zip(total(own), first))
        both = median(total(own))
        print(f"{name:28}{user:8.2f}{system:8.2f}{both:8.2f}{1e3 * both / count:13.2f} ms{times:16.2f}")
    print("\nmedian distance to the truth:          k         c")
    value = {"windfall": lambda id, name: ours[id][name]["value"], "script": lambda id, name: float(theirs[id][name])}
    for name, get in value.items():
        both = [off((get(id, p), truth[id][p]) for id in ours) for p in ("k", "c")]
        print(f"  {name:28}{100 * both[0]:9.2f} %{100 * both[1]:8.2f} %")
    reached = 1e3 * median(first) / count
    verdict = "met" if reached <= TARGET else "MISSED"
    print(f"\n{verdict}: {reached:.2f} s per thousand recordings (target {TARGET:g})")
    sys.exit(reached > TARGET)


main()
