"""Gives windfall hostile names and parses what it writes with the parsers of each language.

    scripts/names PROGRAM [NUMBER [SEED [TARGET...]]]     200 names, seed 1, all targets

What is parsed must have the same active code with hostile names as with plain ones, and the
names must come back wherever they stand as data:

    decks     contacts of a scene for YADE (Python's ast), Chrono and MercuryDPM (the lexer of
              the compiler, and -fsyntax-only), Adams and EDEM (their rules of comments and tables)
    engines   decks for LAMMPS and LIGGGHTS, run by both, which echo what they act on
    campaign  report (html5lib, and a browser where there is one), figures (expat), tables
              (Python's csv) and law card (tomllib) of a campaign
    tables    cells of any table
    changes   campaign.toml and impacts.csv as the page changes them
    shell     commands that are shown, run by bash
    scenes    tables, pictures, VTK files and pages of scenes and studies
    samples   names of channels in CSV and in files for NumPy

Prints how many names were parsed back, and how many windfall refused; exit status 1 if anything
was found. Needs Python 3.11, html5lib, g++, bash, lmp and liggghts.
"""

import random
import sys
import tempfile
import time
from pathlib import Path

from campaigns import check_campaign
from check import Check
from decks import check_decks
from engines import check_engines
from others import check_changes, check_samples, check_scenes, check_shell, check_tables

TARGETS = {
    "decks": check_decks,
    "engines": check_engines,
    "campaign": check_campaign,
    "tables": check_tables,
    "changes": check_changes,
    "shell": check_shell,
    "scenes": check_scenes,
    "samples": check_samples,
}


def main(program, number=200, seed=1, *targets):
    with tempfile.TemporaryDirectory() as scratch:
        for name in targets or TARGETS:
            start = time.monotonic()
            folder = Path(scratch) / name
            folder.mkdir()
            check = Check(program, folder, random.Random(f"{seed} {name}"), int(number))
            TARGETS[name](check)
            check.unrun(folder, name)
            for target, (parsed, refused) in check.counts.items():
                print(f"{target:12} {parsed:5} parsed back, {refused:5} refused")
            print(f"  {time.monotonic() - start:.0f} s", flush=True)
            yield from check.faults


if __name__ == "__main__":
    faults = list(main(*sys.argv[1:]))
    print(*faults[:20], sep="\n")
    print(f"{len(faults)} found")
    sys.exit(bool(faults))
