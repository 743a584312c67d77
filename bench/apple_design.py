"""Simulated impacts in the design of an apple study, and two models fitted to them.

    python3 bench/apple_design.py data 1 > apples.csv      # one data set, of seed 1
    python3 bench/apple_design.py coverage --windfall target/release/windfall
    python3 bench/apple_design.py selection --windfall target/release/windfall

The design (Barikloo and Ahmadi 2013): 20 fruit struck on one spot at 0.1, 0.2, 0.27 and
0.34 m/s, 10 others once at 0.5 m/s, 10 others once at 0.7 m/s; 40 fruit, 100 impacts.
The means are that study's regression for Golden Delicious; each fruit adds a number of its
own, each impact another. Acoustic stiffness S has no effect.

`coverage` fits the model without and with the fruit to 1000 data sets, for several shares of
the fruit in the variance, and counts the 95 % intervals that hold the true value.
`selection` does the study's backward elimination on them, and counts what is left.
They need nothing but Python 3.8 and windfall, and take a minute or two. See
docs/guide/src/compared/apple_study.md.
"""

import argparse
import csv
import json
import os
import random
import subprocess
import sys
import tempfile
from statistics import NormalDist, mean, stdev

# Golden Delicious, Table 3 of the study: V in m/s, R in m, t in s, k in N/m^1.5.
INTERCEPT, BY_V, BY_R, BY_T, BY_VR = 662728.094, -328492.591, 216226.530, 4.058e7, 434154.296
SCATTER = 10000.0  # standard deviation about the regression, N/m^1.5: gives its R² of 0.98
# V and R are centred in their product, so V is the effect at R = 0.05 m and R the effect at
# V = 0.3 m/s, the means of the design.
PRODUCT = "I((V - 0.3) * (R - 0.05))"
TERMS = f"V + R + t + {PRODUCT} + S"
TRUE = [BY_V + 0.05 * BY_VR, BY_R + 0.3 * BY_VR, BY_T, BY_VR, 0.0]
NAMES = ["V", "R", "t", "V:R", "S"]
COLUMNS = ["fruit", "V", "R", "t", "S", "k"]


def fruit_velocities():
    """Velocities at which each of the 40 fruit is struck, m/s."""
    return [[0.1, 0.2, 0.27, 0.34]] * 20 + [[0.5]] * 10 + [[0.7]] * 10


def data_set(seed, share, fruit_count=40):
    """Rows of one data set; `share` is the fruit's share of the variance around the means."""
    draw = random.Random(seed)

    def normal():
        return NormalDist().inv_cdf(draw.random() or 0.5)

    rows = []
    for fruit, velocities in enumerate(fruit_velocities()[:fruit_count], start=1):
        radius = round(draw.uniform(0.031, 0.070), 5)  # range in the study
        acoustic = round(draw.uniform(20.0, 28.0), 3)  # 10⁴ kg^(2/3)/s²
        own = share**0.5 * SCATTER * normal()
        slower = 1.0 + 0.05 * normal()
        for velocity in velocities:
            # Hertz: contacts shorten with V^(1/5); 5 to 9 ms, in the study 4 to 8.
            time = round(0.005 * velocity**-0.2 * slower * (1.0 + 0.03 * normal()), 7)
            expected = INTERCEPT + BY_V * velocity + BY_R * radius
            expected += BY_T * time + BY_VR * velocity * radius
            k = expected + own + (1.0 - share) ** 0.5 * SCATTER * normal()
            rows.append([f"f{fruit:02d}", velocity, radius, time, acoustic, round(k, 1)])
    return rows


def write(rows, stream):
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(COLUMNS)
    writer.writerows(rows)


def regress(windfall, table, *options):
    """Coefficients by `windfall regress`, in the order of NAMES."""
    command = [windfall, "regress", table, "--response", "k", "--terms", TERMS]
    command += ["--folds", "0", "--format", "json", *options]
    answer = subprocess.run(command, check=True, capture_output=True, text=True)
    terms = {row["term"]: row for row in json.loads(answer.stdout)["terms"]}
    product = next(name for name in terms if name.startswith("I("))
    return [terms[product if name == "V:R" else name] for name in NAMES]


