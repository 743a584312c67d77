"""Fits campaigns whose bench is not as told, and prints what that does.

Each motion is recorded by every bench. "named": campaigns whose finding names the fault;
"off" and "held": bias of k, and share of the 95 % intervals that hold the truth.
"""

import argparse
import concurrent.futures
import functools
import importlib.util
import json
import os
import pathlib
import shutil
import sys
import tempfile
import typing

import fault_impacts
import fault_table
import numpy as np
from scipy.integrate import solve_ivp
from scipy.signal import cont2discrete, lfilter

# Samples of the force for each that is recorded, where a sensor swings or a filter acts.
FINE = 10
DAMPED = np.sqrt(0.5)


class Rig(typing.NamedTuple):
    """What is wrong with a bench."""

    # What campaign.toml says over what is true.
    told: dict = {}
    # What the instruments do.
    instrument: dict = {}
    # What is estimated to mend it, and the true values.
    estimate: tuple = ()
    truth: dict = {}
    # Findings that name it, and words of which one of them must have some.
    codes: tuple = ()
    words: tuple = ("",)


SWING = (2e3, 0.05)
ARM = (1.5e3, 0.02, 1e-7)
RIGS = {
    "as told": Rig(),
    "inertia 5 % too large": Rig(
        told={"inertia": 1.05},
        estimate=("inertia",),
        truth={"inertia": fault_impacts.INERTIA},
        codes=("bench-gain",),
    ),
    "sensitivity 5 % too small": Rig(
        instrument={"gain": 1.05}, estimate=("force.gain",), truth={"force.gain": 1.05}, codes=("bench-gain",)
    ),
    "force 20 us late": Rig(
        instrument={"delay": 20e-6}, estimate=("force.delay",), truth={"force.delay": 20e-6}, codes=("bench-delay",)
    ),
    # Of second order, which a delay describes.
    "filter of 5 kHz": Rig(instrument={"pole": (5e3, DAMPED)}, estimate=("force.delay",), codes=("bench-delay",)),
    "first-order filter of 5 kHz": Rig(
        instrument={"filter": 5e3}, estimate=("force_filter",), truth={"force_filter": 5e3}, codes=("bench-delay",)
    ),
    "resonance at 2 kHz": Rig(
        instrument={"pole": SWING},
        estimate=("sensor_frequency",),
        truth={"sensor_frequency": SWING[0], "sensor_damping": SWING[1]},
        codes=("bench-cause",),
        words=("best explained by a force sensor that swings",),
    ),
    "arm mode at 1.5 kHz": Rig(
        instrument={"arm": ARM},
        estimate=("arm_frequency",),
        truth={"arm_frequency": ARM[0], "arm_damping": ARM[1], "arm_compliance": ARM[2]},
        codes=("bench-cause",),
        words=("best explained by an arm",),
    ),
    "encoder half a count off": Rig(instrument={"lines": 0.5}),
}

# Fruit of another law than is fitted, from the simulator of another hand.
LAWS = {
    "mild yield": lambda rig, k, c: rig.yielding(k, c, 0.0004, 0.8),
    "strong yield": lambda rig, k, c: rig.yielding(k, 0.5 * c, 0.0003, 0.5),
    "exponent 1.8": lambda rig, k, c: rig.power(8.26 * k, 1.8, c, 0.5),
    "Hunt and Crossley": lambda rig, k, c: rig.hc(k, k),
    "moving base": None,
}
# Frequency, damping and compliance of a base that the fruit stands on: Hz, 1, m/N.
BASE = (400.0, 0.05, 2e-7)
RIG = pathlib.Path(os.environ.get("WINDFALL_RIG", "../shared/independent/rig.py"))
if RIG.is_file():
    RIGS |= {name: Rig(codes=("law-misfit",)) for name in LAWS}
else:
    print("not made: fruit of other laws, whose simulator is not there", file=sys.stderr)


@functools.cache
def other_hand():
    spec = importlib.util.spec_from_file_location("rig", RIG)
    rig = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(rig)
    return rig


def motion_of(rig, law, k, c, velocity):
    """A motion under another law, as `fault_impacts.motion` gives one."""
    if LAWS[law] is None:
        return on_a_base(rig, k, c, velocity)
    at, end, _ = rig.integrate(LAWS[law](rig, k, c), rig.MEFF, velocity, 0.05, omega2=rig.OMEGA2, rtol=1e-9)
    return (lambda times: at(times)[::2]), end


