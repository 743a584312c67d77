"""Fits campaigns with a fault and tells which results are wrong without a word."""

import argparse
import collections
import concurrent.futures
import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import fault_impacts
import fault_kinds
import numpy as np

# k is a catastrophe when it is off by more than this part of the truth; 1.
CATASTROPHE = 0.2

CAMPAIGN = """format = 1
[campaign]
title = "{title}"
simulated = "a bench of faults"
[rig]
kind = "pendulum"
inertia = "{inertia} kg m^2"
arm = "{arm} m"
mass = "{mass} kg"
centre_of_mass = "{centre} m"
[files]
directory = "raw"
{times}
[channels.force]
column = "force_V"
sensitivity = "{sensitivity:.9g} mV/N"
[channels.count]
column = "count"
[encoder]
counts_per_revolution = {counts}
[contact]
threshold = "{threshold}"
[fit]
laws = ["kuwabara-kono"]
[summary]
group = "variety"
"""


def write_campaign(folder, records, threshold, inertia=fault_impacts.INERTIA, ending="csv"):
    """The records of one fault and strength; those with times are a campaign of their own."""
    (folder / "raw").mkdir(parents=True)
    first = records[0][1]
    text = CAMPAIGN.format(
        title=folder.name,
        inertia=inertia,
        arm=fault_impacts.ARM,
        mass=fault_impacts.MASS,
        centre=fault_impacts.CENTRE,
        times='time = "time_s"' if first.timed else f'rate = "{fault_impacts.RATE:g} Hz"',
        sensitivity=1e3 * fault_impacts.SENSITIVITY / first.told_force,
        counts=int(fault_impacts.COUNTS * first.told_counts),
        threshold=threshold,
    )
    (folder / "campaign.toml").write_text(text)
    impacts, specimens = ["id,specimen,file"], ["id,variety"]
    for name, record in records:
        record.write(folder / "raw" / f"{name}.{ending}")
        impacts.append(f"{name},{name},{name}.{ending}")
        specimens.append(f"{name},one")
    (folder / "impacts.csv").write_text("\n".join(impacts) + "\n")
    (folder / "specimens.csv").write_text("\n".join(specimens) + "\n")


def fitted(program, folder):
    """What `windfall fit` says of each impact: None where it failed."""
    command = [program, "fit", str(folder), "--format", "json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    try:
        return json.loads(done.stdout)
    except json.JSONDecodeError:
        sys.exit(f"{' '.join(command)}\n{done.stderr}")


class Row:
    """Counts of one fault and strength."""

    def __init__(self):
        self.count = collections.Counter()

    def add(self, record, impact, fault):
        self.count["made"] += 1
        if impact is None:
            self.count["failed"] += 1
            return None
        self.count["fitted"] += 1
        out = {reason["code"] for reason in impact["left_out"]}
        codes = {finding["code"] for finding in impact["findings"]} | out
        k = impact["parameters"]["k"]
        off = k["value"] / record.k - 1
        self.count["taken out"] += bool(out)
        self.count["counted"] += not out
        verdict = None
        if abs(off) > CATASTROPHE and not out:
            self.count["catastrophes"] += 1
            verdict = "catastrophe"
        sd = k["sd"]
        if sd is None or not sd > 0 or abs(k["value"] - record.k) > 3 * sd:
            self.count["off"] += 1
            if out or codes & fault_kinds.NAMES[fault]:
                self.count["named"] += 1
            else:
                verdict = verdict or "unnamed"
        return verdict and (verdict, off, sd and sd / record.k, sorted(codes))


def one(task):
    """Makes and fits one fault at one strength."""
    program, scratch, maker, fault, strength, records, options = task
    row, told = Row(), []
    batches = collections.defaultdict(list)
    for number, record in enumerate(records):
        kind = list(fault_kinds.FAULTS).index(fault)
        rng = np.random.default_rng((options.seed, kind, strength, number))
        made = fault_kinds.FAULTS[fault](record.copy(), strength, rng)
        batches[made.timed].append((f"i{number:03d}", made))
    for timed, batch in batches.items():
        name = f"{maker}-{fault.replace(' ', '-')}-{strength + 1}{'-timed' if timed else ''}"
        folder = pathlib.Path(scratch) / name
        write_campaign(folder, batch, options.threshold)
        outcome = fitted(program, folder)
        found = {impact["id"]: impact for impact in outcome["impacts"]}
        why = {failure["id"]: failure for failure in outcome["failed"]}
        for identity, record in batch:
            verdict = row.add(record, found.get(identity), fault)
            if verdict:
                told.append((name, identity, *verdict))
            elif identity in why and options.list_failed:
                told.append((name, identity, "failed", 0, 0, [why[identity].get("message", "")]))
        if options.keep:
            with open(folder / "true.csv", "w", newline="") as file:
                table = csv.writer(file)
                table.writerow(["id", "k", "velocity"])
                table.writerows([i, r.k, r.velocity] for i, r in batch)
        else:
            shutil.rmtree(folder)
    return row, told


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--impacts", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--makers", default="own,windfall,other")
    parser.add_argument("--rig", default=os.environ.get("WINDFALL_RIG", "../shared/independent/rig.py"))
    parser.add_argument("--faults", default=",".join(fault_kinds.FAULTS))
    parser.add_argument("--threshold", default="1 N")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--list-failed", action="store_true")
    parser.add_argument("--keep")
    parser.add_argument("--csv")
    parser.add_argument("--processes", type=int, default=os.cpu_count())
    return parser.parse_args()


