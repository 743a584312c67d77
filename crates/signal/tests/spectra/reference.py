"""Reference values of spectra and peaks: python3 reference.py > scipy.txt

Needs scipy (written with 1.17.1). Each line: name, then the values.
"""

import math
import warnings

import numpy as np
from scipy import signal

warnings.simplefilter("ignore")


def samples(n):
    state, out = 12345, []
    for i in range(n):
        state = (1103515245 * state + 12345) % 2**31
        out.append(
            math.sin(0.31 * i) * math.exp(-0.01 * i)
            + 0.5 * math.sin(1.7 * i + 0.3)
            + 0.1
            + 0.2 * (state / 2**31 - 0.5)
        )
    return np.array(out)


def line(name, values):
    print(name, *(repr(float(v)) for v in values))


x, rate = samples(151), 1000.0
for name, window in [("rectangular", "boxcar"), ("hann", "hann"), ("blackman-harris", "blackmanharris")]:
    for scaling, word in [("density", "density"), ("spectrum", "power")]:
        line(f"periodogram-{name}-{word}", signal.periodogram(x, rate, window, scaling=scaling)[1])
        line(f"padded-{name}-{word}", signal.periodogram(x, rate, window, nfft=256, scaling=scaling)[1])
        line(f"welch-{name}-{word}", signal.welch(x, rate, window, 64, 32, 128, scaling=scaling)[1])
line("kept", signal.periodogram(x, rate, "hann", detrend=False)[1])
at, found = signal.find_peaks(x, prominence=0, width=0, rel_height=0.5)
line("peak-index", at)
line("peak-prominence", found["prominences"])
line("peak-width", found["widths"])
