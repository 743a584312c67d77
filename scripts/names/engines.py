"""Decks for LAMMPS and LIGGGHTS, run by both."""

import os
import re
import subprocess
from concurrent.futures import ThreadPoolExecutor

from check import JOBS, parts, plain
from decks import accepted_names, scene_text

def check_engines(check):
    names = accepted_names(check)
    refused = len(check.names) - len(names)
    size = 60
    groups = parts(names, size)
    groups[-1] = (groups[-1] + names)[:size]
    for engine, program in [("lammps", "lmp"), ("liggghts", "liggghts")]:
        found = run_decks(check, engine, program, groups)
        wanted = run_decks(check, engine + "-plain", program, [plain(size)] * len(groups))
        for group, own, usual in zip(groups, found, wanted):
            check.expect(own == usual, engine, "other lines are acted on", *different(own, usual), group)
        check.expect(len(found) == len(groups), engine, "it stopped at a deck", found[-1][-3:])
        check.count(engine, len(names), refused)


def different(own, usual):
    pairs = zip(own + ["(end)"], usual + ["(end)"])
    return next(((a, b) for a, b in pairs if a != b), ("", ""))


def run_decks(check, engine, program, groups):
    """Lines of each deck that the engine acts on, all decks in one run of it."""
    folder = check.folder(engine)
    kind = engine.removesuffix("-plain")

    def exported(numbered):
        number, names = numbered
        file = folder / f"{number}.toml"
        file.write_text(scene_text(names[0], names[1:4], names[4:]), newline="")
        check.run("scene", "export", file, "--engine", kind, "--out", folder / str(number))

    with ThreadPoolExecutor(JOBS) as pool:
        list(pool.map(exported, enumerate(groups)))
    decks = [f"shell cd {own}\ninclude in.scene\nclear\nshell cd ..\nprint DONE-{own}\n" for own in range(len(groups))]
    (folder / "in.all").write_text("".join(decks))
    subprocess.run([program, "-in", "in.all", "-echo", "log", "-log", "log", "-screen", "none"], cwd=folder,
                   capture_output=True, timeout=600, env=engine_environment())
    check.unrun(folder, engine)
    log = (folder / "log").read_bytes().decode(errors="replace")
    runs = re.split(r"\nprint DONE-\d+\n", log)[:-1]
    # A comment is echoed as the line that it is: what is not drawn into it follows.
    return [[line for line in run.split("\n") if not line.startswith("#") and not TIMES.match(line)] for run in runs]


# What an engine tells of its times, which differ from run to run.
TIMES = re.compile(
    r" *(read_data CPU = |Loop time of |Total wall time|Setting up run at |[\d.]+% CPU use|Performance:"
    r"|(Pair|Neigh|Comm|Output|Outpt|Modify|Other) +(time|\|)|(Memory|Per MPI rank memory)|shell cd \d+$)"
)


def engine_environment():
    return {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_NUM_THREADS": "1"}
