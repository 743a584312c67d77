"""What the memory of a fit consists of, for each recording of a campaign.

Usage: check_memory.py WINDFALL [RECORDINGS]

Two simulated campaigns are fitted, of which one has five times as many recordings, and heaptrack
notes who holds what when the heap is largest. What grows with the number of recordings belongs to

    row         the result, which stands in the table, in JSON and in the store
    line        the line of impacts.csv and specimens.csv that asks for it
    digest      name and SHA-256 of the recording, so that results know what they rest on
    key         under which the result is stored

Exit status 1 if more than 100 bytes are none of them. Python's standard library only.
"""

import collections
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

OWNERS = [
    ("row", r"fit_outcome::|impacts::fit::fit_law|impact_outcome"),
    ("line", r"settings::(tables|read|shared)::"),
    ("digest", r"recording::digests::|files::inputs::|recording_path"),
    ("key", r"impacts::key::|Stored.*::add"),
    # The table itself, in which the rows lie.
    ("row", r"pipeline::evaluate::evaluate"),
]
ELSE = "else"


def owner(stack):
    frames = [re.sub(r"::h[0-9a-f]{16}$", "", own) for own in stack.split(";") if "windfall" in own]
    # What the table is made in is on every stack: only its own allocations are its.
    for name, pattern in OWNERS[:-1]:
        if any(re.search(pattern, own) for own in frames):
            return name
    return OWNERS[-1][0] if frames and re.search(OWNERS[-1][1], frames[-1]) else ELSE


def held(program, folder, recordings):
    """Bytes at the peak of a fit by owner, and the largest resident set without the profiler."""
    campaign, profile = folder / f"c{recordings}", folder / f"p{recordings}"
    subprocess.run([program, "simulate", "pendulum", "--law", "kuwabara-kono(k=753599, c=1524)", "--recordings",
                    campaign, "--specimens", str(recordings // 5), "--repeats", "5", "--rate", "50 kHz"],
                   check=True, stdout=subprocess.DEVNULL)
    fit = [program, "fit", campaign, "--refit", "--threads", "1"]
    run = subprocess.Popen(fit, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    resident = os.wait4(run.pid, 0)[2].ru_maxrss
    shown = subprocess.run([program, "fit", campaign, "--format", "json"], check=True, capture_output=True)
    rows = json.loads(shown.stdout)["impacts"]
    subprocess.run(["heaptrack", "-o", profile, *fit], check=True, capture_output=True)
    stacks = folder / "stacks"
    subprocess.run(["heaptrack_print", "-f", f"{profile}.zst", "-F", stacks, "--flamegraph-cost-type", "peak",
                    "-p", "0", "-a", "0", "-T", "0", "-l", "0"], check=True, capture_output=True)
    bytes_of = collections.Counter()
    for line in stacks.read_text().splitlines():
        stack, _, count = line.rpartition(" ")
        bytes_of[owner(stack)] += int(count)
    return bytes_of, resident, len(json.dumps(rows, separators=(",", ":"))) / len(rows)


def main():
    program, few = str(Path(sys.argv[1]).resolve()), int(sys.argv[2]) if len(sys.argv) > 2 else 500
    with tempfile.TemporaryDirectory(prefix="windfall-memory-") as folder:
        (less, small, _), (more, large, text) = [held(program, Path(folder), n) for n in (few, 5 * few)]
    grown = {name: (more[name] - less[name]) / (4 * few) for name in [*dict(OWNERS), ELSE]}
    print(f"{few} and {5 * few} recordings; bytes at the peak of the heap for each further one:")
    for name, count in grown.items():
        print(f"  {name:8}{count:8.0f}")
    print(f"  {'all':8}{sum(grown.values()):8.0f}   (a row as JSON: {text:.0f})")
    print(f"largest resident set: {small / 1024:.1f} and {large / 1024:.1f} MiB")
    return grown[ELSE] > 100


if __name__ == "__main__":
    sys.exit(main())
