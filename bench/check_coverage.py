"""Coverage of the intervals of the bruised share: check_coverage.py WINDFALL FOLDER SEEDS THREADS."""

import concurrent.futures
import json
import pathlib
import shutil
import subprocess
import sys

import numpy as np
from scipy.stats import norm
from scipy.stats import t as student

windfall, folder = sys.argv[1], pathlib.Path(sys.argv[2])
seeds, threads = int(sys.argv[3]), int(sys.argv[4])
FRUIT = 60
LIMITS = [100, 300, 500]
CHANGES = [
    ('end = "4 s"', 'end = "3.2 s"'),
    ("count = 100", f"count = {FRUIT}"),
    ('frames = "20 ms"', 'frames = "1 s"'),
    ('time_step = "auto"', 'time_step = "100 us"'),
]
BRUISE = f"""
[bruise]
predictor = "absorbed energy"
threshold = "50 mJ"
susceptibility = "3000 mm^3/J"
limits = {[f"{limit} mm^3" for limit in LIMITS]}
"""

subprocess.run([windfall, "new", "scene", folder / "template"], check=True, stdout=subprocess.DEVNULL)
text = (folder / "template/scene.toml").read_text()
for old, new in CHANGES:
    assert old in text, old
    text = text.replace(old, new)
text += BRUISE


def run(seed):
    """Count of fruit above each limit, and the interval of its share."""
    own = folder / f"seed{seed}"
    own.mkdir()
    (own / "scene.toml").write_text(text.replace("seed = 1 ", f"seed = {seed} "))
    command = [windfall, "scene", "run", own / "scene.toml", "--threads", "1"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    limits = json.loads((own / "scene.run/scene.json").read_text())["bruise"]["limits"]
    shutil.rmtree(own)
    return [(round(limit["share"] * FRUIT), *limit["interval"]) for limit in limits]


with concurrent.futures.ThreadPoolExecutor(threads) as pool:
    found = np.array(list(pool.map(run, range(1, seeds + 1))))
counts, low, high = found[:, :, 0], found[:, :, 1], found[:, :, 2]
mean = counts.mean(axis=0) / FRUIT
print(f"{seeds} seeds, {FRUIT} fruit, largest bruise above {', '.join(map(str, LIMITS))} mm³")
print("mean share                            ", *(f"{own:8.3f}" for own in mean))
ratio = counts.var(axis=0, ddof=1) / (FRUIT * mean * (1 - mean))
print("variance over that of independent ones", *(f"{own:8.2f}" for own in ratio))
held = ((low <= mean) & (mean <= high)).mean(axis=0)
print("one run holds the mean share          ", *(f"{own:8.3f}" for own in held))

# The formula of the guide, by NumPy and SciPy, on counts that windfall did not see together.
scale = np.log((counts + 0.5) / (FRUIT - counts + 0.5))
generator = np.random.default_rng(1)
z = norm.ppf(0.975)
for replicates in (2, 3, 4, 8):
    if replicates >= seeds:
        continue
    held = np.zeros(len(LIMITS))
    draws = 4000
    for _ in range(draws):
        *own, other = generator.choice(seeds, replicates + 1, replace=False)
        centre = scale[own].mean(axis=0)
        share = ((FRUIT + 1) / (1 + np.exp(-centre)) + 0.5) / (FRUIT + 2)
        chance = 1 / ((FRUIT + 2) * share * (1 - share))
        seen = student.ppf(0.975, replicates - 1) ** 2 * scale[own].var(axis=0, ddof=1)
        half = np.sqrt(np.maximum(seen * (1 + 1 / replicates), z**2 * chance / replicates))
        ends = [1 / (1 + np.exp(-(centre + sign * half))) for sign in (-1, 1)]
        batch = counts[other] / FRUIT
        held += (ends[0] <= batch) & (batch <= ends[1])
    print(f"{replicates} replicates hold another batch      ", *(f"{own:8.3f}" for own in held / draws))
