"""Files of a release: archives, the list of parts, and what checks them.

    release_files.py archive FOLDER FILE     FILE.tar.gz or FILE.zip of a folder
    release_files.py unpack FOLDER INTO      all archives and wheels of a folder
    release_files.py parts VERSION COMMIT    `windfall licences --format json` → CycloneDX
    release_files.py same FILE FILE LIMIT    compares the numbers of two fits
"""

import gzip
import io
import json
import os
import stat
import sys
import tarfile
import time
import tomllib
import uuid
import zipfile
from pathlib import Path

# The commit's, so that two runs give the same bytes.
TIME = int(os.environ.get("SOURCE_DATE_EPOCH", "0"))
PURLS = {"crate": "pkg:cargo", "npm": "pkg:npm"}


def members(folder):
    """Files of a folder in the order of their names, which begin with that of the folder."""
    files = sorted(own for own in folder.rglob("*") if own.is_file())
    return [(own, own.relative_to(folder.parent).as_posix()) for own in files]


def mode(path):
    return 0o755 if path.stat().st_mode & stat.S_IXUSR else 0o644


def archive(folder, file):
    write_zip(folder, file) if file.suffix == ".zip" else write_tar(folder, file)


def write_tar(folder, file):
    raw = io.BytesIO()
    with tarfile.open(fileobj=raw, mode="w", format=tarfile.USTAR_FORMAT) as tar:
        for path, name in members(folder):
            entry = tarfile.TarInfo(name)
            entry.size, entry.mtime, entry.mode = path.stat().st_size, TIME, mode(path)
            with path.open("rb") as contents:
                tar.addfile(entry, contents)
    file.write_bytes(gzip.compress(raw.getvalue(), 9, mtime=0))


def write_zip(folder, file):
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as pack:
        for path, name in members(folder):
            entry = zipfile.ZipInfo(name, time.gmtime(TIME)[:6])
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.create_system = 3
            entry.external_attr = (stat.S_IFREG | mode(path)) << 16
            pack.writestr(entry, path.read_bytes(), compresslevel=9)


def unpack(folder, into):
    for file in sorted(folder.iterdir()):
        if file.name.endswith(".tar.gz"):
            with tarfile.open(file) as tar:
                tar.extractall(into / file.name, filter="data")
        elif file.suffix in (".whl", ".zip"):
            with zipfile.ZipFile(file) as pack:
                pack.extractall(into / file.name)


def parts(version, commit):
    """A CycloneDX document of what is linked, bundled or embedded."""
    lock = tomllib.loads(Path("Cargo.lock").read_text())["package"]
    digests = {(own["name"], own["version"]): own.get("checksum") for own in lock}
    told = json.load(sys.stdin)["parts"]
    components = [component(own, digests) for own in told]
    document = {
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "serialNumber": f"urn:uuid:{uuid.uuid5(uuid.NAMESPACE_OID, f'windfall {commit}')}",
        "version": 1,
        "metadata": {
            "timestamp": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(TIME)),
            "component": {
                "type": "application",
                "bom-ref": "windfall",
                "name": "windfall",
                "version": version,
                "licenses": [{"expression": "MIT OR Apache-2.0"}],
                "properties": [{"name": "commit", "value": commit}],
            },
        },
        "components": components,
    }
    json.dump(document, sys.stdout, indent=1)
    print()


def component(part, digests):
    name, version, kind = part["name"], part["version"], part["kind"]
    made = {
        "type": "data" if kind == "font" else "library",
        "bom-ref": f"{kind}:{name}@{version}",
        "name": name,
        "licenses": [{"expression": part["licence"]}],
    }
    if version:
        made["version"] = version
    if kind in PURLS:
        # A purl writes the plus of a version as a code.
        made["purl"] = f"{PURLS[kind]}/{name}@{version.replace('+', '%2B')}"
    if kind == "crate":
        made["hashes"] = [{"alg": "SHA-256", "content": digests[name, version]}]
    if part["only"]:
        made["properties"] = [{"name": "only in", "value": part["only"]}]
    return made


def same(first, second, limit):
    """Every number of the first document is in the second, as near as the limit."""
    documents = [json.loads(Path(own).read_text()) for own in (first, second)]
    found = {"numbers": 0, "largest": 0.0, "where": ""}
    compare(*documents, "", found)
    told = f"{found['numbers']} numbers, largest relative difference {found['largest']:.2g}"
    print(f"{told} {found['where']}".rstrip(), file=sys.stderr)
    if found["numbers"] < 100 or found["largest"] > limit:
        sys.exit(f"{first} and {second} differ by more than {limit:g}")


def compare(one, other, place, found):
    if isinstance(one, dict):
        if not isinstance(other, dict) or one.keys() != other.keys():
            sys.exit(f"other keys at {place}")
        for key in one:
            compare(one[key], other[key], f"{place}.{key}", found)
    elif isinstance(one, list):
        if not isinstance(other, list) or len(one) != len(other):
            sys.exit(f"another length at {place}")
        for number, pair in enumerate(zip(one, other)):
            compare(*pair, f"{place}[{number}]", found)
    elif isinstance(one, (int, float)) and not isinstance(one, bool):
        found["numbers"] += 1
        scale = max(abs(one), abs(other))
        difference = abs(one - other) / scale if scale else 0.0
        if not difference <= found["largest"]:
            found["largest"], found["where"] = difference, place
    elif isinstance(one, bool) or one is None:
        if one != other:
            sys.exit(f"{one} and {other} at {place}")


def main():
    match sys.argv[1:]:
        case ["archive", folder, file]:
            archive(Path(folder), Path(file))
        case ["unpack", folder, into]:
            unpack(Path(folder), Path(into))
        case ["parts", version, commit]:
            parts(version, commit)
        case ["same", first, second, limit]:
            same(first, second, float(limit))
        case _:
            sys.exit(__doc__)


if __name__ == "__main__":
    main()
