"""Parquet and Arrow files of windfall read by pyarrow, polars and DuckDB; called by check-columns."""

import csv
import datetime
import subprocess
import sys
import tempfile
from pathlib import Path

import duckdb
import polars
import pyarrow
import pyarrow.ipc
import pyarrow.parquet

program = str(Path(sys.argv[1]).resolve())
law = "kuwabara-kono(k=394931,c=681)"
SCENE = """format = 1
materials = ["apple", "steel"]
[scene]
title = "Apples on a plate"
end = "0.5 s"
[[contacts]]
between = ["apple", "apple"]
law = "hertz(k=7e5)"
effective_radius = "19 mm"
[[contacts]]
between = ["apple", "steel"]
law = "hertz(k=1e6)"
effective_radius = "38 mm"
[[fruit]]
name = "apples"
material = "apple"
count = 8
diameter = "75 mm"
density = "840 kg/m^3"
lattice = { low = [0.1, 0.1, 0.1], high = [0.5, 0.5, 0.4] }
[[walls]]
name = "=plate, of \\"steel\\""
material = "steel"
plate = { corner = [0, 0, 0], edges = [[1, 0, 0], [0, 1, 0]] }
[record]
frames = "50 ms"
"""


def run(folder, *words):
    subprocess.run([program, *words], cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)


def same(cell, text, single):
    """Whether a cell is what CSV says."""
    if cell is None or text == "":
        return cell is None and text == ""
    if isinstance(cell, bool):
        return str(cell).lower() == text
    if isinstance(cell, float):
        # The digits of single precision are those that tell its values apart.
        return abs(cell - float(text)) <= 6e-8 * abs(cell) if single else cell == float(text)
    # windfall keeps a spreadsheet from running a cell as a formula.
    return str(cell) == text.removeprefix("'")


def compare(name, folder, units, optional=()):
    """Compares the files of a table with its CSV; rows and columns."""
    parquet, arrow = folder / f"{name}.parquet", folder / f"{name}.arrow"
    with open(folder / f"{name}.csv", newline="") as file:
        header, *rows = csv.reader(file)
    table = pyarrow.parquet.read_table(parquet)
    other = pyarrow.ipc.open_file(str(arrow)).read_all()
    assert table.equals(other) and table.schema.equals(other.schema, check_metadata=True), f"{name}: files differ"
    about = {key.decode(): value.decode() for key, value in table.schema.metadata.items()}
    assert about["table"] and about["schema"] == "1" and about["windfall"], about
    for column, unit in units.items():
        found = table.schema.field(column).metadata.get(b"unit", b"").decode()
        assert found == unit, f"{name}: {column} in {found}"
    missing = [own for own in table.column_names if own not in header]
    assert all(table[own].null_count == table.num_rows for own in missing), f"{name}: CSV lacks {missing}"
    assert set(header) <= set(table.column_names), f"{name}: {set(header) - set(table.column_names)}"
    sources = {
        "pyarrow": table.to_pydict(),
        "polars": polars.read_parquet(parquet).to_dict(as_series=False),
        "polars, Arrow": polars.read_ipc(arrow).to_dict(as_series=False),
        "DuckDB": {
            own[0]: values
            for own, values in zip(
                duckdb.sql(f"select * from '{parquet}' limit 0").description,
                zip(*duckdb.sql(f"select * from '{parquet}'").fetchall()),
            )
        },
    }
    for reader, columns in sources.items():
        for place, column in enumerate(header):
            single = table.schema.field(column).type == pyarrow.float32()
            for number, (cell, row) in enumerate(zip(columns[column], rows, strict=True)):
                assert same(cell, row[place], single), f"{name}: {reader}, row {number}, {column}: {cell!r}, {row[place]!r}"
    print(f"{name}: {len(rows)} rows, {len(header)} columns of CSV, {table.num_columns} of Parquet: the same in {', '.join(sources)}")
    # The same table twice is the same file.
    return parquet.read_bytes(), arrow.read_bytes()


