"""Times the reading of recordings by windfall and by other programs, in turns.

Usage: compare_read.py READ_SPEED FOLDER ROUNDS PYTHON_WITH_PANDAS_2
"""

import gc
import struct
import subprocess
import sys
import time
from pathlib import Path
from statistics import median

import nptdms
import numpy as np
import pandas as pd
import polars

from check_formats import NOTHING, tdms_object, tdms_segment, tdms_values

META, NEW, RAW, INTERLEAVED, DAQMX = 2, 4, 8, 32, 128


def linear(last, source):
    return [
        ("NI_Number_Of_Scales", last + 1),
        (f"NI_Scale[{last}]_Scale_Type", "Linear"),
        (f"NI_Scale[{last}]_Linear_Slope", 3e-4),
        (f"NI_Scale[{last}]_Linear_Y_Intercept", 0.1),
        (f"NI_Scale[{last}]_Linear_Input_Source", source),
    ]


def objects(index, properties=()):
    channels = [tdms_object(f"/'g'/'c{i}'", index(i), properties) for i in range(4)]
    return [tdms_object("/", NOTHING), tdms_object("/'g'", NOTHING), *channels]


def make_tdms(folder):
    """Four layouts of 200 MB: one segment of doubles, one per thousand samples as
    programs write while they record, interleaved 16-bit integers with a scale, and
    DAQmx raw data."""
    random = np.random.default_rng(0)
    count, part = 6_250_000, 1000
    doubles = random.normal(size=count)
    one = objects(lambda _: tdms_values(10, count))
    (folder / "one segment, doubles.tdms").write_bytes(
        tdms_segment(META | NEW | RAW, one, doubles.tobytes() * 4))
    with open(folder / "6250 segments, doubles.tdms", "wb") as file:
        first = objects(lambda _: tdms_values(10, part))
        file.write(tdms_segment(META | NEW | RAW, first, doubles[:part].tobytes() * 4))
        lead = b"TDSm" + struct.pack("<IIQQ", RAW, 4713, part * 32, 0)
        for i in range(1, count // part):
            file.write(lead + doubles[i * part : (i + 1) * part].tobytes() * 4)
    count = 25_000_000
    integers = random.integers(-30000, 30000, count).astype("<i2").tobytes() * 4
    woven = objects(lambda _: tdms_values(2, count), linear(0, 0xFFFFFFFF))
    (folder / "interleaved 16-bit, scaled.tdms").write_bytes(
        tdms_segment(META | NEW | RAW | INTERLEAVED, woven, integers))

    def daqmx(i):
        scaler = struct.pack("<IIIII", 3, 0, 2 * i, 0, 0)
        return struct.pack("<IIIQI", 0x1269, 0xFFFFFFFF, 1, count // 100, 1) + scaler + struct.pack("<II", 1, 8)

    (folder / "DAQmx 16-bit, scaled.tdms").write_bytes(
        tdms_segment(META | NEW | RAW | DAQMX, objects(daqmx, linear(1, 0)), integers))


def make_text(folder):
    random = np.random.default_rng(0)
    count = 2_000_000
    noise = random.normal(size=(count, 3)) * (10, 1, 1e-3)
    table = np.column_stack([np.arange(count) * 5e-6, noise])
    for name, form in (("six decimals", "%.6f"), ("all digits", "%.17g"), ("exponents", "%.5e")):
        np.savetxt(folder / f"{name}.csv", table, form, ",", header="t,F,x,v", comments="")


def read_tdms(path):
    return [channel[:] for group in nptdms.TdmsFile.read(path).groups() for channel in group.channels()]


def timed(work):
    def seconds(path):
        gc.collect()
        start = time.perf_counter()
        kept = work(path)
        seconds = time.perf_counter() - start
        del kept
        return seconds
    return seconds


def timed_elsewhere(*command):
    """Seconds that a self-timing program reports."""
    def seconds(path):
        return float(subprocess.run([*command, path, "1"], capture_output=True, text=True, check=True).stdout)
    return seconds


PANDAS = """
import sys, time
import pandas
start = time.perf_counter()
kept = pandas.read_csv(sys.argv[1], engine="c")
print(time.perf_counter() - start)
"""


def main():
    program, folder, rounds, older = sys.argv[1], Path(sys.argv[2]), int(sys.argv[3]), sys.argv[4]
    windfall = timed_elsewhere(program)
    peers = {
        ".tdms": {"npTDMS": timed(read_tdms)},
        ".csv": {
            f"pandas {pd.__version__}": timed(lambda path: pd.read_csv(path, engine="c")),
            "pandas 2.2.3": timed_elsewhere(older, "-c", PANDAS),
            "polars": timed(polars.read_csv),
        },
    }
    if not folder.exists():
        made = folder.with_suffix(".part")
        made.mkdir(parents=True, exist_ok=True)
        make_tdms(made)
        make_text(made)
        made.rename(folder)
    print(f"{'file':34} {'MB':>4} {'windfall s':>11}   others: median s (times windfall)")
    for path in sorted(folder.iterdir()):
        ours, theirs = [], {name: [] for name in peers[path.suffix]}
        path.read_bytes()
        for _ in range(rounds):
            ours.append(windfall(path))
            for name, read in peers[path.suffix].items():
                theirs[name].append(read(path))
        parts = [f"{name} {median(t):.3f} ({median(a / b for a, b in zip(t, ours)):.1f})" for name, t in theirs.items()]
        print(f"{path.name:34} {path.stat().st_size / 1e6:4.0f} {median(ours):11.3f}   {', '.join(parts)}")


if __name__ == "__main__":
    main()