def on_a_base(rig, k, c, velocity):
    """Displacement and force of a fruit whose base swings under the force."""
    frequency, damping, compliance = BASE
    w = 2 * np.pi * frequency

    def force(state):
        depth, rate = np.maximum(state[0] - state[2], 0), state[1] - state[3]
        return np.maximum(k * depth**1.5 + c * np.sqrt(depth) * rate, 0)

    def slope(_, state):
        own = force(state)
        base = w * w * (compliance * own - state[2]) - 2 * damping * w * state[3]
        return [state[1], -own / rig.MEFF - rig.OMEGA2 * state[0], state[3], base]

    def apart(_, state):
        return state[0] - state[2] + 1e-12

    apart.terminal, apart.direction = True, -1
    motion = solve_ivp(slope, (0, 0.05), [0, velocity, 0, 0], "DOP853", rtol=1e-9, atol=1e-14, dense_output=True, events=apart, first_step=1e-8)
    end = motion.t[-1]
    x, v = motion.y[:2, -1]
    swing = np.sqrt(rig.OMEGA2)

    def at(times):
        inside = motion.sol(np.clip(times, 0, end))
        free = np.where(times < 0, velocity / swing * np.sin(swing * times), x * np.cos(swing * (times - end)) + v / swing * np.sin(swing * (times - end)))
        contact = (times >= 0) & (times <= end)
        return np.where(contact, inside[0], free), np.where(contact, force(inside), 0.0)

    return at, end


def filtered(signal, interval, numerator, denominator):
    b, a, _ = cont2discrete((numerator, denominator), interval, method="foh")
    return lfilter(np.ravel(b), a, signal)


def swung(signal, interval, frequency, damping):
    """A sensor, filter or arm with two poles."""
    w = 2 * np.pi * frequency
    return filtered(signal, interval, [w * w], [1, 2 * damping * w, w * w])


def recorded(motion, instrument, rng):
    """Force (N) and position (counts, with their fraction) of one motion."""
    k, c, velocity, at, end = motion
    interval = 1 / fault_impacts.RATE
    start = -fault_impacts.BEFORE - rng.uniform() * interval
    count = int((fault_impacts.BEFORE + end + fault_impacts.AFTER) / interval)
    times = start + np.arange(count) * interval
    x, force = at(times)
    if instrument.keys() & {"delay", "pole", "filter", "arm"}:
        fine = times[0] - instrument.get("delay", 0.0) + np.arange(count * FINE) * interval / FINE
        _, force = at(fine)
        if "arm" in instrument:
            frequency, damping, compliance = instrument["arm"]
            x = x - compliance * swung(force, interval / FINE, frequency, damping)[::FINE]
        if "pole" in instrument:
            force = swung(force, interval / FINE, *instrument["pole"])
        if "filter" in instrument:
            force = filtered(force, interval / FINE, [1], [1 / (2 * np.pi * instrument["filter"]), 1])
        force = force[::FINE]
    force = instrument.get("gain", 1.0) * force + fault_impacts.NOISE * rng.normal(size=count)
    position = np.arcsin(x / fault_impacts.ARM) * fault_impacts.COUNTS / (2 * np.pi) + rng.uniform(100, 104)
    return force, position + instrument.get("lines", 0.0) * np.sin(np.pi / 2 * position)


def write(folder, bench, motions, rng):
    """Writes a campaign; gives what asks for the estimates in it."""
    made = [fault_impacts.Record(*recorded(motion, bench.instrument, rng), motion[0], motion[2]) for motion in motions]
    records = [(f"i{index:03d}", record) for index, record in enumerate(made)]
    inertia = fault_impacts.INERTIA * bench.told.get("inertia", 1.0)
    fault_table.write_campaign(folder, records, "1 N", inertia, "npy")
    path = folder / "campaign.toml"
    plain = path.read_text()
    asked = ", ".join(f'"{name}"' for name in bench.estimate)
    return lambda: path.write_text(plain.replace("[fit]\n", f"[fit]\nestimate = [{asked}]\n"))


def compared(outcome, motions):
    """Relative errors of k and c, and whether the intervals hold them."""
    errors, held = [], []
    for impact in outcome["impacts"]:
        if impact["left_out"]:
            continue
        motion = motions[int(impact["id"][1:])]
        own = [impact["parameters"][name] for name in ("k", "c")]
        errors.append([each["value"] / truth - 1 for each, truth in zip(own, motion, strict=False)])
        held.append([bool(each["low"] <= truth <= each["high"]) for each, truth in zip(own, motion, strict=False)])
    return {"errors": errors, "held": held}


def findings(outcome):
    return [finding for finding in outcome["findings"] if finding["code"].startswith(("bench", "law-"))]