def makers(options):
    """Maker by name, with what it needs."""
    known = {
        "own": (fault_impacts.own, None),
        "windfall": (fault_impacts.windfall, options.program),
        "other": (fault_impacts.other, options.rig),
    }
    chosen = options.makers.split(",")
    if "other" in chosen and not pathlib.Path(options.rig).is_file():
        print(f"there is no {options.rig}: the simulator of another hand is left out", file=sys.stderr)
        chosen.remove("other")
    return {name: known[name] for name in chosen}


COLUMNS = ("made", "fitted", "failed", "taken out", "counted", "catastrophes", "off", "named")


def print_table(rows):
    """A Markdown table by fault and strength, and what it amounts to."""
    print("| fault | strength | made | fitted | failed | taken out | counted | catastrophes | off by 3 sd | of those named |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    total = collections.Counter()
    for (fault, strength), row in rows.items():
        print(f"| {fault} | {strength + 1} | " + " | ".join(str(row[c]) for c in COLUMNS) + " |")
        total.update(row)
    print("| all | | " + " | ".join(str(total[c]) for c in COLUMNS) + " |")
    sound = collections.Counter()
    for (fault, _), row in rows.items():
        if fault == "clean":
            sound.update(row)
    print()
    print(f"catastrophes: {total['catastrophes']} of {total['made']}")
    if total["off"]:
        share = 100 * total["named"] / total["off"]
        print(f"off by more than three deviations: {total['off']}, with a finding that says why: {share:.1f} %")
    if sound["made"]:
        lost = sound["failed"] + sound["taken out"]
        print(f"clean impacts taken out or failed: {lost} of {sound['made']} ({100 * lost / sound['made']:.2f} %)")
    return total


def main():
    options = arguments()
    faults = options.faults.split(",")
    rows = {(fault, s): collections.Counter() for fault in faults for s in range(4)}
    listed = []
    scratch = options.keep or tempfile.mkdtemp(prefix="faults-")
    try:
        for name, (maker, needs) in makers(options).items():
            records = list(maker(4 * options.impacts, options.seed, needs))
            tasks = [
                (options.program, scratch, name, fault, s, records[s :: 4], options) for fault, s in rows
            ]
            with concurrent.futures.ProcessPoolExecutor(options.processes) as pool:
                for task, (row, told) in zip(tasks, pool.map(one, tasks), strict=True):
                    rows[task[3], task[4]].update(row.count)
                    listed += told
    finally:
        if not options.keep:
            shutil.rmtree(scratch, ignore_errors=True)
    total = print_table(rows)
    if options.csv:
        with open(options.csv, "w", newline="") as file:
            table = csv.writer(file)
            table.writerow(["fault", "strength", *COLUMNS])
            table.writerows([f, s + 1, *(row[c] for c in COLUMNS)] for (f, s), row in rows.items())
    if options.list or options.list_failed:
        for name, identity, verdict, off, sd, codes in listed:
            print(f"{verdict}: {name} {identity}: k {100 * off:+.1f} %, sd {100 * (sd or np.nan):.2f} %: {', '.join(codes)}")
    sys.exit(total["catastrophes"] > 0)


if __name__ == "__main__":
    main()
