"""Fits campaigns whose bench is not as told, and prints what that does.

Each motion is recorded by every bench. "named": campaigns whose finding names the fault;
"off" and "held": bias of k, and share of the 95 % intervals that hold the truth.
"""

import argparse
import concurrent.futures
import importlib.util
import os
import pathlib
import sys
import tempfile

import fault_impacts
import fault_table
import numpy as np
from scipy.signal import cont2discrete, lfilter

# Samples of the force for each that is recorded, where a sensor swings or a filter acts.
FINE = 10
DAMPED = np.sqrt(0.5)

# Name: what is told wrong, what the instrument does, the quantity to estimate and its true
# value, and the findings that name the fault.
RIGS = {
    "as told": ({}, {}, None, None, ()),
    "inertia 5 % too large": ({"inertia": 1.05}, {}, "inertia", fault_impacts.INERTIA, ("bench-gain",)),
    "sensitivity 5 % too small": ({}, {"gain": 1.05}, "force.gain", 1.05, ("bench-gain",)),
    "force 20 us late": ({}, {"delay": 20e-6}, "force.delay", 20e-6, ("bench-delay",)),
    "filter of 5 kHz": ({}, {"pole": (5e3, DAMPED)}, "force.delay", None, ("bench-delay",)),
    "resonance at 2 kHz": ({}, {"pole": (2e3, 0.05)}, "force.delay", None, ("bench-delay", "bench-gain")),
}

# Fruit of another law than is fitted, from the simulator of another hand.
LAWS = {
    "mild yield": lambda rig, k, c: rig.yielding(k, c, 0.0004, 0.8),
    "strong yield": lambda rig, k, c: rig.yielding(k, 0.5 * c, 0.0003, 0.5),
    "exponent 1.8": lambda rig, k, c: rig.power(8.26 * k, 1.8, c, 0.5),
    "Hunt and Crossley": lambda rig, k, c: rig.hc(k, k),
}
RIG = pathlib.Path(os.environ.get("WINDFALL_RIG", "../shared/independent/rig.py"))
if RIG.is_file():
    RIGS |= {name: ({}, {}, None, None, ("law-misfit",)) for name in LAWS}
else:
    print("not made: fruit of other laws, whose simulator is not there", file=sys.stderr)


def other_hand():
    spec = importlib.util.spec_from_file_location("rig", RIG)
    rig = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(rig)
    return rig


def motion_of(rig, law, k, c, velocity):
    """A motion under another law, as `fault_impacts.motion` gives one."""
    at, end, _ = rig.integrate(LAWS[law](rig, k, c), rig.MEFF, velocity, 0.05, omega2=rig.OMEGA2, rtol=1e-9)
    return (lambda times: at(times)[::2]), end

def second_order(force, interval, frequency, damping):
    """A sensor or filter with two poles."""
    w = 2 * np.pi * frequency
    b, a, _ = cont2discrete(([w * w], [1, 2 * damping * w, w * w]), interval, method="foh")
    return lfilter(np.ravel(b), a, force)


def recorded(motion, instrument, rng):
    """Force (N) and position (counts, with their fraction) of one motion."""
    k, c, velocity, at, end = motion
    interval = 1 / fault_impacts.RATE
    start = -fault_impacts.BEFORE - rng.uniform() * interval
    count = int((fault_impacts.BEFORE + end + fault_impacts.AFTER) / interval)
    times = start + np.arange(count) * interval
    x, force = at(times)
    if instrument.keys() & {"delay", "pole"}:
        fine = times[0] - instrument.get("delay", 0.0) + np.arange(count * FINE) * interval / FINE
        _, force = at(fine)
        if "pole" in instrument:
            force = second_order(force, interval / FINE, *instrument["pole"])
        force = force[::FINE]
    force = instrument.get("gain", 1.0) * force + fault_impacts.NOISE * rng.normal(size=count)
    position = np.arcsin(x / fault_impacts.ARM) * fault_impacts.COUNTS / (2 * np.pi)
    return force, position + rng.uniform(100, 104)


