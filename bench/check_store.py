"""Fits campaigns over damaged copies of their results.sqlite.

Usage: check_store.py WINDFALL [CHANGED [CUT [SEED]]]

Half of the copies belong to a campaign of impacts, half to one of compressions, whose results
are kept in another way. Of each, one byte is another one, or the end is missing. Then

    status 0       all numbers are those of the undamaged store
    any other      the message names results.sqlite, and the file has every byte as before;
                   --refit gives the same numbers or is refused too (tried on every tenth)

Exit status 1 if anything is otherwise. Python's standard library only.
"""

import collections
import json
import random
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from kill_kinds import compression, pendulum

STORE = "c/results.sqlite"


def fit(program, folder, *more):
    """Status of a fit, its numbers (without how they came about), and what it told."""
    words = [program, "fit", "c", "--threads", "1", "--format", "json", *more]
    own = subprocess.run(words, cwd=folder, capture_output=True, text=True, errors="replace", timeout=120)
    numbers = json.loads(own.stdout) if own.returncode == 0 else None
    came = numbers.pop("status") if numbers else None
    return own.returncode, numbers, came, " ".join(own.stderr.split())


def damaged(draw, data, cut):
    """A store with one byte changed or cut short, and what was done."""
    at = draw.randrange(len(data))
    if cut:
        return data[:at], f"cut after {at} bytes"
    new = (data[at] + draw.randrange(1, 256)) % 256
    return data[:at] + bytes([new]) + data[at + 1:], f"byte {at} is {new}, was {data[at]}"


def try_one(program, base, wanted, number, cut, seed):
    draw = random.Random(f"{seed} {cut} {number}")
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch, "w")
        shutil.copytree(base, folder)
        data, what = damaged(draw, (folder / STORE).read_bytes(), cut)
        (folder / STORE).write_bytes(data)
        status, numbers, came, told = fit(program, folder)
        where = f"{base.name}, {what}"
        if "panicked" in told or status not in (0, 1, 2):
            return "WRONG", f"{where}: status {status}: {told[:300]}"
        if status == 0:
            if numbers != wanted:
                return "WRONG", f"{where}: other numbers, in silence"
            return "the same numbers, " + ("from the store" if came["up_to_date"] else "fitted anew or with another run"), where
        if "results.sqlite" not in told:
            return "WRONG", f"{where}: does not name the store: {told[:300]}"
        if (folder / STORE).read_bytes() != data:
            return "WRONG", f"{where}: was refused, and changed"
        if number % 10 == 0:
            status, numbers, _, told = fit(program, folder, "--refit")
            if status == 0 and numbers != wanted:
                return "WRONG", f"{where}: --refit gives other numbers"
            if status != 0 and "results.sqlite" not in told:
                return "WRONG", f"{where}: --refit does not name the store: {told[:300]}"
        return "refused by name", where


def main():
    program = str(Path(sys.argv[1]).resolve())
    changed, cut, seed = [int(own) for own in [*sys.argv[2:], *("2000", "200", "1")[len(sys.argv) - 2:]]]
    wrong = 0
    with tempfile.TemporaryDirectory(prefix="windfall-store-") as scratch, ThreadPoolExecutor(2) as pool:
        bases = []
        for make in (pendulum, compression):
            base = Path(scratch, make.__name__)
            base.mkdir()
            make(program, base)
            status, wanted, _, told = fit(program, base)
            assert status == 0, told
            bases.append((base, wanted))
        for what, count in (("one byte changed", changed), ("cut short", cut)):
            jobs = [pool.submit(try_one, program, *bases[number % 2], number, what == "cut short", seed)
                    for number in range(count)]
            found = [job.result() for job in jobs]
            counts = collections.Counter(verdict for verdict, _ in found)
            print(f"{count} copies with {what}: " + ", ".join(f"{n} {verdict}" for verdict, n in sorted(counts.items())), flush=True)
            for _, where in [own for own in found if own[0] == "WRONG"][:20]:
                print(f"  WRONG {where}")
            wrong += counts["WRONG"]
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main())
