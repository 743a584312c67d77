"""Fits of one impact with priors by SciPy: the figures of crates/identify/tests/known.rs.

Needs numpy and scipy. Writes the samples to the file that is named and prints, under no prior, one
of k, and one of k and c: k, its deviation, c, its deviation.
"""

import sys

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import least_squares

MASS, VELOCITY = 0.2, 0.5
FORCE_SD, DISPLACEMENT_SD = 2.0, 2e-5
TIMES = np.arange(1, 81) * 9.3e-5


def motion(k, c):
    """Displacement and force of F = k x^1.5 + c x^0.5 v, in time t = s^2 from first touch."""

    def force(x, v):
        x = np.maximum(x, 0.0)
        return k * x**1.5 + c * np.sqrt(x) * v

    def slope(s, y):
        return [2 * s * y[1], -2 * s * force(y[0], y[1]) / MASS]

    found = solve_ivp(
        slope, (0, np.sqrt(TIMES[-1])), [0.0, VELOCITY], "DOP853",
        t_eval=np.sqrt(TIMES), rtol=1e-12, atol=1e-15,
    )
    return found.y[0], force(found.y[0], found.y[1])


def main():
    x, force = motion(753599.0, 1524.0)
    index = np.arange(len(TIMES))
    x = x + DISPLACEMENT_SD * np.sqrt(2) * np.sin(37.0 * index**2)
    force = force + FORCE_SD * np.sqrt(2) * np.sin(23.0 * index**2 + 1.0)
    with open(sys.argv[1], "w") as out:
        out.write("t_s,x_m,F_N\n")
        for row in zip(TIMES, x, force):
            out.write(",".join(repr(float(cell)) for cell in row) + "\n")
    priors = {"k": (8e5, 2e4), "c": (1300.0, 100.0)}
    for names in ("", "k", "kc"):

        def residuals(p, names=names):
            own_x, own_force = motion(1e6 * p[0], 1e3 * p[1])
            rows = [(own_x - x) / DISPLACEMENT_SD, (own_force - force) / FORCE_SD]
            values = {"k": 1e6 * p[0], "c": 1e3 * p[1]}
            for name in names:
                mean, sd = priors[name]
                rows.append([(values[name] - mean) / sd])
            return np.concatenate(rows)

        found = least_squares(residuals, [0.75, 1.5], "3-point", xtol=1e-13, ftol=1e-13, gtol=1e-13)
        sd = np.sqrt(np.diag(np.linalg.inv(found.jac.T @ found.jac)))
        print(", ".join(repr(float(v)) for v in (1e6 * found.x[0], 1e6 * sd[0], 1e3 * found.x[1], 1e3 * sd[1])))


if __name__ == "__main__":
    main()