with tempfile.TemporaryDirectory() as name:
    folder = Path(name)
    run(folder, "simulate", "pendulum", "--law", law, "--specimens", "6", "--repeats", "3", "--recordings", "study")
    run(folder, "simulate", "tap", "taps", "--fruit", "4")
    (folder / "scene.toml").write_text(SCENE)
    run(folder, "scene", "run", "scene.toml")
    laws = ["--law", "kuwabara-kono", "--law", "hertz", "--law", "tsuji"]
    tables = {
        "fits": (["fit", "study", *laws], {"peak_force_N": "N", "impact_velocity_sd_m_s": "m/s", "k": ""}),
        "taps": (["fit", "taps"], {"acoustic_frequency_Hz": "Hz"}),
        "events": (["scene", "table", "scene.run", "events"], {"absorbed_energy_J": "J", "static": ""}),
        "fruit": (["scene", "table", "scene.run", "fruit"], {"mass_kg": "kg"}),
        "frames": (["scene", "table", "scene.run", "frames"], {"velocity_x_m_s": "m/s"}),
    }
    for table, (words, units) in tables.items():
        before = None
        for _ in range(2):
            for ending in ["parquet", "arrow", "csv"]:
                run(folder, *words, "--out", f"{table}.{ending}")
            found = compare(table, folder, units) if before is None else tuple((folder / f"{table}.{own}").read_bytes() for own in ["parquet", "arrow"])
            assert before in (None, found), f"{table}: the same table is another file"
            before = found


def foreign(folder):
    """Tables that other programs write, read by `windfall summary` as their CSV is."""
    days = [datetime.date(2026, 11, 1 + n % 28) for n in range(60)]
    table = polars.DataFrame(
        {
            "variety": ["Gala", "Fuji", None] * 20,
            "firmness_N": [70.0 + n / 7 if n % 11 else None for n in range(60)],
            "drops": [n % 4 - 1 for n in range(60)],
            "ripe": [n % 3 == 0 for n in range(60)],
            "day": days,
            "at": [datetime.datetime(2026, 11, 1, 8, n, 30) for n in range(60)],
        },
        schema_overrides={"drops": polars.Int16, "variety": polars.Categorical},
    )
    table.write_csv(folder / "table.csv", datetime_format="%Y-%m-%dT%H:%M:%S")
    arrow = table.to_arrow()
    for compression in ["zstd", "snappy", "lz4", "gzip", "uncompressed"]:
        table.write_parquet(folder / f"polars-{compression}.parquet", compression=compression)
    table.write_ipc(folder / "polars.arrow")
    table.to_pandas().to_parquet(folder / "pandas.parquet")
    pyarrow.parquet.write_table(arrow, folder / "pyarrow.parquet", row_group_size=7, version="1.0")
    pyarrow.parquet.write_table(arrow, folder / "pages.parquet", data_page_version="2.0", use_dictionary=False)
    duckdb.sql(f"copy (select * from arrow) to '{folder}/duckdb.parquet' (format parquet)")
    (folder / "parts").mkdir()
    for part in range(3):
        table[20 * part : 20 * (part + 1)].write_parquet(folder / "parts" / f"{part}.parquet")

    def summary(name, *by):
        words = ["summary", name, "--value", "firmness_N", "--by", *by, "--format", "json"]
        found = subprocess.run([program, *words], cwd=folder, capture_output=True, text=True)
        assert found.returncode == 0, f"{name}: {found.stderr}"
        return found.stdout.replace(name, "")

    groups = ["variety", "drops", "ripe", "day", "at"]
    expected = {by: summary("table.csv", by) for by in groups}
    names = sorted(own.name for own in folder.iterdir() if own.suffix in (".parquet", ".arrow") or own.name == "parts")
    for name in names:
        # pandas has no days, only instants.
        for by in [own for own in groups if (own, name) != ("day", "pandas.parquet")]:
            assert summary(name, by) == expected[by], f"{name} by {by}"
    print(f"read as their CSV is: {', '.join(names)}")
    nested = polars.DataFrame({"firmness_N": [1.0, 2.0], "spots": [[1, 2], [3]]})
    nested.write_parquet(folder / "nested.parquet")
    words = [program, "summary", "nested.parquet", "--value", "firmness_N"]
    refused = subprocess.run(words, cwd=folder, capture_output=True, text=True)
    assert refused.returncode != 0 and "the column spots is of type" in refused.stderr, refused
    print(f"refused: {refused.stderr.strip()}")


with tempfile.TemporaryDirectory() as name:
    foreign(Path(name))
