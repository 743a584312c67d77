"""Reference values of tests/repeats.rs, by SciPy. Usage: python repeats.py

Needs numpy and scipy. Prints what the tests hold.
"""

import warnings

import numpy as np
import scipy
from scipy import optimize, stats

warnings.simplefilter("ignore", RuntimeWarning)  # ln 0 far from the optimum
print("SciPy", scipy.__version__)

# One difference per fruit; the mean over signs, all patterns.
ROWS = {
    "five": [0.021, 0.013, -0.004, 0.017, 0.009],
    "eight": [0.021, 0.013, -0.004, 0.017, 0.009, -0.011, 0.002, 0.015],
    "ten": [0.3, -0.1, 0.25, 0.12, -0.31, 0.08, 0.22, 0.05, -0.02, 0.4],
}
for name, row in ROWS.items():
    def statistic(x, axis=-1):
        return np.abs(np.mean(x, axis=axis))
    found = stats.permutation_test(
        (np.array(row),), statistic, permutation_type="samples",
        alternative="greater", n_resamples=np.inf, vectorized=True)
    print("permutation", name, repr(float(found.pvalue)))

# Critical energies: (low, high]; 0 and inf are censored on one side. J.
FRUIT = [
    (0.10, 0.14), (0.14, 0.20), (0.20, 0.28), (0.14, 0.20), (0.0, 0.10),
    (0.28, np.inf), (0.20, 0.28), (0.10, 0.20), (0.14, 0.20), (0.20, np.inf),
    (0.10, 0.14), (0.14, 0.28),
]
low = np.array([a for a, _ in FRUIT])
high = np.array([b for _, b in FRUIT])
both = (low > 0) & np.isfinite(high)
data = stats.CensoredData(
    left=high[low == 0], right=low[np.isinf(high)],
    interval=np.column_stack([low[both], high[both]]))

def minimise(f, x0, args=(), disp=False):
    return optimize.fmin(f, x0, args=args, disp=False, xtol=1e-12, ftol=1e-14, maxiter=10**5, maxfun=10**5)

s, _, scale = stats.lognorm.fit(data, floc=0, optimizer=minimise)
print("lognorm sigma, median", repr(float(s)), repr(float(scale)))
c, _, scale = stats.weibull_min.fit(data, floc=0, optimizer=minimise)
print("weibull shape, median", repr(float(c)), repr(float(scale * np.log(2) ** (1 / c))))

# Profile of the median: 95 % interval, from a fresh minimisation at each.
def profile(m, dist):
    def nll(ln_a):
        a = np.exp(ln_a)
        cdf = (lambda e: stats.lognorm.cdf(e, 1 / a, 0, m)) if dist == "lognorm" else (
            lambda e: stats.weibull_min.cdf(e, a, 0, m / np.log(2) ** (1 / a)))
        return -np.sum(np.log(cdf(high) - cdf(low)))
    return optimize.minimize_scalar(nll, bounds=(-2, 4), method="bounded", options={"xatol": 1e-12}).fun

for dist in ["lognorm", "weibull"]:
    best = optimize.minimize_scalar(lambda m: profile(m, dist), bounds=(0.05, 0.6), method="bounded",
                                    options={"xatol": 1e-12})
    target = best.fun + stats.chi2.ppf(0.95, 1) / 2
    ends = [optimize.brentq(lambda m: profile(m, dist) - target, *b, xtol=1e-12)
            for b in [(0.05, best.x), (best.x, 0.8)]]
    print("profile", dist, "median", best.x, "ends", [float(e) for e in ends], "-ln L", best.fun)
