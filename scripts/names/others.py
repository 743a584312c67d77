"""Tables, changes by the page, commands that are shown, scenes, channels."""

import ast
import csv
import http.client
import io
import json
import re
import struct
import subprocess
import time
import tomllib
import xml.etree.ElementTree as ElementTree
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager

from campaigns import check_page, check_picture, rows_of, said
from check import BLANKS, JOBS, parts, plain
from decks import accepted_names, scene_text, toml_string


def written(rows):
    text = io.StringIO(newline="")
    csv.writer(text, quoting=csv.QUOTE_ALL).writerows(rows)
    return text.getvalue()


def check_tables(check):
    """Names as headings and cells of a table that passes through windfall, twice."""
    folder = check.folder("tables")
    names = [name.strip(BLANKS) for name in check.names]
    groups = parts(names, 20)
    # Blank, NA and the like are missing values; numbers are numbers.
    for number, group in enumerate(groups):
        header = ["bruise_width_mm", "bruise_depth_mm", *group]
        rows = [[str(10 + own), "3", *group[own:], *group[:own]] for own in range(3)]
        wanted = [[said(cell) for cell in row] for row in [header, *rows]]
        file = folder / f"{number}.csv"
        file.write_bytes(written([header, *rows]).encode())
        for again in range(2):
            _, out, _ = check.run("bruise", "--table", file, "--format", "csv")
            found = [[said(cell) for cell in row] for row in rows_of(check, "table", out)]
            own = [row[:len(header)] for row in found]
            check.expect(own == wanted, "table", "cells do not come back", number,
                         [pair for pair in zip(sum(own, []), sum(wanted, [])) if pair[0] != pair[1]])
            # What was written is read as what it was.
            kept = [row[:len(header)] for row in csv.reader(io.StringIO(out, newline=""))]
            file.write_bytes(written(kept).encode())
    check.count("table", len(names))


