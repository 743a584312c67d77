"""Reads recordings with other programs and compares every sample with windfall.

Usage: check_formats.py DUMP_CHANNELS DATA SCRATCH

DUMP_CHANNELS is the example of that name of the crate windfall-formats, DATA a
folder of recordings, SCRATCH a folder for recordings made here. Names, lengths,
times and all bits of all samples are compared, by a checksum that depends on the
order. Exit status 1 if anything differs.
"""

import datetime
import json
import struct
import subprocess
import sys
import zipfile
from pathlib import Path

import h5py
import numpy as np
import lvm_read
import nptdms
import pandas as pd
import pyuff
import scipy.io
import scipy.io.wavfile
import soundfile
import xlsxwriter


def checksum(samples):
    samples = np.ascontiguousarray(samples, dtype=np.float64)
    bits = samples.view(np.uint64).copy()
    bits[np.isnan(samples)] = 0x7FF8000000000000
    factors = np.arange(len(samples), dtype=np.uint64) * np.uint64(2) + np.uint64(1)
    with np.errstate(over="ignore"):
        return f"{int((bits * factors).sum(dtype=np.uint64)):016x}"


def channel(name, samples, interval=None):
    return {"name": name, "length": len(samples), "checksum": checksum(samples), "interval": interval}


def read_tdms(path):
    channels = []
    for group in nptdms.TdmsFile.read(path).groups():
        for part in group.channels():
            if part.dtype.kind in "iufb" and len(part) > 0:
                interval = part.properties.get("wf_increment") or None
                channels.append(channel(f"{group.name}/{part.name}", part[:], interval))
    return channels


def read_lvm(path):
    data = lvm_read.read(str(path), read_from_pickle=False, dump_file=False)
    segment = data[0]
    columns = segment["data"]
    if segment["Channel names"][-1] == "Comment" and columns.shape[1] == len(segment["Channel names"]):
        columns = columns[:, :-1]
    # Several measurements under one header are segments in windfall.
    header = next(line for line in path.read_text("latin-1").splitlines() if line.startswith("Samples"))
    rows = max(int(cell) for cell in header.split()[1:])
    parts = 1 if rows < 2 or len(columns) % rows else len(columns) // rows
    return [channel(None, part[:, i]) for part in np.split(columns, parts) for i in range(columns.shape[1])]


def read_wav(path):
    try:
        samples, rate = soundfile.read(path, dtype="float64", always_2d=True)
    except soundfile.LibsndfileError:
        rate, samples = scipy.io.wavfile.read(path)
        samples = np.atleast_2d(samples.T).T
        kind = samples.dtype
        samples = samples.astype(np.float64)
        if kind == np.uint8:
            samples = (samples - 128) / 128
        elif kind.kind == "i":
            samples /= 2.0 ** (8 * kind.itemsize - 1)
    return [channel(f"channel {i + 1}", samples[:, i], 1 / rate) for i in range(samples.shape[1])]


def read_text(path, **options):
    table = pd.read_csv(path, **options)
    return [channel(None, table[name].to_numpy(float)) for name in table.columns]


def add_matrix(channels, name, values):
    """As windfall names the columns of a variable."""
    if values.dtype.kind == "c":
        add_matrix(channels, f"{name} (real)", values.real)
        add_matrix(channels, f"{name} (imaginary)", values.imag)
        return
    if values.dtype.kind not in "iufb" or values.size == 0:
        return
    if values.ndim == 1 or min(values.shape) == 1:
        channels.append(channel(name, values.ravel()))
        return
    if values.shape[1] > 64 and values.shape[0] < values.shape[1]:
        values = values.T
    for i in range(values.shape[1]):
        channels.append(channel(f"{name}/{i + 1}", values[:, i]))


