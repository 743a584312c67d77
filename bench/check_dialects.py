"""Reads one table in many dialects of text with windfall and with pandas.

Usage: check_dialects.py WINDFALL SCRATCH

WINDFALL is the program, SCRATCH a folder for the tables. pandas is told every
dialect; windfall has to find it out. Each table is one of

    equal     every sample has the same bits
    told      windfall reads it differently and says what it assumed
    refused   windfall does not read it
    WRONG     windfall reads it differently and says nothing

Prints the counts; exit status 1 if any is wrong, or if a spelling of a missing
value is not taken as one.
"""

import collections
import itertools
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pandas as pd

SEPARATORS = {"comma": ",", "semicolon": ";", "tab": "\t", "bar": "|", "blanks": " "}
ENCODINGS = {"utf-8": "utf-8", "utf-8 with mark": "utf-8-sig", "utf-16": "utf-16", "windows-1252": "cp1252"}
LINE_ENDS = {"LF": "\n", "CRLF": "\r\n", "CR": "\r"}
HEADERS = ("names", "names and units", "none", "preamble and names")
COMMENTS = (None, "#", "%")

SPELLINGS = (
    "NaN", "nan", "NA", "N/A", "#N/A", "null", "NULL", "None", "n/a", "-nan", "<NA>",
    "-", "--", ".", "?", "OVLD", "OVL", "OL", "OVERLOAD", "Over", "#DIV/0!", "1.#QNAN",
    "-1.#IND", "", "Inf",
)


def numbers(rows=24):
    """A force of an impact, with signs, exponents' worth of range and every digit."""
    random = np.random.default_rng(1)
    time = np.arange(rows) / 20_000
    force = 40 * np.sin(np.pi * np.arange(rows) / rows) + random.normal(0, 0.1, rows)
    position = random.normal(0, 1e-6, rows)
    return np.column_stack([time, force, position])


def text_of(table, separator, decimal, quoted, line_end, header, comment, digits):
    mark = SEPARATORS[separator]

    def cell(text):
        return f'"{text}"' if quoted else text

    def number(value):
        text = repr(float(value)) if digits == "all" else f"{value:.3f}"
        return cell(text.replace(".", decimal))

    lines = []
    if comment:
        lines += [f"{comment} recorded by a rig", f"{comment} 24 rows"]
    if header == "preamble and names":
        # pandas loses a row behind a blank line where lines end with CR.
        lines += [mark.join([cell("Operator"), cell("Müller")]), "" if line_end != "CR" else "Rig"]
    if header != "none":
        lines.append(mark.join(map(cell, ["Zeit", "Kraft", "Weg"])))
    if header == "names and units":
        lines.append(mark.join(map(cell, ["s", "N", "µm"])))
    lines += [mark.join(map(number, row)) for row in table]
    return LINE_ENDS[line_end].join(lines) + LINE_ENDS[line_end]


def read_by_windfall(program, path, *options):
    out = path.with_name(path.stem + "-read.npy")
    done = subprocess.run(
        [program, "inspect", path, "--export", out, "--format", "json", *options],
        capture_output=True, text=True,
    )
    if done.returncode:
        return None, done.stderr
    structured = np.load(out)
    return np.column_stack([structured[name] for name in structured.dtype.names]), done.stdout


def bits(table):
    table = np.ascontiguousarray(table, dtype=np.float64)
    plain = table.view(np.uint64).copy()
    plain[np.isnan(table)] = 0x7FF8000000000000
    return plain


def judge(program, path, expected):
    found, told = read_by_windfall(program, path)
    if found is None:
        return "refused"
    if found.shape == expected.shape and np.array_equal(bits(found), bits(expected)):
        return "equal"
    return "told" if '"decimal-or-thousands"' in told or '"missing-samples"' in told else "WRONG"


