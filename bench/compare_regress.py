"""Times linear regression by windfall, R and statsmodels in turns.

Usage: compare_regress.py REGRESS_SPEED FILE ROUNDS
"""

import json
import subprocess
import sys
import time
from statistics import median

import numpy as np
import statsmodels.api as sm

ROWS, COLUMNS = 1_000_000, 10

R = """
file <- commandArgs(TRUE)[1]
values <- readBin(file, "double", 11e6, endian = "little")
table <- as.data.frame(matrix(values, ncol = 11)[, -1])
names(table) <- c(paste0("x", 1:9), "y")
gc()
seconds <- system.time(own <- summary(lm(y ~ ., table)))[["elapsed"]]
cat(seconds, "\\n", sprintf("%.17g", own$coefficients[, 1]), "\\n")
"""


def main():
    program, file, rounds = sys.argv[1], sys.argv[2], int(sys.argv[3])
    random = np.random.default_rng(0)
    x = np.column_stack([np.ones(ROWS), random.normal(size=(ROWS, COLUMNS - 1)) * np.arange(1, COLUMNS) + 3])
    y = x @ np.linspace(1, 2, COLUMNS) + random.normal(size=ROWS)
    np.concatenate([x.T.ravel(), y]).tofile(file)
    seconds = {"windfall": [], "R lm": [], "statsmodels": []}
    estimates = {}
    for _ in range(rounds):
        lines = subprocess.run([program, file, str(COLUMNS), "1"], capture_output=True, text=True, check=True).stdout.splitlines()
        seconds["windfall"].append(float(lines[0]))
        estimates["windfall"] = np.array(json.loads(lines[1]))
        lines = subprocess.run(["Rscript", "-e", R, file], capture_output=True, text=True, check=True).stdout.splitlines()
        seconds["R lm"].append(float(lines[-2]))
        estimates["R lm"] = np.array([float(word) for word in lines[-1].split()])
        start = time.perf_counter()
        fit = sm.OLS(y, x).fit()
        fit.bse, fit.pvalues, fit.rsquared_adj
        seconds["statsmodels"].append(time.perf_counter() - start)
        estimates["statsmodels"] = fit.params
    for name, own in seconds.items():
        ratio = median(a / b for a, b in zip(own, seconds["windfall"]))
        apart = np.max(np.abs(estimates[name] / estimates["windfall"] - 1))
        print(f"{name:12} {median(own):8.3f} s  {ratio:5.1f} times windfall's; estimates differ by {apart:.0e}")


if __name__ == "__main__":
    main()