def read_mat(path):
    channels = []

    def walk(name, value):
        if scipy.sparse.issparse(value):
            return
        if isinstance(value, np.ndarray) and value.dtype.names:
            for i, element in enumerate(value.ravel(order="F")):
                for field in value.dtype.names:
                    place = field if value.size == 1 else f"{i + 1}/{field}"
                    walk(f"{name}/{place}", element[field])
        elif isinstance(value, np.ndarray) and value.dtype == object:
            for i, element in enumerate(value.ravel(order="F")):
                walk(f"{name}/{i + 1}", element)
        elif isinstance(value, np.ndarray):
            if value.ndim <= 2:
                add_matrix(channels, name, value)

    for name, value in scipy.io.loadmat(path).items():
        # SciPy calls a variable without a name "None".
        if not name.startswith("__") and name != "None":
            walk(name, value)
    # Single numbers are properties, unless the file has nothing else.
    longer = [c for c in channels if c["length"] > 1]
    return longer or channels


def read_uff(path):
    channels = []
    sets = pyuff.UFF(str(path)).read_sets()
    for record in sets if isinstance(sets, list) else [sets]:
        if record.get("type") != 58:
            continue
        data = np.asarray(record["data"])
        even = record.get("abscissa_spacing") == 1
        interval = record.get("abscissa_inc") if even and record.get("abscissa_spec_data_type") == 17 else None
        if not even:
            channels.append(channel(None, np.asarray(record["x"])))
        if np.iscomplexobj(data):
            channels += [channel(None, data.real, interval), channel(None, data.imag, interval)]
        else:
            channels.append(channel(None, data, interval))
    return channels


