"""Looks for contacts in recordings of others and prints them beside a hand count."""

import argparse
import csv
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import real_figure

HERE = pathlib.Path(__file__).resolve().parent
SHARED = "shared data"
QUANTITY = {"position": "displacement"}
SECONDS = 120

# Findings about the fit, which every recording of others carries.
ROUTINE = {
    "correlated",
    "freed",
    "misfit",
    "structured-residuals",
    "weak-direction",
    "window-from-motion",
    "contact",
}

CAMPAIGN = """format = 1
[rig]
kind = "carriage"
mass = "1 kg"
driving_acceleration = "0 m/s^2"
[files]
directory = "raw"
{times}
[channels.{quantity}]
column = {column}
unit = {unit}
[fit]
laws = ["{law}"]
quantities = ["{fitted}"]
"""


def source(row, repositories):
    """The repository of a row: a work tree or a bare mirror, however it is nested."""
    owner, name = row["source"].split("/")
    for folder in (f"{owner}+{name}", f"{owner}/{name}", name):
        for place in (folder, f"{folder}/repo", f"{folder}.git"):
            here = repositories / place
            if (here / ".git").exists() or (here / "objects").is_dir():
                return here
    return None


def contents(row, repositories, shared):
    """The bytes of a recording, or why there are none."""
    if row["source"] == SHARED:
        file = shared / row["path"] if shared else None
        if file is None:
            return None, "no WINDFALL_DATA"
        return (file.read_bytes(), None) if file.is_file() else (None, "no such file")
    if repositories is None:
        return None, "no WINDFALL_RECORDINGS"
    repository = source(row, repositories)
    if repository is None:
        return None, "no such repository"
    git = ["git", "-C", str(repository), "show", f"{row['commit']}:{row['path']}"]
    shown = subprocess.run(git, capture_output=True)
    return (shown.stdout, None) if shown.returncode == 0 else (None, "not in the repository")


def campaign(row, law):
    times = ""
    if row["time"]:
        name, _, unit = row["time"].rpartition(":") if row["time"].endswith(":ms") else (row["time"], "", "s")
        times = f"time = {json.dumps(name)}\ntime_unit = {json.dumps(unit)}"
    elif row["rate"]:
        times = f"rate = {json.dumps(row['rate'])}"
    return CAMPAIGN.format(
        times=times,
        quantity=row["quantity"],
        column=json.dumps(row["channel"]),
        unit=json.dumps(row["unit"]),
        law=law,
        fitted=QUANTITY.get(row["quantity"], row["quantity"]),
    )


def evaluate(program, row, data, folder, law):
    """Fits one recording with windfall's defaults: its impact or why there is none."""
    file = folder / "raw" / ("recording" + pathlib.Path(row["path"]).suffix)
    file.parent.mkdir(parents=True)
    file.write_bytes(data)
    (folder / "campaign.toml").write_text(campaign(row, law))
    (folder / "impacts.csv").write_text(f"id,specimen,file\n{row['name']},{row['name']},{file.name}\n")
    command = [program, "fit", str(folder), "--format", "json", "--threads", "1"]
    try:
        ran = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS)
    except subprocess.TimeoutExpired:
        return None, f"no answer within {SECONDS} s"
    if ran.returncode not in (0, 1) or "panicked" in ran.stderr:
        return None, f"exit {ran.returncode}: {ran.stderr.strip()}"
    answer = json.loads(ran.stdout) if ran.stdout.strip() else {}
    for impact in answer.get("impacts", []):
        return impact, None
    for failed in answer.get("failed", []):
        return failed, failed["message"]
    return None, ran.stderr.strip()


def onsets(impact, reason):
    """The contacts that windfall names and how many there are; None where it says neither."""
    findings = (impact or {}).get("findings", [])
    if reason and not findings:
        return ([], 0) if "no contact" in reason else (None, None)
    for finding in findings:
        if finding["code"] == "several-contacts":
            named = re.search(r"beginning at (.*?)(?: and \d+ more)? s;", finding["message"]).group(1)
            number = int(re.match(r"\d+", finding["message"]).group())
            return [float(onset) for onset in named.split(", ")], number
    if reason:
        contact = next(own["message"] for own in findings if own["code"] == "contact")
        return [float(re.search(r"from (\S+) s", contact).group(1))], 1
    return [impact["nuisances"]["onset"]["value"]], 1