def campaign(program, seed, index, impacts, rigs):
    """What one campaign says on each of the `rigs`; its noise does not depend on their number."""
    rng = np.random.default_rng((seed, index))
    drawn = [fault_impacts.drawn(rng) for _ in range(impacts)]
    motions = None
    results = {}
    with tempfile.TemporaryDirectory() as scratch:
        for name in rigs:
            bench = RIGS[name]
            folder = pathlib.Path(scratch) / "campaign"
            if name in LAWS:
                made = [(*own, *motion_of(other_hand(), name, *own)) for own in drawn]
            else:
                made = motions = motions or [(*own, *fault_impacts.motion(*own)) for own in drawn]
            tell = write(folder, bench, made, np.random.default_rng((seed, index, list(RIGS).index(name))))
            plain = fault_table.fitted(program, folder)
            said = findings(plain)
            named = [
                finding
                for finding in said
                if finding["code"] in bench.codes and any(word in finding["message"] for word in bench.words)
            ]
            own = {
                "plain": compared(plain, drawn),
                "named": bool(named) if bench.codes else not said,
                "said": [f"{finding['code']}: {finding['message']}" for finding in said],
            }
            if bench.estimate:
                tell()
                better = fault_table.fitted(program, folder)
                own["better"] = compared(better, drawn)
                own["left"] = [finding["message"] for finding in findings(better)]
                own["z"] = {}
                for quantity, truth in bench.truth.items():
                    estimate = better["estimated"][quantity]
                    own["z"][quantity] = (estimate["value"] - truth) / estimate["sd"]
            results[name] = own
            shutil.rmtree(folder)
    return results


class Kept:
    """Results of campaigns, one a line of a file, so that a run that stopped goes on."""

    def __init__(self, path, seed, impacts):
        self.path, self.of = path, [seed, impacts]
        self.results = {}
        lines = path.read_text().splitlines() if path and path.is_file() else []
        for line in lines:
            # The last line of a run that was killed may be cut.
            if line.endswith("}"):
                one = json.loads(line)
                if one["of"] == self.of:
                    self.add(one["index"], one["rigs"])

    def add(self, index, results):
        self.results.setdefault(index, {}).update(results)

    def keep(self, index, results):
        self.add(index, results)
        if self.path:
            with self.path.open("a") as file:
                file.write(json.dumps({"of": self.of, "index": index, "rigs": results}) + "\n")

    def missing(self, index, rigs):
        return [name for name in rigs if name not in self.results.get(index, {})]


def share(values):
    return f"{100 * np.mean(values):.1f}"


def signed(value, decimals=2):
    """A number with its sign; none before zero."""
    text = f"{value:+.{decimals}f}"
    return (text[1:] if float(text) == 0 else text).replace("-", "−")


def row(name, all_of):
    def errors(key):
        per_campaign = [np.mean(own[key]["errors"], axis=0) for own in all_of]
        mean = np.mean(per_campaign, axis=0)
        error = np.std(per_campaign, axis=0, ddof=1) / np.sqrt(len(per_campaign))
        held = np.concatenate([own[key]["held"] for own in all_of]).mean(axis=0)
        return [f"{signed(100 * mean[0], 3)} ± {100 * error[0]:.3f}", f"{100 * held[0]:.1f}, {100 * held[1]:.1f}"]

    cells = [name, share([own["named"] for own in all_of])]
    cells += ["", ""] if name in LAWS else errors("plain")
    cells += errors("better") if "better" in all_of[0] else ["", ""]
    told = []
    for quantity in RIGS[name].truth:
        z = [own["z"][quantity] for own in all_of]
        told.append(f"{quantity} {signed(np.mean(z))} ± {np.std(z):.2f}, {share(np.abs(z) < 1.96)}")
    cells.append("<br>".join(told))
    return "| " + " | ".join(cells) + " |"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("--campaigns", type=int, default=20)
    parser.add_argument("--impacts", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--rigs", default=",".join(RIGS))
    parser.add_argument("--keep", type=pathlib.Path, help="file of results; campaigns that it holds are not made again")
    parser.add_argument("--said", action="store_true", help="print what the first campaign says of each bench")
    asked = parser.parse_args()
    rigs = asked.rigs.split(",")
    kept = Kept(asked.keep, asked.seed, asked.impacts)
    with concurrent.futures.ProcessPoolExecutor(asked.jobs) as pool:
        made = {}
        for index in range(asked.campaigns):
            if missing := kept.missing(index, rigs):
                made[pool.submit(campaign, asked.program, asked.seed, index, asked.impacts, missing)] = index
        for each in concurrent.futures.as_completed(made):
            kept.keep(made[each], each.result())
    print(f"{asked.campaigns} campaigns of {asked.impacts} impacts, seed {asked.seed}\n")
    print("| bench | named, % | k off by, % | hold k, c, % | estimated: k off by, % | hold k, c, % | quantities: z, hold, % |")
    print("|---|---|---|---|---|---|---|")
    results = [kept.results[index] for index in range(asked.campaigns)]
    for name in rigs:
        print(row(name, [result[name] for result in results]), flush=True)
    if asked.said:
        for name in rigs:
            print(f"\n{name}", *results[0][name]["said"], *results[0][name].get("left", []), sep="\n  ")


if __name__ == "__main__":
    main()