def read_sigrok(path):
    archive = zipfile.ZipFile(path)
    settings = dict(line.split("=", 1) for line in archive.read("metadata").decode().splitlines() if "=" in line)
    parts = [n for n in archive.namelist() if n.startswith("logic-1-")]
    raw = b"".join(archive.read(n) for n in sorted(parts, key=lambda n: int(n.rsplit("-", 1)[1])))
    rows = np.frombuffer(raw, np.uint8).reshape(-1, int(settings["unitsize"]))
    rate = {"MHz": 1e6, "kHz": 1e3}.get(settings.get("samplerate", " ").split(" ")[1])
    interval = rate and 1 / (float(settings["samplerate"].split()[0]) * rate)
    bits = [(int(k[5:]) - 1, v) for k, v in settings.items() if k.startswith("probe")]
    return [channel(v, (rows[:, b // 8] >> (b % 8)) & 1, interval) for b, v in bits]


def read_hdf5(path):
    """Arrays of one dimension, and vectors of MATLAB; windfall has no others here."""
    channels = []

    def visit(name, item):
        inner = name.startswith("#") or not isinstance(item, h5py.Dataset)
        if not inner and item.dtype.kind == "O":
            raise ValueError("it holds references, which are not followed here")
        sparse = not inner and "MATLAB_sparse" in item.parent.attrs
        if inner or sparse or item.dtype.kind not in "iuf" or item.size < 2:
            return
        if item.attrs.get("MATLAB_class", b"double") not in (b"char", b"string"):
            channels.append(channel(name, item[()].ravel().astype(float)))

    with h5py.File(path) as file:
        file.visititems(visit)
    return channels


def make_hdf5(folder):
    """Every layout of data sets and both generations of the format."""
    random = np.random.default_rng(2)
    for version in ("earliest", "latest"):
        with h5py.File(folder / f"{version}.h5", "w", libver=version) as file:
            values = random.normal(size=5000)
            file["contiguous"] = values
            file["group/inner/32 bit"] = values.astype("f4")
            file["big endian"] = values.astype(">f8")
            for kind in ("i1", "u2", ">i4", "u8"):
                file[f"integers/{kind}"] = (values * 50).astype(kind)
            chunked = {
                "chunked": {"chunks": (700,)},
                "gzip": {"chunks": (512,), "compression": "gzip", "shuffle": True, "fletcher32": True},
                "lzf": {"chunks": (512,), "compression": "lzf"},
                "growing": {"chunks": (256,), "maxshape": (None,)},
                "one chunk": {"chunks": (5000,), "compression": "gzip"},
            }
            for name, options in chunked.items():
                file.create_dataset(f"chunks/{name}", data=values, **options)
            many = file.create_group("many")
            for i in range(60):
                many[f"channel {i:02}"] = values[: 10 + i]


def add_table(channels, before, behind, table):
    """Columns with numbers, as windfall names them; dates as seconds since the first."""
    for name in table.columns:
        values = table[name]
        if values.dtype.kind == "M":
            values = (values - values.iloc[0]) / datetime.timedelta(seconds=1)
        numbers = pd.to_numeric(values, errors="coerce")
        if numbers.notna().any():
            channels.append(channel(f"{before}{name}{behind}", numbers.to_numpy(float)))


def read_book(path):
    """Sheets that begin with the names of their columns."""
    sheets = pd.read_excel(path, sheet_name=None, engine="odf" if path.suffix == ".ods" else "openpyxl")
    channels = []
    for name, table in sheets.items():
        add_table(channels, f"{name}/" if len(sheets) > 1 else "", "", table)
    return channels


def read_zip(path):
    archive = zipfile.ZipFile(path)
    names = [n for n in archive.namelist() if n.endswith(".csv") and not n.startswith("meta/")]
    channels = []
    for name in names:
        with archive.open(name) as file:
            table = pd.read_csv(file, float_precision="round_trip")
        add_table(channels, f"{name[:-4]}/" if len(names) > 1 else "", "", table)
    return channels


def read_segments(path):
    """Tables below each other, each below two lines of its own, with the rows told in the first."""
    lines = path.read_text().splitlines()
    channels, at, number = [], 0, 0
    while at < len(lines):
        number += 1
        rows = int(lines[at].split()[-1])
        table = pd.read_csv(path, skiprows=at + 1, nrows=rows, float_precision="round_trip")
        add_table(channels, "", f" (segment {number})", table)
        at += rows + 3
    return channels


def read_npy(path):
    loaded = np.load(path)
    arrays = {"array": loaded} if isinstance(loaded, np.ndarray) else dict(loaded)
    channels = []
    for name, values in arrays.items():
        if values.dtype.names is None:
            if values.size > 1:
                add_matrix(channels, name, values)
            continue
        for field in values.dtype.names:
            add_matrix(channels, field if name == "array" else f"{name}/{field}", values[field])
    return channels


def make_tables(folder):
    """Spreadsheets by three programs, an archive as phyphox writes it, segments of a text."""
    random = np.random.default_rng(3)
    size = 20000
    force = random.normal(size=size) * 10.0 ** random.integers(-300, 300, size)
    table = pd.DataFrame({"Time (s)": np.arange(size) * 1e-4, "Force (N)": force, "count": random.integers(-9, 9, size)})
    gaps = table.copy()
    gaps.loc[gaps.index % 7 == 3, "Force (N)"] = np.nan
    moments = table.head(50).assign(When=pd.date_range("2024-11-19 23:59:58", periods=50, freq="100ms"))
    sheets = {"Run 1": table, "Run 2": gaps, "Clock": moments}
    for engine in ("openpyxl", "xlsxwriter"):
        with pd.ExcelWriter(folder / f"book_{engine}.xlsx", engine=engine) as writer:
            for name, sheet in sheets.items():
                sheet.to_excel(writer, sheet_name=name, index=False)
    with pd.ExcelWriter(folder / "book.ods", engine="odf") as writer:
        for name in ("Run 1", "Run 2"):
            sheets[name].head(2000).to_excel(writer, sheet_name=name, index=False)
    with xlsxwriter.Workbook(folder / "constant_memory.xlsx", {"constant_memory": True}) as book:
        sheet = book.add_worksheet("only")
        sheet.write_row(0, 0, ["Zeit (s)", "Kraft (N)"])
        for i in range(size):
            sheet.write_row(i + 1, 0, [i / 1024, float(np.float32(force[i] % 1))])
    with zipfile.ZipFile(folder / "phyphox.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("Accelerometer.csv", table.to_csv(index=False))
        archive.writestr("Gyroscope.csv", gaps.to_csv(index=False))
        archive.writestr("meta/device.csv", "property,value\nversion,1.2.0\n")
    with open(folder / "segments.csv", "w") as file:
        for rows in (300, 3, 1200):
            part = table.head(rows) if rows != 1200 else table.head(rows)[["Time (s)", "Force (N)"]]
            file.write(f"Test of {rows}\n{part.to_csv(index=False)}\n")


def make_numpy(folder):
    random = np.random.default_rng(4)
    values = random.normal(size=5000)
    record = np.zeros(5000, dtype=[("t", "<f8"), ("F", ">f4"), ("n", "<i2"), ("gap", "V3"), ("on", "?")])
    record["t"], record["F"], record["n"] = np.arange(5000) / 7, values, values * 100
    np.save(folder / "record.npy", record)
    np.save(folder / "vector.npy", values.astype(">f8"))
    np.save(folder / "columns.npy", values.reshape(-1, 4))
    np.save(folder / "fortran.npy", np.asfortranarray(values.reshape(-1, 4)))
    np.save(folder / "rows.npy", values.reshape(4, -1))
    kinds = {kind: (values * 50).astype(kind) for kind in ("i1", "i4", ">i8", "f4", "c8", "c16", "?")}
    kinds |= {kind: np.abs(values * 50).astype(kind) for kind in ("u1", "u2", "u4", ">u8")}
    np.savez(folder / "stored.npz", **kinds)
    np.savez_compressed(folder / "packed.npz", **{"run/F": values, "fs": 100.0, "record": record[["t", "F"]]})


PEERS = {".xlsx": read_book, ".ods": read_book, ".zip": read_zip, ".npy": read_npy, ".npz": read_npy, ".h5": read_hdf5, ".sr": read_sigrok, ".tdms": read_tdms, ".lvm": read_lvm, ".wav": read_wav, ".mat": read_mat, ".uff": read_uff}

TEXTS = {
    "2mps_sphere_1_100gPR_20kHz.csv": {},
    "2mps_sphere_1_40gDC_2kHz.csv": {},
    "pad_4mm.csv": {},
    "pad_4mm_v1.csv": {},
    "pad_40mm.csv": {},
    "bounce_train.csv": {},
    "author_tau_Fpeak_table.csv": {},
    "accel_1.csv": {"skiprows": 2, "header": None},
    "Dragon Skin 20.csv": {"sep": ";", "skiprows": 17},
    "Ecoflex 00-30.csv": {"sep": ";", "skiprows": 17},
    "HM_b04_12in_00.lvm": {"sep": "\t", "header": None},
    "HM_b04_12in_10.lvm": {"sep": "\t", "header": None},
    "acc_base_a0.txt": {"sep": " ", "skiprows": 1, "header": None},
    "acc_base_a1.txt": {"sep": " ", "skiprows": 1, "header": None},
    "acc_pcb_a0.txt": {"sep": " ", "skiprows": 1, "header": None},
    "acc_pcb_a1.txt": {"sep": " ", "skiprows": 1, "header": None},
    "sleepstudy.csv": {},
}


def peer_of(path):
    name = path.name
    if name == "segments.csv":
        return read_segments
    if name in TEXTS or name.startswith(("kiwi_", "mango_")):
        return lambda p: read_text(p, float_precision="round_trip", **TEXTS.get(name, {}))
    if path.suffix == ".mat" and h5py.is_hdf5(path):
        return read_hdf5
    return PEERS.get(path.suffix.lower())


# --- TDMS variants without public samples: made from the specification -----------


def tdms_text(text):
    text = text.encode()
    return struct.pack("<I", len(text)) + text


def tdms_property(name, value):
    if isinstance(value, str):
        return tdms_text(name) + struct.pack("<I", 0x20) + tdms_text(value)
    if isinstance(value, int):
        return tdms_text(name) + struct.pack("<II", 7, value)
    return tdms_text(name) + struct.pack("<Id", 10, value)


def tdms_object(path, index, properties=()):
    packed = b"".join(tdms_property(*p) for p in properties)
    return tdms_text(path) + index + struct.pack("<I", len(properties)) + packed


def tdms_segment(flags, objects, raw, unfinished=False):
    metadata = struct.pack("<I", len(objects)) + b"".join(objects)
    length = 0xFFFFFFFFFFFFFFFF if unfinished else len(metadata) + len(raw)
    return b"TDSm" + struct.pack("<IIQQ", flags, 4713, length, len(metadata)) + metadata + raw


NOTHING = struct.pack("<I", 0xFFFFFFFF)


def tdms_values(code, count):
    return struct.pack("<IIIQ", 20, code, 1, count)


def make_tdms(folder):
    random = np.random.default_rng(1)
    a, b = random.normal(size=1000), random.integers(-30000, 30000, 1000).astype("<i2")
    meta, new, data, woven, daqmx = 2, 4, 8, 32, 128
    file, group = tdms_object("/", NOTHING), tdms_object("/'g'", NOTHING)
    linear = [("NI_Number_Of_Scales", 1), ("NI_Scale[0]_Scale_Type", "Linear"),
              ("NI_Scale[0]_Linear_Slope", 3.0517578125e-4), ("NI_Scale[0]_Linear_Y_Intercept", 0.1),
              ("NI_Scale[0]_Linear_Input_Source", 0xFFFFFFFF)]
    polynomial = [("NI_Number_Of_Scales", 2), ("NI_Scale[0]_Scale_Type", "Polynomial"),
                  ("NI_Scale[0]_Polynomial_Coefficients_Size", 4),
                  *[(f"NI_Scale[0]_Polynomial_Coefficients[{i}]", 0.3 / (i + 1) ** 8) for i in range(4)],
                  ("NI_Scale[0]_Polynomial_Input_Source", 0xFFFFFFFF),
                  ("NI_Scale[1]_Scale_Type", "Table"), ("NI_Scale[1]_Table_Input_Source", 0),
                  ("NI_Scale[1]_Table_Pre_Scaled_Values_Size", 3), ("NI_Scale[1]_Table_Scaled_Values_Size", 3),
                  *[(f"NI_Scale[1]_Table_Pre_Scaled_Values[{i}]", v) for i, v in enumerate((-2.5, 0.5, 40.0))],
                  *[(f"NI_Scale[1]_Table_Scaled_Values[{i}]", v) for i, v in enumerate((-1.0, 0.25, 7.0))]]

    def two(scale_a=(), scale_b=()):
        return [file, group,
                tdms_object("/'g'/'a'", tdms_values(10, 1000), [("wf_increment", 5e-6), *scale_a]),
                tdms_object("/'g'/'it''s b'", tdms_values(2, 1000), [("unit_string", "N"), *scale_b])]

    rows = np.zeros(1000, dtype=[("a", "<f8"), ("b", "<i2")])
    rows["a"], rows["b"] = a, b
    contiguous = a.astype("<f8").tobytes() + b.tobytes()
    made = {
        "interleaved.tdms": tdms_segment(meta | new | data | woven, two(), rows.tobytes()),
        "chunks.tdms": tdms_segment(meta | new | data, two(scale_b=linear), contiguous * 3),
        "repeated.tdms": tdms_segment(meta | new | data, two(), contiguous)
        + tdms_segment(data, [], contiguous)[:28] + contiguous,
        "scaled.tdms": tdms_segment(meta | new | data, two(polynomial, linear), contiguous),
        "unfinished.tdms": tdms_segment(meta | new | data, two(), contiguous, unfinished=True)[:-777],
        "unfinished_interleaved.tdms": tdms_segment(
            meta | new | data | woven, two(), rows.tobytes() * 2, unfinished=True)[:-77],
    }
    # Segments without metadata (0 bytes in the lead-in) repeat the previous ones.
    lead = b"TDSm" + struct.pack("<IIQQ", data, 4713, len(contiguous), 0)
    made["repeated.tdms"] = tdms_segment(meta | new | data, two(), contiguous) + (lead + contiguous) * 2

    def scaler(kind, offset, number):
        return struct.pack("<IIIII", kind, 0, offset, 0, number)

    def daqmx_index(scalers, width):
        return struct.pack("<IIIQI", 0x1269, 0xFFFFFFFF, 1, 500, len(scalers)) + b"".join(scalers) + struct.pack("<II", 1, width)

    raw = np.zeros(500, dtype=[("x", "<i2"), ("y", "<i4"), ("z", "u1")])
    raw["x"], raw["y"], raw["z"] = b[:500], random.integers(-2**30, 2**30, 500), random.integers(0, 255, 500)
    daq_scale = [("NI_Number_Of_Scales", 2), ("NI_Scale[1]_Scale_Type", "Linear"),
                 ("NI_Scale[1]_Linear_Slope", 2.5e-4), ("NI_Scale[1]_Linear_Y_Intercept", -0.2),
                 ("NI_Scale[1]_Linear_Input_Source", 0)]
    objects = [file, group,
               tdms_object("/'g'/'x'", daqmx_index([scaler(3, 0, 0)], 7), daq_scale),
               tdms_object("/'g'/'y'", daqmx_index([scaler(5, 2, 0)], 7), daq_scale)]
    made["daqmx.tdms"] = tdms_segment(meta | new | data | daqmx, objects, raw.tobytes() * 3)
    for name, content in made.items():
        (folder / name).write_bytes(content)
    values = {"i1": np.int8, "i2": np.int16, "i4": np.int32, "i8": np.int64, "u1": np.uint8, "u2": np.uint16,
              "u4": np.uint32, "u8": np.uint64, "f4": np.float32, "f8": np.float64, "b": np.bool_}
    with nptdms.TdmsWriter(folder / "all_types.tdms") as writer:
        for part in range(5):
            writer.write_segment([
                nptdms.ChannelObject("types", name, (random.normal(size=100 + part) * 50).astype(kind))
                for name, kind in values.items()])


def compare(ours, theirs):
    if len(ours) != len(theirs):
        return f"{len(ours)} channels, the other program has {len(theirs)}"
    for mine, other in zip(ours, theirs):
        for key in ("name", "length", "checksum", "interval"):
            if other[key] is not None and mine[key] != other[key]:
                return f"{mine['name']}: {key} {mine[key]}, the other program has {other[key]}"
    return None


def main():
    dump, data, scratch = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
    scratch.mkdir(parents=True, exist_ok=True)
    make_tdms(scratch)
    make_hdf5(scratch)
    make_tables(scratch)
    make_numpy(scratch)
    files = sorted(p for folder in (data, scratch) for p in folder.rglob("*") if p.is_file())
    lines = subprocess.run([dump, *map(str, files)], capture_output=True, text=True, check=True).stdout
    differences = 0
    for path, line in zip(files, lines.splitlines()):
        found = json.loads(line)["found"]
        name = path.relative_to(data if path.is_relative_to(data) else scratch)
        peer = peer_of(path)
        if "error" in found:
            print(f"refused    {name}: {found['error'].split(': ', 1)[1][:110]}")
            continue
        if peer is None:
            print(f"read       {name}: {len(found['channels'])} channels, no other program to compare with")
            continue
        try:
            theirs = peer(path)
        except Exception as problem:
            print(f"read       {name}: {len(found['channels'])} channels; the other program fails: {str(problem)[:60]}")
            continue
        difference = compare(found["channels"], theirs)
        if difference is None:
            print(f"identical  {name}: {len(theirs)} channels")
        else:
            differences += 1
            print(f"DIFFERENT  {name}: {difference}")
    print(f"{len(files)} files, {differences} differ")
    sys.exit(differences > 0)


if __name__ == "__main__":
    main()
