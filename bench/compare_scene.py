"""Runs the bins of scene_bin.py: compare_scene.py EXAMPLE FOLDER COUNT ROUNDS STEPS NAME=PROGRAM...

EXAMPLE is windfall's example bin_fill; each PROGRAM is a LAMMPS, run with every one of its styles
that fit the law. All run in turns on the first core. Processor time (user and system, of the
process, in the last tenth of the steps) is read when a program says that a tenth is over.
"""

import os
import subprocess
import sys

example, folder, count, rounds, steps, *programs = sys.argv[1:]
count, rounds, steps = int(count), int(rounds), int(steps)
TICKS = os.sysconf("SC_CLK_TCK")


def spent(process):
    """Processor time of a process so far; s."""
    with open(f"/proc/{process.pid}/stat") as stat:
        own = stat.read().rpartition(")")[2].split()
    return (int(own[11]) + int(own[12])) / TICKS


def run(command, is_tenth):
    """Particle-steps per second of the last tenth in millions, contacts per fruit, mean height."""
    times, contacts, height = [], None, None
    process = subprocess.Popen(["taskset", "-c", "0", *command], stdout=subprocess.PIPE, text=True)
    lines = []
    for line in process.stdout:
        lines.append(line)
        touched = is_tenth(line.split())
        if touched is not None:
            times.append(spent(process))
            contacts = touched
        if line.startswith("FINAL"):
            height = float(line.split()[3])
    if process.wait() or len(times) < 2 or height is None:
        sys.exit(f"{' '.join(command)} failed:\n{''.join(lines[-20:])}")
    return count * steps / 10 / (times[-1] - times[-2]) / 1e6, contacts, height


def windfall_tenth(words):
    return float(words[2]) if len(words) > 9 and words[1] == "contacts/fruit" else None


def lammps_tenth(words):
    return float(words[3]) if len(words) == 4 and words[0].isdigit() and words[1] == str(count) else None


def styles(program):
    """Names and options of the styles that a LAMMPS has of the law."""
    told = subprocess.run([program, "-h"], capture_output=True, text=True, check=True).stdout
    known = told.split()
    found = {"gran/hertz/history": []}
    if "granular" in known:
        found["granular"] = ["-var", "granular", "1"]
    if "gran/hertz/history/omp" in known:
        found["gran/hertz/history/omp"] = ["-sf", "omp", "-pk", "omp", "1"]
    return found


peers = []
for own in programs:
    name, program = own.split("=", 1)
    for style, options in styles(program).items():
        deck = [program, "-in", f"{folder}/bin.deck", "-var", "steps", str(steps), "-log", "none"]
        peers.append((f"{name}, {style}", deck + options))
ratios = []
for turn in range(1, rounds + 1):
    own, contacts, height = run([example, f"{folder}/bin.txt", str(steps), "1", "1"], windfall_tenth)
    print(f"round {turn}: windfall {own:.2f} M particle-steps/s; contacts {contacts:.3f}; mean height {height:.4f} m")
    best = 0.0
    for name, command in peers:
        rate, contacts, height = run(command, lammps_tenth)
        best = max(best, rate)
        print(f"  {name}: {rate:.2f}, windfall {own / rate:.2f} times; contacts {contacts:.3f}; mean height {height:.4f} m")
    ratios.append(own / best)
    sys.stdout.flush()
print(f"windfall over the fastest of them, round by round: {', '.join(f'{own:.2f}' for own in ratios)}; "
      f"median {sorted(ratios)[len(ratios) // 2]:.2f}")