def coverage(windfall, sets, shares, fruit_count):
    models = {"plain": [], "mixed": ["--random", "fruit"]}
    print("share  model  term   se/sd  mean df  coverage  p < 0.05")
    with tempfile.TemporaryDirectory() as folder:
        table = os.path.join(folder, "apples.csv")
        for share in shares:
            fits = {model: [] for model in models}
            for seed in range(1, sets + 1):
                with open(table, "w", encoding="utf-8") as stream:
                    write(data_set(seed, share, fruit_count), stream)
                for model, options in models.items():
                    fits[model].append(regress(windfall, table, *options))
            for at, name in enumerate(NAMES):
                for model in models:
                    print_line(share, model, name, TRUE[at], [fit[at] for fit in fits[model]])


def selection(windfall, sets, shares):
    """The terms that backward elimination keeps, of all terms and their pairs."""
    rules = {"no hierarchy": [], "hierarchy": ["--hierarchy"]}
    print("share  rule          a term with S  V gone  terms (mean)")
    with tempfile.TemporaryDirectory() as folder:
        table = os.path.join(folder, "apples.csv")
        for share in shares:
            left = {rule: [] for rule in rules}
            for seed in range(1, sets + 1):
                with open(table, "w", encoding="utf-8") as stream:
                    write(data_set(seed, share), stream)
                for rule, options in rules.items():
                    left[rule].append(eliminate(windfall, table, *options))
            for rule, terms in left.items():
                of_no_effect = mean(float(any("S" in term for term in kept)) for kept in terms)
                gone = mean(float("V" not in kept) for kept in terms)
                count = mean(len(kept) - 1 for kept in terms)
                row = f"{share:5.2f}  {rule:12}  {of_no_effect:13.3f}  {gone:7.3f}  {count:12.2f}"
                print(row, flush=True)


def eliminate(windfall, table, *options):
    """Names of the remaining terms, including the intercept."""
    command = [windfall, "regress", table, "--response", "k", "--terms", "(V + R + t + S)^2"]
    command += ["--select", "backward", "--p-remove", "0.05", "--folds", "0"]
    command += ["--format", "json", *options]
    answer = subprocess.run(command, check=True, capture_output=True, text=True)
    return [row["term"] for row in json.loads(answer.stdout)["terms"]]


def print_line(share, model, name, true, fits):
    """Prints the ratio of the RMS standard error to the scatter of the estimates, and counts."""
    error = mean(fit["se"] ** 2 for fit in fits) ** 0.5
    ratio = error / stdev(fit["estimate"] for fit in fits)
    freedom = mean(fit["df"] for fit in fits)
    inside = mean(float(fit["low"] <= true <= fit["high"]) for fit in fits)
    small = mean(float(fit["p"] < 0.05) for fit in fits)
    row = f"{share:5.2f}  {model}  {name:4}  {ratio:6.2f}  {freedom:7.1f}  {inside:8.3f}  {small:8.3f}"
    print(row, flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    tasks = parser.add_subparsers(dest="task", required=True)
    data = tasks.add_parser("data", help="write one data set to standard output")
    data.add_argument("seed", type=int)
    data.add_argument("--share", type=float, default=0.64)
    cover = tasks.add_parser("coverage", help="fit two models to many data sets")
    cover.add_argument("--fruit", type=int, default=40, help="20: those struck four times alone")
    select = tasks.add_parser("selection", help="backward elimination of many data sets")
    for task in (cover, select):
        task.add_argument("--windfall", default="windfall")
        task.add_argument("--sets", type=int, default=1000)
        task.add_argument("--shares", type=float, nargs="+", default=[0.0, 0.3, 0.64, 0.9])
    chosen = parser.parse_args()
    if chosen.task == "data":
        write(data_set(chosen.seed, chosen.share), sys.stdout)
    elif chosen.task == "selection":
        selection(chosen.windfall, chosen.sets, chosen.shares)
    else:
        coverage(chosen.windfall, chosen.sets, chosen.shares, chosen.fruit)


if __name__ == "__main__":
    main()
