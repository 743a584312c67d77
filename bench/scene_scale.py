"""Beds of 10000 and 100000 fruit at rest, in turns: for bench/scene-scale.

    scene_scale.py EXAMPLE FOLDER ROUNDS ANNULI
"""

import os
import resource
import shutil
import statistics
import subprocess
import sys

example, folder, rounds, annuli = sys.argv[1], sys.argv[2], int(sys.argv[3]), sys.argv[4]
REST = 40000  # steps of 20 us until a bed is at rest
WORK = 6e7  # particle-steps of a round


def run(count, steps, threads, state):
    """Contacts per fruit, and particle-steps per second after the first tenth of the run."""
    command = [example, f"{folder}/{count}/bin.txt", str(steps), str(threads), annuli, state]
    if threads == 1:
        command = ["taskset", "-c", "0"] + command
    out = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    parts = [line.split() for line in out.splitlines() if "particle-steps" in line]
    seconds = sum(1 / float(part[-3]) for part in parts[1:])
    return float(parts[-1][2]), (len(parts) - 1) / seconds


threads = os.cpu_count()
for count in (10000, 100000):
    contacts, _ = run(count, REST, threads, f"{folder}/{count}/state")
    memory = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    print(f"{count} fruit at rest: {contacts:.2f} contacts each, at most {memory:.0f} MiB", flush=True)

speeds = {}
for turn in range(rounds):
    for count, number in ((10000, 1), (10000, 2), (100000, 1)):
        # Each round starts from the same bed.
        shutil.copy(f"{folder}/{count}/state", f"{folder}/now")
        _, speed = run(count, int(WORK / count), number, f"{folder}/now")
        speeds.setdefault((count, number), []).append(speed)
    small, pair, large = (own[-1] for own in speeds.values())
    print(
        f"round {turn + 1}: 10000 fruit {small:.2f} M particle-steps/s, on two threads {pair:.2f}"
        f" ({pair / small:.2f} times), 100000 fruit {large:.2f} (cost {small / large:.2f} times)",
        flush=True,
    )
small, pair, large = (statistics.median(own) for own in speeds.values())
print(f"medians: two threads {pair / small:.2f} times, 100000 fruit cost {small / large:.2f} times")