def write(folder, told, instrument, motions, rng):
    """Writes a campaign; gives what asks for an estimate in it."""
    made = [fault_impacts.Record(*recorded(motion, instrument, rng), motion[0], motion[2]) for motion in motions]
    records = [(f"i{index:03d}", record) for index, record in enumerate(made)]
    inertia = fault_impacts.INERTIA * told.get("inertia", 1.0)
    fault_table.write_campaign(folder, records, "1 N", inertia)
    path = folder / "campaign.toml"
    plain = path.read_text()
    return lambda quantity: path.write_text(plain.replace("[fit]\n", f'[fit]\nestimate = ["{quantity}"]\n'))


def compared(outcome, motions):
    """Relative errors of k and c, and whether the intervals hold them."""
    errors, held = [], []
    for impact in outcome["impacts"]:
        if impact["left_out"]:
            continue
        motion = motions[int(impact["id"][1:])]
        for name, truth in (("k", motion[0]), ("c", motion[1])):
            own = impact["parameters"][name]
            errors.append(own["value"] / truth - 1)
            held.append(own["low"] <= truth <= own["high"])
    return np.reshape(errors, (-1, 2)), np.reshape(held, (-1, 2))


def campaign(program, seed, index, impacts, rigs):
    rng = np.random.default_rng((seed, index))
    motions = []
    for _ in range(impacts):
        k, c, velocity = fault_impacts.drawn(rng)
        motions.append((k, c, velocity, *fault_impacts.motion(k, c, velocity)))
    results = {}
    with tempfile.TemporaryDirectory() as scratch:
        for name in rigs:
            told, instrument, quantity, truth, codes = RIGS[name]
            folder = pathlib.Path(scratch) / name.replace(" ", "-").replace("%", "percent")
            made = motions
            if name in LAWS:
                made = [(*drawn, *motion_of(other_hand(), name, *drawn)) for drawn in (own[:3] for own in motions)]
            tell = write(folder, told, instrument, made, rng)
            plain = fault_table.fitted(program, folder)
            own = {"plain": compared(plain, motions)}
            said = {finding["code"] for finding in plain["findings"] if finding["code"].startswith(("bench", "law-"))}
            own["named"] = bool(said & set(codes)) if codes else not said
            if quantity:
                tell(quantity)
                better = fault_table.fitted(program, folder)
                own["better"] = compared(better, motions)
                if truth is not None:
                    estimate = better["estimated"][quantity]
                    own["z"] = (estimate["value"] - truth) / estimate["sd"]
            results[name] = own
    return results


def share(values):
    return f"{100 * np.mean(values):.1f} %"


def row(name, all_of):
    def errors(key):
        per_campaign = [own[key][0].mean(axis=0) for own in all_of]
        mean = np.mean(per_campaign, axis=0)
        error = np.std(per_campaign, axis=0, ddof=1) / np.sqrt(len(per_campaign))
        held = np.concatenate([own[key][1] for own in all_of]).mean(axis=0)
        return [f"{100 * mean[0]:+.2f} ± {100 * error[0]:.2f} %", f"{100 * held[0]:.1f}, {100 * held[1]:.1f} %"]

    cells = [name, share([own["named"] for own in all_of])]
    cells += ["", ""] if name in LAWS else errors("plain")
    cells += errors("better") if "better" in all_of[0] else ["", ""]
    z = [own["z"] for own in all_of if "z" in own]
    cells.append(f"{np.mean(z):+.2f} ± {np.std(z):.2f}, {share(np.abs(z) < 1.96)}" if z else "")
    return "| " + " | ".join(cells) + " |"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("--campaigns", type=int, default=20)
    parser.add_argument("--impacts", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--rigs", default=",".join(RIGS))
    asked = parser.parse_args()
    rigs = asked.rigs.split(",")
    with concurrent.futures.ProcessPoolExecutor(asked.jobs) as pool:
        made = [
            pool.submit(campaign, asked.program, asked.seed, index, asked.impacts, rigs)
            for index in range(asked.campaigns)
        ]
        results = [each.result() for each in made]
    print(f"{asked.campaigns} campaigns of {asked.impacts} impacts, seed {asked.seed}\n")
    print("| bench | named | k off by | intervals that hold k, c | estimated: k off by | hold k, c | quantity: z, holds |")
    print("|---|---|---|---|---|---|---|")
    for name in rigs:
        print(row(name, [result[name] for result in results]), flush=True)


if __name__ == "__main__":
    main()
