"""Clean recordings of pendulum impacts with a known law, for the bench of faults.

Three makers give the same thing, a Record: force in newtons and position in counts of
the encoder, both sampled at one rate, with what is true of the impact.
"""

import csv
import importlib.util
import pathlib
import re
import subprocess
import tempfile

import numpy as np
from scipy.integrate import solve_ivp

RATE = 200e3
ARM = 0.505
INERTIA = 0.01435
MASS = 0.08
CENTRE = 0.35
GRAVITY = 9.80665
COUNTS = 360_000
SENSITIVITY = 0.011
EFFECTIVE_MASS = INERTIA / ARM**2
# Length of a count at the end of the arm; m.
COUNT = 2 * np.pi * ARM / COUNTS
# Square of the angular frequency of the free pendulum; 1/s².
SWING = MASS * GRAVITY * CENTRE / INERTIA
# Recorded before first touch and after separation; s.
BEFORE, AFTER = 10e-3, 15e-3
NOISE = 0.3


class Record:
    """One recording: `force` (N) and `position` (counts, with their fraction)."""

    def __init__(self, force, position, k, velocity):
        self.force = np.asarray(force, float)
        self.position = np.asarray(position, float)
        self.k = k
        self.velocity = velocity
        # Rows without a trace of those that were lost; times are written if wanted.
        self.kept = None
        self.timed = False
        # Factors by which campaign.toml is wrong.
        self.told_force = 1.0
        self.told_counts = 1.0
        self.onset, self.end = self.contact()

    def contact(self):
        """First and last sample of the contact, from the clean force."""
        width = 11
        smooth = np.convolve(self.force, np.ones(width) / width, mode="same")
        top = int(np.argmax(smooth))
        level = max(0.02 * smooth[top], 4 * NOISE / np.sqrt(width))
        first = top - int(np.argmax(smooth[top::-1] < level))
        last = top + int(np.argmax(smooth[top:] < level))
        return first, last

    @property
    def peak(self):
        return float(self.force.max())

    @property
    def length(self):
        return self.end - self.onset

    def copy(self):
        other = object.__new__(Record)
        other.__dict__.update(self.__dict__)
        other.force = self.force.copy()
        other.position = self.position.copy()
        return other

    def write(self, path):
        rows = np.arange(self.force.size)
        if self.kept is not None:
            rows = rows[self.kept]
        volts = self.force[rows] * SENSITIVITY
        counts = np.floor(self.position[rows]).astype(int)
        if path.suffix == ".npy":
            np.save(path, np.rec.fromarrays([volts, counts], names="force_V,count"))
            return
        if self.timed:
            columns = [rows / RATE, volts, counts]
            head, form = "time_s,force_V,count", ["%.7f", "%.7g", "%d"]
        else:
            columns = [volts, counts]
            head, form = "force_V,count", ["%.7g", "%d"]
        form = ",".join(form)
        lines = [form % row for row in zip(*(column.tolist() for column in columns), strict=True)]
        path.write_text("\n".join([head, *lines, ""]))


def motion(k, c, velocity):
    """Displacement and force of a pendulum on a Kuwabara-Kono contact, touching at 0."""

    def force(d, v):
        d = np.maximum(d, 0.0)
        return k * d**1.5 + c * np.sqrt(d) * v

    def loaded(_, y):
        return [y[1], -np.maximum(force(*y), 0.0) / EFFECTIVE_MASS - SWING * y[0]]

    def free(_, y):
        return [y[1], -SWING * y[0]]

    def parted(t, y):
        return force(*y) if t > 2e-5 else 1.0

    parted.terminal = True
    parted.direction = -1
    exact = {"method": "DOP853", "rtol": 1e-10, "atol": 1e-14, "dense_output": True}
    contact = solve_ivp(loaded, (0, AFTER), [0.0, velocity], events=parted, first_step=1e-7, **exact)
    end = contact.t[-1]
    before = solve_ivp(free, (0, -2 * BEFORE), [0.0, velocity], **exact)
    after = solve_ivp(free, (end, end + 2 * AFTER), contact.y[:, -1], **exact)

    def at(times):
        x = np.empty(times.size)
        loads = np.zeros(times.size)
        inside = (times >= 0) & (times < end)
        for where, found in ((times < 0, before), (inside, contact), (times >= end, after)):
            if where.any():
                y = found.sol(times[where])
                x[where] = y[0]
                if found is contact:
                    loads[where] = np.maximum(force(*y), 0.0)
        return x, loads

    return at, end