@contextmanager
def served(check, folder):
    server = subprocess.Popen([check.program, "serve", folder, "--no-open", "--no-token", "--port", "0"],
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    try:
        address = re.search(rb"http://([^/]+)/", server.stdout.readline()).group(1).decode()

        def ask(method, path, body=None):
            connection = http.client.HTTPConnection(address, timeout=60)
            head = {"X-Windfall": "names", "If-Match": "*", "Content-Type": "application/json"}
            connection.request(method, path, json.dumps(body).encode() if body is not None else None, head)
            answer = connection.getresponse()
            text = answer.read()
            connection.close()
            return answer.status, json.loads(text) if text else None

        yield ask
    finally:
        server.terminate()
        server.wait()


def simulated(check, folder):
    law = "kuwabara-kono(k=753599,c=1524)"
    check.run("simulate", "carriage", "--law", law, "--mass", "0.2kg", "--velocity", "0.5m/s", "--specimens", 1,
              "--recordings", folder)


def check_changes(check):
    """Names that the page puts into campaign.toml and into impacts.csv."""
    folder = check.folder("changes")
    campaign = folder / "c"
    simulated(check, campaign)
    settings = (campaign / "campaign.toml").read_text()
    wanted = tomllib.loads(settings)
    # Only this channel is named below.
    wanted["channels"] = {"force": wanted["channels"]["force"]}
    # Cells that the user wrote, and nobody touches.
    user = b"id,specimen,file,note\r\n\"u\",u,specimen-01.csv,=1+1\r\n v ,u,specimen-01.csv,'=2\r\n"
    (campaign / "impacts.csv").write_bytes(user)
    (campaign / "specimens.csv").write_text("id,variety\nu,u\n")
    refused = 0
    with served(check, folder) as ask:
        for name in check.names:
            given = {"channels": [{"quantity": "force", "column": name, "unit": "0.011 V/N"}], "rate": "10000 Hz"}
            status, told = ask("PUT", "/api/campaigns/c/channels", given)
            if status != 200:
                refused += 1
                check.expect(status in (400, 422), "toml", "refused with another status", name, status, told)
                continue
            found = tomllib.loads((campaign / "campaign.toml").read_bytes().decode())
            column = found["channels"]["force"].pop("column")
            check.expect(column == name, "toml", "a name does not come back", column, name)
            found["channels"]["force"]["column"] = wanted["channels"]["force"]["column"]
            check.expect(found == wanted, "toml", "other keys have changed", found, wanted)
        (campaign / "campaign.toml").write_text(settings)
        added = []
        for group in parts(check.names, 20):
            impacts = [{"id": name, "specimen": name, "file": "specimen-01.csv", "cells": {"note": name, "level": name}}
                       for name in group]
            status, told = ask("POST", "/api/campaigns/c/impacts", {"impacts": impacts})
            check.expect(status == 200, "csv", "names are refused", group, status, told)
            added += [name.strip(BLANKS) for name in group]
            text = (campaign / "impacts.csv").read_bytes()
            check.expect(text.replace(b",level", b"").startswith(user.replace(b"=1+1\r\n", b"=1+1,\r\n").replace(
                b"'=2\r\n", b"'=2,\r\n")), "csv", "a cell has changed that nobody touched", text[:300])
            rows = list(csv.reader(io.StringIO(text.decode(), newline=""), strict=True))[3:]
            rows_of(check, "csv", written(rows))
            found = [[said(cell).strip(BLANKS) for cell in row] for row in rows]
            rows = [[own, own, "specimen-01.csv", own, own] for own in added]
            check.expect(found == rows, "csv", "names do not come back", found[-1], rows[-1])
            check.expect(told["impacts"]["rows"][2:] == rows, "csv", "the page sees other names")
    check.count("toml", len(check.names) - refused, refused)
    check.count("changed csv", len(check.names))


def check_shell(check):
    """Commands that the page shows, and those that the terminal shows, typed into bash."""
    folder = check.folder("shell")
    names = [name.replace("\0", "0") for name in check.names]
    simulated(check, folder / "served" / "c")
    commands = []
    with served(check, folder / "served") as ask:
        for group in parts(names, 10):
            for _ in range(600):
                status, told = ask("POST", "/api/campaigns/c/jobs", {"work": "laws", "laws": group})
                if status != 409:
                    break
                time.sleep(0.05)
            words = ["laws", "c"] + [word for name in group for word in ("--law", name)]
            commands.append((told["command"], words))
    made = folder / "made"
    made.mkdir()
    for name in names:
        if "/" in name or len(name.encode()) > 200:
            continue
        _, told, _ = check.run("new", "scene", "--", name, folder=made)
        _, command = told.rsplit("edit the file, then\n  ", 1)
        path = f"{name}/scene.toml"
        commands.append((command.rstrip("\n"), ["scene", "run", f"./{path}" if path.startswith("-") else path]))
    run = folder / "run"
    run.mkdir()

    def typed(own):
        command, words = own
        script = "windfall() { printf '%s\\0' \"$@\"; }\n" + command + "\n"
        done = subprocess.run(["bash", "-c", script], capture_output=True, cwd=run)
        check.expect(done.returncode == 0 and not done.stderr, "shell", "bash does not take it", command, done.stderr)
        found = done.stdout.decode().split("\0")[:-1]
        check.expect(found == words, "shell", "words do not come back", found, words)
        control = re.search("[\0-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069]", command)
        check.expect(control is None, "shell", "a terminal would act on it", command)

    with ThreadPoolExecutor(JOBS) as pool:
        list(pool.map(typed, commands))
    check.unrun(run, "shell")
    check.count("shell", len(names))


def run_scene(check, folder, title, names):
    """A scene with these names: run, drawn, exported and studied."""
    (folder / "scene.toml").write_text(scene_text(title, names[:3], names[3:]), newline="")
    _, told, _ = check.run("scene", "run", folder / "scene.toml", "--out", folder / "out.run", "--format", "csv")
    check.run("scene", "picture", folder / "out.run", "--out", folder / "picture.svg")
    check.run("scene", "vtk", folder / "out.run", "--out", folder / "vtk")
    levels = ", ".join(f'{{ name = {toml_string(name)}, set = {{ "scene.end" = "0.001 s" }} }}' for name in names[1:4])
    study = f"""format = 1
title = {toml_string(title)}
scene = "scene.toml"
replicates = 1
[[vary]]
name = {toml_string(names[0])}
levels = [{levels}]
"""
    (folder / "study.toml").write_text(study, newline="")
    _, studied, _ = check.run("scene", "study", folder / "study.toml", "--out", folder / "study", "--format", "csv")
    return told, studied


def check_scenes(check):
    names = accepted_names(check)
    refused = len(check.names) - len(names)
    size = 60
    groups = parts(names, size)
    groups[-1] = (groups[-1] + plain(size))[:size]
    usual = check.folder("scene-plain")
    run_scene(check, usual, "plain title", plain(size)[1:])
    for number, group in enumerate(groups):
        folder = check.folder(f"scene-{number}")
        told, studied = run_scene(check, folder, group[0], group[1:])
        fruit, walls = group[1], group[4:]
        rows_of(check, "scene csv", told)
        rows = rows_of(check, "study csv", studied)
        check.expect([said(row[1]) for row in rows[1:]] == group[2:5], "study csv", "names do not come back", rows, group)
        check_page(check, "study html", folder / "study" / "study.html", [group[0], *group[2:5]],
                   usual / "study" / "study.html")
        tables = {name: rows_of(check, "scene csv", (folder / "out.run" / name).read_bytes().decode())
                  for name in ("events.csv", "fruit.csv")}
        materials = {said(row[1]) for row in tables["fruit.csv"][1:]}
        check.expect(materials == {fruit}, "scene csv", "names do not come back", materials, fruit)
        partners = {said(row[1]) for row in tables["events.csv"][1:]} - {"fruit"}
        check.expect(partners and partners <= set(walls), "scene csv", "names do not come back", partners, walls)
        check_picture(check, "scene svg", folder / "picture.svg")
        check_vtk(check, folder / "vtk", walls)
    check.count("scene csv", len(names), refused)
    check.count("study html", len(names), refused)
    check.count("vtk", len(names), refused)


def check_vtk(check, folder, walls):
    for file in folder.iterdir():
        if file.suffix not in (".vtp", ".pvd"):
            continue
        root = ElementTree.fromstring(file.read_bytes())
        for array in root.iter("Array"):
            codes = bytes(int(own) for own in array.text.split())
            names = [own.decode() for own in codes.split(b"\0")[:-1]]
            check.expect(names == walls, "vtk", "names do not come back", names, walls)


def check_samples(check):
    """Names of channels, exported as CSV and for NumPy, and read again."""
    folder = check.folder("samples")
    # A recording in text has one line of names, without marks of its table.
    unfit = re.compile("[\n\r\"\0,;\t\v\f\x1c-\x1e\x85\u2028\u2029#%]")
    names = [name.strip(BLANKS) for name in check.names if not unfit.search(name) and len(name) < 2000]
    for number, group in enumerate(parts(names, 10)):
        file = folder / f"{number}.csv"
        lines = [",".join(["t (s)", *group])]
        lines += [",".join(str(0.001 * row + column) for column in range(len(group) + 1)) for row in range(30)]
        file.write_text("\n".join(lines) + "\n", newline="")
        out = folder / f"{number}-again.csv"
        array = folder / f"{number}.npy"
        channels = []
        for path in [file, out]:
            _, told, _ = check.run("inspect", path, "--format", "json")
            [own] = json.loads(told)["files"]
            channels.append([column["column"] for column in own["columns"]])
            if path is file:
                check.run("inspect", file, "--export", out)
                check.run("inspect", file, "--export", array)
        check.expect(channels[0] == channels[1], "samples", "names do not come back", *channels)
        rows = rows_of(check, "samples", out.read_bytes().decode())
        data = array.read_bytes()
        [length] = struct.unpack("<I", data[8:12])
        header = ast.literal_eval(data[12:12 + length].decode())
        found = [name for name, _ in header["descr"]]
        check.expect(found == [said(cell) for cell in rows[0]], "npy", "names do not come back", found, rows[0])
    check.count("samples", len(names))