def dialects():
    """Every separator with every decimal mark, quoting and line end, twice, with encodings,
    headers, comments and digits in turn."""
    product = itertools.product(SEPARATORS, (".", ","), (False, True), LINE_ENDS, (1, 2))
    for index, (separator, decimal, quoted, line_end, turn) in enumerate(product):
        # A comma can stand before decimals and between cells only in quotes.
        if separator == "comma" and decimal == "," and not quoted:
            continue
        names = list(ENCODINGS)
        yield {
            "separator": separator, "decimal": decimal, "quoted": quoted, "line_end": line_end,
            "encoding": names[(index + turn) % 4],
            "header": HEADERS[(index // 2 + turn) % 4],
            "comment": COMMENTS[(index + turn) % 3],
            "digits": ("all", "three")[(index // 3 + turn) % 2],
        }


def expected_by_pandas(path, dialect):
    skipped = 2 if dialect["comment"] else 0
    skipped += {"none": 0, "names": 1, "names and units": 2, "preamble and names": 3}[dialect["header"]]
    separator = SEPARATORS[dialect["separator"]]
    table = pd.read_csv(
        path, sep=r"\s+" if dialect["separator"] == "blanks" else separator,
        decimal=dialect["decimal"], encoding=ENCODINGS[dialect["encoding"]], header=None,
        skiprows=skipped, float_precision="round_trip", skip_blank_lines=False,
    )
    return table.to_numpy(dtype=float)


def check_dialect(program, scratch, index, dialect):
    settings = {key: value for key, value in dialect.items() if key not in ("encoding",)}
    path = scratch / f"dialect-{index}.csv"
    path.write_bytes(text_of(numbers(), **settings).encode(ENCODINGS[dialect["encoding"]]))
    try:
        expected = expected_by_pandas(path, dialect)
    except Exception as error:
        return "pandas does not", f"{dialect}: {error}"
    return judge(program, path, expected), str(dialect)


def check_spelling(program, scratch, index, spelling, decimal):
    mark = "," if decimal == "." else ";"
    table = numbers()
    lines = ["t,F,x".replace(",", mark)]
    for row, values in enumerate(table):
        cells = [repr(float(value)).replace(".", decimal) for value in values]
        if row in (3, 17):
            cells[1] = spelling
        lines.append(mark.join(cells))
    path = scratch / f"spelling-{index}-{ord(decimal)}.csv"
    path.write_text("\n".join(lines) + "\n")
    expected = pd.read_csv(
        path, sep=mark, decimal=decimal, float_precision="round_trip", na_values=[spelling]
    ).to_numpy(dtype=float)
    found, told = read_by_windfall(program, path)
    equal = found is not None and np.array_equal(bits(found), bits(expected))
    said = spelling == "" or (f'\\"{spelling}\\"' in told and '"missing-samples"' in told)
    return ("equal and said" if equal and said else "WRONG"), f"{spelling!r} {decimal}"


def check_doubtful(program, scratch, separator, decimal):
    """Nothing but three digits behind a mark: decimals are taken, and asked about."""
    values = np.random.default_rng(2).uniform(10, 99, (24, 2)).round(3)
    quote = '"' if separator == "comma" and decimal == "," else ""
    lines = [
        SEPARATORS[separator].join(quote + f"{x:.3f}".replace(".", decimal) + quote for x in row)
        for row in values
    ]
    path = scratch / f"doubtful-{separator}-{ord(decimal)}.csv"
    path.write_text("\n".join(lines) + "\n")
    expected = pd.read_csv(
        path, sep=SEPARATORS[separator], decimal=decimal, header=None, float_precision="round_trip"
    ).to_numpy(dtype=float)
    found, told = read_by_windfall(program, path)
    equal = found is not None and np.array_equal(bits(found), bits(expected))
    # A point between commas without quotes cannot stand between groups.
    asked = '"decimal-or-thousands"' in told or (separator, decimal) == ("comma", ".")
    return ("equal and asked" if equal and asked else "WRONG"), f"{separator} {decimal}"


def main():
    program, scratch = sys.argv[1], Path(sys.argv[2])
    scratch.mkdir(parents=True, exist_ok=True)
    wrong = False
    with ThreadPoolExecutor(2) as pool:
        spellings = list(itertools.product(SPELLINGS, ".,"))
        jobs = [pool.submit(check_spelling, program, scratch, i, *s) for i, s in enumerate(spellings)]
        wrong |= report(f"spellings of a missing value ({len(SPELLINGS)}, two decimal marks)", jobs)
        doubtful = list(itertools.product(SEPARATORS, ".,"))
        jobs = [pool.submit(check_doubtful, program, scratch, *d) for d in doubtful]
        wrong |= report("marks before decimals or groups", jobs)
        jobs = [pool.submit(check_dialect, program, scratch, i, d) for i, d in enumerate(dialects())]
        wrong |= report("dialects", jobs)
    return 1 if wrong else 0


def report(what, jobs):
    results = [job.result() for job in jobs]
    counts = collections.Counter(result for result, _ in results)
    print(f"{what}: {len(results)} tables; " + ", ".join(f"{n} {name}" for name, n in counts.items()))
    for result, which in results:
        if result not in ("equal", "equal and said", "equal and asked"):
            print(f"  {result}: {which}")
    return counts["WRONG"] > 0


if __name__ == "__main__":
    sys.exit(main())