def drawn(rng):
    """k, c and velocity of one impact: fruit and blows differ."""
    k = 753_599.0 * np.exp(0.2 * rng.normal())
    c = 1524.0 * np.exp(0.3 * rng.normal())
    return k, c, rng.uniform(0.2, 0.5)


def own(count, seed, _):
    """The simulator of this file."""
    rng = np.random.default_rng((seed, 1))
    for _ in range(count):
        k, c, velocity = drawn(rng)
        at, end = motion(k, c, velocity)
        start = -BEFORE - rng.uniform() / RATE
        times = start + np.arange(int((BEFORE + end + AFTER) * RATE)) / RATE
        x, loads = at(times)
        force = loads + NOISE * rng.normal(size=times.size)
        position = np.arcsin(x / ARM) * COUNTS / (2 * np.pi) + rng.uniform(100, 104)
        yield Record(force, position, k, velocity)


def other(count, seed, path):
    """A simulator of another hand, with its own integrator and instrument."""
    spec = importlib.util.spec_from_file_location("rig", path)
    rig = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(rig)
    rng = np.random.default_rng((seed, 2))
    with tempfile.TemporaryDirectory() as scratch:
        file = pathlib.Path(scratch) / "impact.csv"
        for _ in range(count):
            k, c, velocity = drawn(rng)
            at, _, _ = rig.integrate(rig.kk(k, c), rig.MEFF, velocity, 0.05, omega2=rig.OMEGA2, rtol=1e-9)
            rig.record_pendulum(file, at, rng, tpre=BEFORE, tpost=AFTER + 5e-3, noise=NOISE)
            table = np.loadtxt(file, delimiter=",", skiprows=1)
            yield Record(table[:, 0] / SENSITIVITY, table[:, 1] + 0.5, k, velocity)


def windfall(count, seed, program):
    """Recordings of `windfall simulate`, whose phases are counted here."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch) / "made"
        arguments = [
            "simulate", "pendulum", "--law", "kuwabara-kono(k=753599, c=1524)",
            "--spread", "k=130000", "--spread", "c=260",
            "--inertia", f"{INERTIA} kg m^2", "--arm", f"{ARM} m", "--mass", f"{MASS} kg",
            "--centre-of-mass", f"{CENTRE} m", "--velocity", "0.388 m/s",
            "--specimens", str(count), "--seed", str(seed), "--recordings", str(folder),
        ]  # fmt: skip
        subprocess.run([program, *arguments], check=True, stdout=subprocess.DEVNULL)
        laws = {}
        with open(folder / "truth.csv", newline="") as file:
            for row in csv.DictReader(file):
                laws[row["id"]] = float(re.search(r"k=([0-9.eE+]+)", row["law"]).group(1))
        with open(folder / "impacts.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        for row in rows:
            table = np.genfromtxt(folder / "raw" / row["file"], delimiter=",", names=True)
            position = counted(table["phase_a_V"] > 2.5, table["phase_b_V"] > 2.5)
            yield Record(table["force_V"] / SENSITIVITY, position + 0.5, laws[row["id"]], 0.388)


def counted(a, b):
    """Counts of two phases in quadrature, A leading."""
    state = np.where(a, np.where(b, 2, 1), np.where(b, 3, 0))
    steps = np.diff(state)
    steps = np.where(steps == 3, -1, np.where(steps == -3, 1, steps))
    counts = np.concatenate([[0], np.cumsum(steps)])
    # Into the fruit is positive.
    half = counts.size // 8
    return counts if counts[half] >= counts[0] else -counts