def agreeing(hand, found, within):
    """How many contacts counted by hand have one of windfall's beside them."""
    left, agree = list(found), 0
    for time in hand:
        near = [other for other in left if abs(other - time) <= within]
        if near:
            left.remove(min(near, key=lambda other: abs(other - time)))
            agree += 1
    return agree


def short(text):
    """The first clause of a message, for a cell of a table."""
    text = re.sub(r"^\S+: ", "", text.splitlines()[0] if text else "")
    text = re.split(r"[;.] ", text)[0]
    return (text if len(text) < 150 else text[:147] + "…").replace("|", "/")


def main():
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("program")
    asked.add_argument("--only", help="names that contain this")
    asked.add_argument("--keep", type=pathlib.Path, help="keep the campaigns in this folder")
    asked.add_argument("--law", default="kelvin-voigt", help="law to fit")
    asked.add_argument("--figure", type=pathlib.Path, help="draw the recordings into this SVG")
    asked = asked.parse_args()
    environment = {name: os.environ.get(name) for name in ("WINDFALL_RECORDINGS", "WINDFALL_DATA")}
    repositories, shared = (pathlib.Path(p) if p else None for p in environment.values())
    with open(HERE / "real_recordings.csv", newline="", encoding="utf-8") as table:
        rows = [row for row in csv.DictReader(table) if (asked.only or "") in row["name"]]
    scratch = asked.keep or pathlib.Path(tempfile.mkdtemp(prefix="windfall-real-"))
    tally = dict.fromkeys(("missing", "made", "number", "right", "unsaid", "counting"), 0)
    panels = []
    print("| recording | by hand | windfall | at the same times | findings | counts |")
    print("|---|---|---|---|---|---|")
    for row in rows:
        data, why = contents(row, repositories, shared)
        if data is None:
            tally["missing"] += 1
            print(f"| {row['name']} | {row['contacts']} | not made: {why} | | | |")
            continue
        tally["made"] += 1
        folder = scratch / row["name"]
        shutil.rmtree(folder, ignore_errors=True)
        impact, reason = evaluate(asked.program, row, data, folder, asked.law)
        named, number = onsets(impact, reason)
        hand = [float(time) for time in row["begin"].split()]
        said = dict.fromkeys(f["code"] for f in (impact or {}).get("findings", []))
        codes = ", ".join(code for code in said if code not in ROUTINE)
        if reason:
            counts = f"not fitted: {short(reason)}"
        else:
            left = [f["code"] for f in impact["left_out"]]
            counts = "no: " + ", ".join(left) if left else "yes"
            tally["counting"] += not left
        if named is None:
            tally["unsaid"] += 1
            cells = "not said | "
        else:
            agree = agreeing(hand, named, float(row["within"] or 0))
            tally["number"] += len(hand) == number
            tally["right"] += agree == len(hand) == number
            part = f"{agree} of {len(hand)}" if hand else ""
            more = f", {len(named)} of {number} named" if number > len(named) else ""
            cells = f"{number} | {part}{more}".replace("| ,", "|")
        print(f"| {row['name']} | {row['contacts']} | {cells} | {codes} | {counts} |", flush=True)
        panels.append((row, folder / "raw", hand, named))
    print(
        f"\n{tally['made']} recordings of {len(rows)}: the number counted by hand in {tally['number']}, also at the "
        f"same times in {tally['right']}; another number in {tally['made'] - tally['number'] - tally['unsaid']}; "
        f"nothing said in {tally['unsaid']}. {tally['counting']} count. Not made: {tally['missing']}."
    )
    if asked.figure:
        asked.figure.write_text(real_figure.sheet(asked.program, panels), encoding="utf-8")
    if not asked.keep:
        shutil.rmtree(scratch)
    return 1 if tally["missing"] else 0


if __name__ == "__main__":
    sys.exit(main())
