"""Fits the Kuwabara-Kono law to each recording of a simulated pendulum campaign.

    campaign_fit.py CAMPAIGN OUTPUT.csv

NumPy reads and decodes, numba integrates the motion, SciPy fits k, c, the velocity and the
time of first touch and the displacement there to displacement and force.
"""

import csv
import math
import pathlib
import sys
import tomllib

import numba
import numpy as np
from scipy.optimize import least_squares


def number(text):
    return float(str(text).split()[0])


def quadrature(a, b):
    """Counts of two phases, ×4; +1 for a step with A ahead."""
    state = np.array([0, 1, 3, 2])[(a > 2.5).astype(int) + 2 * (b > 2.5).astype(int)]
    step = np.diff(state) % 4
    return np.concatenate([[0], np.cumsum(np.array([0, 1, 0, -1])[step])])


@numba.njit(cache=True)
def acceleration(theta, omega, k, c, arm, inertia, torque):
    x, v = arm * math.sin(theta), arm * math.cos(theta) * omega
    force = 0.0
    if x > 0.0:
        root = math.sqrt(x)
        force = max(0.0, k * x * root + c * root * v)
    return (-torque * math.sin(theta) - force * arm * math.cos(theta)) / inertia, force


@numba.njit(cache=True)
def motion(k, c, velocity, onset, times, arm, inertia, torque):
    """Displacement and force at the times; Runge-Kutta of order 4, a step per sample."""
    n = times.size
    place, force = np.zeros(n), np.zeros(n)
    theta, omega, now = 0.0, velocity / arm, onset
    for i in range(n):
        if times[i] <= onset:
            place[i] = velocity * (times[i] - onset)
            continue
        h = times[i] - now
        a1, _ = acceleration(theta, omega, k, c, arm, inertia, torque)
        a2, _ = acceleration(theta + h / 2 * omega, omega + h / 2 * a1, k, c, arm, inertia, torque)
        w2 = omega + h / 2 * a1
        a3, _ = acceleration(theta + h / 2 * w2, omega + h / 2 * a2, k, c, arm, inertia, torque)
        w3 = omega + h / 2 * a2
        a4, _ = acceleration(theta + h * w3, omega + h * a3, k, c, arm, inertia, torque)
        theta += h / 6 * (omega + 2 * w2 + 2 * w3 + omega + h * a3)
        omega += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
        now = times[i]
        _, force[i] = acceleration(theta, omega, k, c, arm, inertia, torque)
        place[i] = arm * math.sin(theta)
    return place, force


def fit(path, rate, sensitivity, counts, rig):
    arm, inertia, torque = rig
    columns = np.loadtxt(path, delimiter=",", skiprows=1, unpack=True)
    step = 2 * math.pi / counts
    place = arm * np.sin(step * quadrature(columns[0], columns[1]))
    force = columns[2] / sensitivity
    quiet = force[:200]
    force = force - quiet.mean()
    noise = (quiet.std(), arm * step / math.sqrt(12))
    above = np.flatnonzero(np.convolve(force, np.ones(9) / 9, "same") > 1.0)
    onset, end = above[0], above[-1]
    if place[(onset + end) // 2] < place[onset]:
        place = -place
    margin = (end - onset) // 5
    first, last = max(onset - margin, 1), min(end + margin, force.size)
    times = np.arange(first, last) / rate
    place, force = place[first:last], force[first:last]
    slope = np.polyfit(times[:margin], place[:margin], 1)[0]
    mass = inertia / arm**2
    depth = np.ptp(place[: (last - first) * 2 // 3])
    start = [math.log(1.25 * mass * slope**2 / depth**2.5), math.log(600.0), slope, 0.0, 0.0]
    zero = np.interp(onset / rate, times, place)

    def residuals(p):
        model = motion(math.exp(p[0]), math.exp(p[1]), p[2], onset / rate + 1e-3 * p[3], times, arm, inertia, torque)
        return np.concatenate([(model[0] + zero + 1e-3 * p[4] - place) / noise[1], (model[1] - force) / noise[0]])

    found = least_squares(residuals, start, method="lm", diff_step=1e-6, xtol=1e-8, ftol=1e-9)
    return math.exp(found.x[0]), math.exp(found.x[1]), found.x[2]


def main():
    campaign = pathlib.Path(sys.argv[1])
    told = tomllib.loads((campaign / "campaign.toml").read_text())
    rig = told["rig"]
    torque = number(rig["mass"]) * number(rig["gravity"]) * number(rig["centre_of_mass"])
    rig = (number(rig["arm"]), number(rig["inertia"]), torque)
    rate, sensitivity = number(told["files"]["rate"]), number(told["channels"]["force"]["sensitivity"])
    counts = told["encoder"]["counts_per_revolution"]
    with open(campaign / "impacts.csv", newline="") as table, open(sys.argv[2], "w", newline="") as out:
        rows = csv.writer(out)
        rows.writerow(["id", "k", "c", "velocity"])
        for impact in csv.DictReader(table):
            rows.writerow([impact["id"], *fit(campaign / "raw" / impact["file"], rate, sensitivity, counts, rig)])


main()
