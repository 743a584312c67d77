"""How often campaigns say that something depends on velocity or order."""

import argparse
import concurrent.futures
import importlib.util
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

RIG = pathlib.Path(os.environ.get("WINDFALL_RIG", "../shared/independent/rig.py"))

# Laws by the stiffness and damping of the fruit.
LAWS = {
    "as the law says": lambda rig, k, c: rig.kk(k, c),
    "exponent 1.8": lambda rig, k, c: rig.power(8.26 * k, 1.8, c, 0.5),
    "strong yield": lambda rig, k, c: rig.yielding(k, 0.5 * c, 0.0003, 0.5),
    "mild yield": lambda rig, k, c: rig.yielding(k, c, 0.0004, 0.8),
    "Hunt and Crossley": lambda rig, k, c: rig.hc(k, k),
    "Walton and Braun": lambda rig, k, c: rig.wb(0.02 * k, 0.053 * k),
    "k rises by 65 % along the campaign": lambda rig, k, c: rig.kk(k, c),
    "sensitivity rises by 5 % along the campaign": lambda rig, k, c: rig.kk(k, c),
}
# Logarithm by which stiffness and sensitivity rise from the first to the last impact.
STIFFER = {"k rises by 65 % along the campaign": 0.5}
LOUDER = {"sensitivity rises by 5 % along the campaign": 0.05}
# Impacts on each fruit, of 40.
DESIGNS = {"once": 1, "four times": 4}
# Logarithmic standard deviations: k and c between fruit, both between spots of one.
BETWEEN, WITHIN = (0.2, 0.3), 0.03
IMPACTS = 40
CODES = ["law-velocity-trend", "order-trend"]


def other_hand():
    if not RIG.is_file():
        sys.exit(f"there is no {RIG}: WINDFALL_RIG names the simulator of another hand")
    spec = importlib.util.spec_from_file_location("rig", RIG)
    rig = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(rig)
    return rig


def codes(program, seed, fruit, design):
    """Findings of one campaign."""
    rig = other_hand()
    kinds = (list(LAWS).index(fruit), list(DESIGNS).index(design))
    rng = np.random.default_rng((seed, *kinds))
    impacts, specimens = [], []
    with tempfile.TemporaryDirectory() as folder:
        os.makedirs(f"{folder}/raw")
        for number in range(IMPACTS):
            place = number / (IMPACTS - 1)
            if number % DESIGNS[design] == 0:
                between = rng.normal(size=2) * BETWEEN
                specimens.append({"id": f"s{len(specimens):02d}", "variety": "one"})
            spot = rng.normal(size=2) * WITHIN
            k = 753599 * np.exp(between[0] + spot[0] + STIFFER.get(fruit, 0) * place)
            c = 1524 * np.exp(between[1] + spot[1])
            law = LAWS[fruit](rig, k, c)
            at, _, _ = rig.integrate(law, rig.MEFF, rng.uniform(0.2, 0.5), 0.03, omega2=rig.OMEGA2, rtol=1e-9)
            name = f"i{number:02d}"
            sensitivity = 11e-3 * np.exp(LOUDER.get(fruit, 0) * place)
            rig.record_pendulum(f"{folder}/raw/{name}.csv", at, rng, sens=sensitivity)
            impacts.append({"id": name, "specimen": specimens[-1]["id"], "file": f"{name}.csv"})
        rig.campaign(folder, fruit, impacts, specimens)
        command = [program, "fit", folder, "--format", "json"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"{' '.join(command)}\n{done.stderr}")
    return {finding["code"] for finding in json.loads(done.stdout)["findings"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("--campaigns", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--fruit", default=",".join(LAWS))
    asked = parser.parse_args()
    heads = [f"{design}: {what}" for design in DESIGNS for what in [*CODES, "anything"]]
    print(f"{asked.campaigns} campaigns of {IMPACTS} impacts, seed {asked.seed}\n")
    print("| fruit | " + " | ".join(heads) + " |")
    print("|---" * (1 + len(heads)) + "|")
    with concurrent.futures.ProcessPoolExecutor(asked.jobs) as pool:
        for fruit in asked.fruit.split(","):
            cells = [fruit]
            for design in DESIGNS:
                seeds = range(1000 * asked.seed, 1000 * asked.seed + asked.campaigns)
                made = [pool.submit(codes, asked.program, seed, fruit, design) for seed in seeds]
                found = [each.result() for each in made]
                share = [np.mean([code in own for own in found]) for code in CODES]
                share.append(np.mean([bool(own) for own in found]))
                cells += [f"{100 * value:.0f} %" for value in share]
            print("| " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
