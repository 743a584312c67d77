"""The page of the guide on R, MATLAB and Octave: what it shows is what is printed.

    python3 clients/page.py [--write]

Code blocks of a language run one after the other in an empty folder; each is compared with the
block of text behind it, in which "…" stands for anything within a line. --write replaces these
blocks by what is printed now.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "guide" / "src" / "r_matlab.md"
BLOCK = re.compile(r"^```(r|octave)\n(.*?)^```\n\n```text\n(.*?)^```$", re.MULTILINE | re.DOTALL)
END = "-- end of block --"
RUN = {
    "r": (["Rscript"], f"cat('{END}\\n')"),
    "octave": (
        ["octave-cli", "--no-gui", "--quiet", "--path", str(ROOT / "clients" / "matlab")],
        f"disp('{END}');",
    ),
}


def printed(language, blocks):
    """What each block prints."""
    command, mark = RUN[language]
    with tempfile.TemporaryDirectory() as folder:
        script = Path(folder) / "page.txt"
        script.write_text("".join(f"{block}{mark}\n" for block in blocks), encoding="utf-8")
        done = subprocess.run(
            [*command, str(script)], capture_output=True, text=True, cwd=folder, timeout=300
        )
    if done.returncode != 0:
        sys.exit(f"{PAGE.name}: {language} failed:\n{done.stdout}{done.stderr}")
    return done.stdout.split(f"{END}\n")[:-1]


def same(shown, found):
    return re.fullmatch("[^\n]*".join(map(re.escape, shown.split("…"))), found) is not None


def main(write):
    text = PAGE.read_text(encoding="utf-8")
    blocks = BLOCK.findall(text)
    found = {
        language: iter(printed(language, [code for own, code, _ in blocks if own == language]))
        for language in RUN
    }
    wrong = 0
    for language, code, shown in blocks:
        now = next(found[language])
        if same(shown, now):
            continue
        wrong += 1
        text = text.replace(f"{code}```\n\n```text\n{shown}```", f"{code}```\n\n```text\n{now}```")
        if not write:
            print(f"{PAGE.name}: shown:\n{shown}\nprinted:\n{now}")
    if write:
        PAGE.write_text(text, encoding="utf-8")
    elif wrong or len(blocks) != text.count("```r\n") + text.count("```octave\n"):
        sys.exit(f"{PAGE.name}: {wrong} blocks print something else than is shown")


if __name__ == "__main__":
    main("--write" in sys.argv[1:])
