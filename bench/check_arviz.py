"""R-hat and independent draws by ArviZ against those of windfall; called by check-arviz."""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import arviz
import numpy as np

# Relative differences allowed. Where the last correlation of Geyer's sequence stands alone, ArviZ
# counts it once and windfall twice, and its autocovariances are biased: docs/guide/src/results.md.
TOLERANCE = {"r_hat": 1e-12, "ess_bulk": 5e-2, "ess_tail": 5e-2}

program = str(Path(sys.argv[1]).resolve())
law = "kuwabara-kono(k=394931,c=681)"
failed = False
with tempfile.TemporaryDirectory() as folder:
    simulate = ["simulate", "pendulum", "--law", law, "--specimens", "6", "--repeats", "2", "--recordings", "campaign"]
    fit = ["fit", "campaign", "--intervals", "posterior", "--detail", "fits"]
    for line in (simulate, fit):
        subprocess.run([program, *line], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    worst = dict.fromkeys(TOLERANCE, 0.0)
    files = sorted(Path(folder, "fits").glob("*.json"))
    for file in files:
        data = arviz.from_json(str(file))
        found = {
            "r_hat": arviz.rhat(data),
            "ess_bulk": arviz.ess(data, method="bulk"),
            "ess_tail": arviz.ess(data, method="tail"),
        }
        for name, own in found.items():
            for parameter in data.constant_data.parameter.values:
                told = float(data.constant_data[name].sel(parameter=parameter))
                worst[name] = max(worst[name], abs(told / float(own[parameter]) - 1.0))
    assert files, "no file was written"
    population = ["population", "campaign", "--posterior", "--detail", "draws.json", "--format", "json"]
    told = subprocess.run([program, *population], cwd=folder, check=True, capture_output=True, text=True)
    r_hat = arviz.rhat(arviz.from_json(str(Path(folder, "draws.json"))))
    largest = max(float(r_hat[name].max()) for name in r_hat.data_vars)
    worst["r_hat"] = max(worst["r_hat"], abs(json.loads(told.stdout)["posterior"]["largest_r_hat"] / largest - 1.0))
    for name, difference in worst.items():
        good = bool(np.isfinite(difference)) and difference <= TOLERANCE[name]
        failed |= not good
        print(f"{name}: largest relative difference {difference:.2e}{'' if good else '  TOO LARGE'}")
sys.exit(failed)
