"""Times statistics of a long table by windfall and by R in turns.

Usage: compare_rows.py WINDFALL FOLDER ROWS ROUNDS

Processor time (user and system) and the largest resident set are those that the system counts
for each program, reading included. Python's standard library only.
"""

import os
import subprocess
import sys
from pathlib import Path
from statistics import median

MOST_TIME, MOST_MEMORY = 1 / 3, 1.5

WRITE = """
a <- commandArgs(TRUE)
n <- as.numeric(a[1])
set.seed(7)
x <- matrix(round(rnorm(8 * n), 4), ncol = 8)
v <- sample(4, n, TRUE)
d <- data.table::data.table(
  id = sprintf("f%06d", sample.int(max(1, n %/% 5), n, TRUE)),
  variety = c("Gala", "Fuji", "Elstar", "Jonagold")[v],
  y = round(2 + drop(x %*% (1:8)) * 0.1 + v * 0.2 + rnorm(n), 4), x)
names(d) <- c("id", "variety", "y", paste0("x", 1:8))
data.table::fwrite(d, a[2])
"""

PEER = """
d <- data.table::fread(commandArgs(TRUE)[1])
print(summary(lm(y ~ x1 + x2 + x3 + x4 + x5 + x6 + x7 + x8, d)))
"""

COMMANDS = {
    "regress": ["--response", "y", "--terms", "x1 + x2 + x3 + x4 + x5 + x6 + x7 + x8"],
    "summary": [],
    "summary by variety": ["--by", "variety"],
    "compare": ["--value", "y", "--by", "variety"],
}


def spent(command):
    """Processor time in seconds and largest memory in bytes."""
    run = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(run.pid, 0)
    if status != 0:
        sys.exit(f"{' '.join(map(str, command))}: status {os.waitstatus_to_exitcode(status)}")
    return used.ru_utime + used.ru_stime, 1024 * used.ru_maxrss


def table_of(folder, rows):
    file = folder / f"rows-{rows}.csv"
    if not file.exists():
        subprocess.run(["Rscript", "-e", WRITE, str(rows), file], check=True)
    return file


def middle(all_spent):
    return [median(own) for own in zip(*all_spent)]


def main():
    program, folder, rows, rounds = sys.argv[1], Path(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4])
    folder.mkdir(parents=True, exist_ok=True)
    file, longer = table_of(folder, rows), table_of(folder, 2 * rows)
    commands = {name: lambda table, name=name, own=own: [program, name.split()[0], table, *own]
                for name, own in COMMANDS.items()}
    commands["R fread + lm"] = lambda table: ["Rscript", "-e", PEER, table]
    once, twice = ({name: [] for name in commands} for _ in range(2))
    for _ in range(rounds):
        for name, command in commands.items():
            once[name].append(spent(command(file)))
            twice[name].append(spent(command(longer)))
    size = file.stat().st_size
    peer, _ = middle(once["R fread + lm"])
    print(f"{rows:,} rows, {size / 1e6:.1f} MB")
    failed = False
    for name in commands:
        (seconds, memory), (seconds_twice, _) = middle(once[name]), middle(twice[name])
        print(f"{name:19} {seconds:6.2f} s, {seconds / peer:4.2f} of R's; {memory / 1e6:5.0f} MB, "
              f"{memory / size:4.2f} of the table; {seconds_twice / seconds:4.2f} times the time for twice the rows")
        own = name in COMMANDS
        failed |= own and (seconds > MOST_TIME * peer or memory > MOST_MEMORY * size)
    sys.exit(failed)


if __name__ == "__main__":
    main()
