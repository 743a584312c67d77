"""k and c of each recording with SciPy and lmfit: python lmfit_fit.py FOLDER OUT.csv"""

import sys
from pathlib import Path

import lmfit
import numpy as np
from scipy.integrate import solve_ivp

MASS, SWING, COUNT = 0.01435 / 0.505**2, 0.08 * 9.80665 * 0.35 / 0.01435, 2 * np.pi * 0.505


def model(p, t):
    def force(x, v):
        return max(p["k"] * x**1.5 + p["c"] * x**0.5 * v, 0.0) if x > 0 else 0.0

    def rhs(_, y):
        return y[1], -force(*y) / MASS - SWING * y[0]

    later, angle = t >= p["onset"], SWING**0.5 * (t - p["onset"])
    y = p["v"] * np.array([np.sin(angle) / SWING**0.5, np.cos(angle)])
    exact = {"method": "DOP853", "rtol": 1e-9, "atol": 1e-12, "first_step": 1e-6}
    y[:, later] = solve_ivp(rhs, (p["onset"], t[-1]), (0, p["v"]), t_eval=t[later], **exact).y
    return y[0] + p["offset"], np.array([force(*each) for each in y.T])


def residual(parameters, t, x, f, sd_x, sd_f):
    predicted_x, predicted_f = model(parameters.valuesdict(), t)
    return np.concatenate([(predicted_x - x) / sd_x, (predicted_f - f) / sd_f])


def fit(t, x, f, counts):
    sd_f, sd_x = f[: t.size // 5].std(), COUNT / counts / 12**0.5
    smooth = np.convolve(f, np.ones(9) / 9, "same")
    onset = t[: smooth.argmax()][smooth[: smooth.argmax()] < 0.1 * smooth.max()][-1]
    before = t < onset - 1e-3
    v, start = np.polyfit(t[before], x[before], 1)
    offset = start + v * onset
    depth = x.max() - offset
    p = lmfit.create_params(
        k={"value": 0.8 * smooth.max() / depth**1.5, "min": 0},
        c={"value": 0.3 * smooth.max() / depth**0.5 / v, "min": 0},
        v=v,
        onset=onset,
        offset=offset,
    )
    return lmfit.minimize(residual, p, args=(t, x, f, sd_x, sd_f), epsfcn=1e-10).params


rows = ["id,k,k_low,k_high,c,c_low,c_high"]
for path in sorted(Path(sys.argv[1]).glob("*.npz")):
    data = np.load(path)
    p = fit(data["t"], data["x"], data["force"], int(data["counts"]))
    if p["k"].stderr is not None:
        limits = [p[n].value + z * p[n].stderr for n in "kc" for z in (0, -1.96, 1.96)]
        rows.append(",".join([path.stem, *map(str, limits)]))
Path(sys.argv[2]).write_text("\n".join(rows) + "\n")
