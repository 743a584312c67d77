"""Joint fits of the impacts on a fruit by SciPy against those of windfall; called by check-joint.

SciPy gets the samples and weights of `windfall fit --detail` and fits all impacts on a fruit at
once: one k and c, and a velocity, a first touch and an offset of the displacement for each impact.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import fault_impacts
import numpy as np
from scipy.optimize import least_squares

# Differences allowed: of a parameter in its deviations, and of the deviations.
TOLERANCE, OF_DEVIATION = 0.05, 0.02
OWN = ["initial_velocity", "onset", "displacement_offset"]


class Impact:
    """Samples and weights of one impact, as windfall fitted them."""

    def __init__(self, path):
        data = json.loads(path.read_text())
        self.specimen = data["attrs"]["specimen"]
        self.channels = {}
        for name in ("displacement", "force"):
            times = np.array(data["coords"][f"{name}_time"])
            values = np.array(data["observed_data"][name])
            roots = np.sqrt(np.array(data["constant_data"][f"{name}_weight"]))
            self.channels[name] = (times, values, roots)
        constant, names = data["constant_data"], data["coords"]["parameter"]
        self.estimate = dict(zip(names, constant["estimate"], strict=True))
        self.sd = dict(zip(names, constant["sd"], strict=True))

    def residuals(self, k, c, velocity, onset, offset):
        at, _ = fault_impacts.motion(k, c, velocity)
        rows = []
        for name, (times, values, roots) in self.channels.items():
            x, force = at(times - onset)
            model = x + offset if name == "displacement" else force
            rows.append(roots * (model - values))
        return np.concatenate(rows)


def joint(impacts):
    """k, c and their deviations; parameters are counted in deviations of single fits."""
    first = impacts[0]
    starts = [first.estimate["k"], first.estimate["c"]] + [own.estimate[name] for own in impacts for name in OWN]
    scales = [first.sd["k"], first.sd["c"]] + [own.sd[name] for own in impacts for name in OWN]
    starts, scales = np.array(starts), np.array(scales)

    def residuals(u):
        p = starts + scales * u
        parts = [own.residuals(*p[:2], *p[2 + 3 * i : 5 + 3 * i]) for i, own in enumerate(impacts)]
        return np.concatenate(parts)

    found = least_squares(residuals, np.zeros(starts.size), "3-point", diff_step=1e-3, xtol=1e-10, ftol=1e-12)
    covariance = np.linalg.inv(found.jac.T @ found.jac)
    return (starts + scales * found.x)[:2], (scales * np.sqrt(np.diag(covariance)))[:2]


def main():
    program = str(Path(sys.argv[1]).resolve())
    failed = False
    simulate = [
        "simulate", "pendulum", "--law", "kuwabara-kono(k=753599, c=1524)", "--spread", "k=130000", "--spread", "c=260",
        "--inertia", f"{fault_impacts.INERTIA} kg m^2", "--arm", f"{fault_impacts.ARM} m",
        "--mass", f"{fault_impacts.MASS} kg", "--centre-of-mass", f"{fault_impacts.CENTRE} m",
        "--velocity", "0.388 m/s", "--encoder", "counts", "--counts-per-revolution", "3600000", "--specimens", "4", "--repeats", "3", "--seed", "5", "--recordings", "campaign",
    ]  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        for line in (simulate, ["fit", "campaign", "--detail", "fits"]):
            subprocess.run([program, *line], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        fit = [program, "fit", "campaign", "--joint", "--format", "json"]
        told = json.loads(subprocess.run(fit, cwd=folder, check=True, capture_output=True, text=True).stdout)
        impacts = [Impact(path) for path in sorted(Path(folder, "fits").glob("*.json"))]
    assert told["joint"], "nothing was fitted jointly"
    print("specimen, parameter: windfall, SciPy; difference in deviations, ratio of deviations")
    for own in told["joint"]:
        values, deviations = joint([each for each in impacts if each.specimen == own["specimen"]])
        for name, value, sd in zip(("k", "c"), values, deviations, strict=True):
            found = own["parameters"][name]
            apart, ratio = (found["value"] - value) / sd, found["sd"] / sd
            good = abs(apart) <= TOLERANCE and abs(ratio - 1) <= OF_DEVIATION
            failed |= not good
            ending = "" if good else "  TOO LARGE"
            print(f"{own['specimen']}, {name}: {found['value']:.7g}, {value:.7g}; {apart:+.4f}, {ratio:.4f}{ending}")
    sys.exit(failed)


if __name__ == "__main__":
    main()
