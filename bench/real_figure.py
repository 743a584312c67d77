"""A sheet of small figures: recordings, contacts counted by hand, and those of windfall."""

import csv
import html
import pathlib
import subprocess
import tempfile

WIDTH, HEIGHT, COLUMNS = 300, 92, 3
POINTS = 150  # slices, of which each shows its smallest and largest sample
PLOT = (8, 20, 284, 52)  # left, top, width, height

STYLE = """
.s{fill:none;stroke:#33506b;stroke-width:.8}
.h{fill:#1a7f37}.w{fill:#b3261e}
text{font:10px sans-serif;fill:#24292f}
.p{fill:#fff}
"""


def samples(program, row, folder):
    """Times and values of the channel of a row, as windfall reads them."""
    (recording,) = folder.iterdir()
    with tempfile.TemporaryDirectory() as scratch:
        export = pathlib.Path(scratch) / "samples.csv"
        subprocess.run([program, "inspect", str(recording), "--export", str(export)], check=True, capture_output=True)
        with open(export, newline="", encoding="utf-8") as file:
            head, *rows = csv.reader(file)
    named = [name.rpartition(" [")[0] or name for name in head]
    value = (head if row["channel"] in head else named).index(row["channel"])
    clock, factor = row["time"], 1.0
    if clock.endswith(":ms"):
        clock, factor = clock[:-3], 1e-3
    if row["rate"]:
        rate = float(row["rate"].split()[0]) * {"Hz": 1.0, "kHz": 1e3}[row["rate"].split()[1]]
    elif clock:
        when = (head if clock in head else named).index(clock)
    else:
        when = max(k for k, name in enumerate(head[:value]) if name.startswith("time"))
    pairs = []
    for k, cells in enumerate(rows):
        if cells[value].strip() and (row["rate"] or cells[when].strip()):
            pairs.append((k / rate if row["rate"] else float(cells[when]) * factor, float(cells[value])))
    return pairs


def line(pairs, across, up):
    """A path through the smallest and largest sample of each slice."""
    step = max(1, -(-len(pairs) // POINTS))
    kept = []
    for k in range(0, len(pairs), step):
        part = pairs[k : k + step]
        ends = {min(part, key=lambda p: p[1]), max(part, key=lambda p: p[1])}
        kept += sorted(ends)
    return "M" + " ".join(f"{across(t):.1f},{up(v):.1f}" for t, v in kept)


def panel(program, row, folder, hand, found):
    pairs = samples(program, row, folder)
    left, top, width, height = PLOT
    first, last = pairs[0][0], pairs[-1][0]
    low, high = min(v for _, v in pairs), max(v for _, v in pairs)

    def across(time):
        return left + width * (time - first) / ((last - first) or 1)

    def up(value):
        return top + height * (high - value) / ((high - low) or 1)

    marks = [f'<path class="h" d="M{across(t):.1f},{top + height + 3}l-3,7h6z"/>' for t in hand]
    inside = [t for t in found or [] if first <= t <= last]
    marks += [f'<path class="w" d="M{across(t):.1f},{top - 1}l-3,-6h6z"/>' for t in inside]
    span = f"{last - first:.3g} s"
    return (
        f'<text x="{left}" y="10">{html.escape(row["name"])}</text>'
        f'<text x="{left + width}" y="10" text-anchor="end">{span}{"" if found is not None else ", not said"}</text>'
        f'<path class="s" d="{line(pairs, across, up)}"/>' + "".join(marks)
    )


def sheet(program, panels):
    """The whole sheet as SVG."""
    rows = -(-len(panels) // COLUMNS)
    drawn = []
    for k, each in enumerate(panels):
        x, y = (k % COLUMNS) * WIDTH, (k // COLUMNS) * HEIGHT
        drawn.append(f'<g transform="translate({x},{y})">{panel(program, *each)}</g>\n')
    size = f"{COLUMNS * WIDTH} {rows * HEIGHT}"
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size}">\n<style>{STYLE}</style>\n'
        f'<rect class="p" width="{COLUMNS * WIDTH}" height="{rows * HEIGHT}"/>\n' + "".join(drawn) + "</svg>\n"
    )
