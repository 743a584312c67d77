"""Restitution that engines deliver beside that of the law; see bench/check-exports."""
import csv
import json
import math
import os
import shutil
import struct
import subprocess
import sys

windfall, folder = sys.argv[1:]
RADIUS, DENSITY = 0.0375, 840.0
MASS = DENSITY * 4 / 3 * math.pi * RADIUS**3
SPEEDS = [0.25, 0.5, 1.0, 2.0]
MATCHED = 1.0
# Pairs of fruit, and the same on a wall.
LAWS = {
    "hertz": ("hertz(k=753599)", "hertz(k=1065750)"),
    "kuwabara-kono": ("kuwabara-kono(k=753599, c=1524)", "kuwabara-kono(k=1065750, c=2155)"),
    "tsuji": (
        f"tsuji(k=753599, restitution=0.5, mass={MASS / 2})",
        f"tsuji(k=1065750, restitution=0.5, mass={MASS})",
    ),
    "kelvin-voigt": ("kelvin-voigt(k=40000, c=20)", "kelvin-voigt(k=40000, c=30)"),
}
RUN = ["windfall", "lammps", "liggghts"]
WRITTEN = ["yade", "adams", "chrono", "edem", "mercurydpm"]


def scene(pair, wall, end):
    text = f"""format = 1
materials = ["apple", "steel"]
[scene]
gravity = "0 m/s^2"
time_step = "2 us"
end = "{end} s"
checkpoint = "never"
[[contacts]]
between = ["apple", "apple"]
law = "{pair}"
effective_radius = "18.75 mm"
friction = 0.3
annuli = 1
[[contacts]]
between = ["apple", "steel"]
law = "{wall}"
effective_radius = "37.5 mm"
friction = 0.3
annuli = 1
[[walls]]
name = "floor"
material = "steel"
plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}
[record]
frames = "{end / 2} s"
"""
    for number, speed in enumerate(SPEEDS):
        x = 0.5 * number
        before = RADIUS + 1e-3
        for place, velocity in (
            ((x, 0, before), (0, 0, -speed)),
            ((x, 0, 1), (0, 0, 0)),
            ((x, 0, 1 + 2 * RADIUS + 1e-3), (0, 0, -speed)),
        ):
            text += f"""[[fruit]]
material = "apple"
count = 1
diameter = "{2 * RADIUS} m"
density = "{DENSITY} kg/m^3"
drop = {{ place = {list(place)}, velocity = {list(velocity)}, interval = "1 s", from = "0 s" }}
"""
    return text


def last_velocities(path):
    """Vertical velocities of all fruit in the last frame."""
    data = open(path, "rb").read()
    _, length = struct.unpack("<II", data[8:16])
    head = json.loads(data[16 : 16 + length])
    at = 16 + length + 4 * head["fruit"]
    for wall in head["walls"]:
        at += 12 * wall["vertices"] + 4 * wall["corners"] * wall["faces"]
    found = {}
    while at < len(data):
        (count,) = struct.unpack("<I", data[at + 4 : at + 8])
        at += 16 + 28 * len(head["walls"])
        for _ in range(count):
            own = struct.unpack("<I3f4f3ff", data[at : at + 48])
            found[own[0]] = own[10]
            at += 48
    return [found[number] for number in sorted(found)]


def run(*arguments, env=None):
    """Exit code and what was printed; a program that hangs, as YADE may, is tried again."""
    for _ in range(3):
        try:
            done = subprocess.run(arguments, capture_output=True, text=True, env=env, timeout=120)
        except subprocess.TimeoutExpired:
            continue
        return done.returncode, done.stdout, done.stderr
    return 1, "", "it hung three times"


def on_engine(engine, path):
    """Restitution of a pair and of a wall at each speed, or why there is none."""
    out = f"{folder}/{engine}"
    extra = [] if engine == "windfall" else ["--engine", engine, "--frame-steps", "5"]
    code, _, problem = run(windfall, "scene", "run", path, "--out", out, "--threads", "1", *extra)
    if code != 0:
        return problem.strip().splitlines()[-1][:100]
    own = last_velocities(f"{out}/frames.bin")
    shutil.rmtree(out)
    rows = {}
    for number, speed in enumerate(SPEEDS):
        wall, below, above = own[3 * number : 3 * number + 3]
        rows["steel", speed] = wall / speed
        rows["apple", speed] = (above - below) / speed
    return rows


def on_yade(path):
    task = {"contacts": path, "radius": RADIUS, "density": DENSITY, "speeds": SPEEDS}
    with open(f"{folder}/task.json", "w") as file:
        json.dump(task, file)
    environment = dict(os.environ, WINDFALL_IMPACTS=f"{folder}/task.json")
    here = os.path.dirname(os.path.abspath(__file__))
    _, text, problem = run("yade", "-n", "-x", f"{here}/yade_impacts.py", env=environment)
    rows = {}
    for line in text.splitlines():
        if line.startswith("IMPACT "):
            _, partner, speed, restitution = json.loads(line[7:])
            rows[partner, speed] = restitution
    return rows or f"YADE: {problem.strip()[-100:]}"


def show(name, law, wanted, rows):
    """The table's rows; the largest relative error."""
    if isinstance(rows, str):
        print(f"  {name:12} {rows}")
        return None
    worst = 0.0
    for partner in ("apple", "steel"):
        cells = []
        for speed in SPEEDS:
            own, of_law = rows.get((partner, speed)), wanted[partner, speed]
            if own is None:
                cells.append(f"{'':>16}")
                continue
            error = own / of_law - 1
            worst = max(worst, abs(error)) if name != "yade" or speed == MATCHED else worst
            cells.append(f"{own:7.4f} {100 * error:+7.2f} %")
        print(f"  {name:12} {partner:6}", *cells)
    return worst


failed = 0
for law, (pair, wall) in LAWS.items():
    print(f"\n{law}: restitution, and how far it is off the law's; m/s:", *SPEEDS)
    path = f"{folder}/scene.toml"
    with open(path, "w") as file:
        file.write(scene(pair, wall, 0.1))
    wanted = None
    for engine in RUN:
        rows = on_engine(engine, path)
        wanted = rows if engine == "windfall" else wanted
        worst = show(engine, law, wanted, rows)
        failed += worst is not None and worst > 0.01
    for engine in WRITTEN:
        code, text, problem = run(
            windfall, "scene", "export", path, "--engine", engine, "--speed", str(MATCHED),
            "--out", f"{folder}/written", "--format", "json",
        )
        if code != 0:
            print(f"  {engine:12} {problem.strip()[:100]}")
            failed += 1
            continue
        outcome = json.loads(text)
        rows = {}
        for own in outcome["contacts"]:
            for at in own["delivered"]:
                rows[own["between"][1], at["speed"]] = at["engine"]
        if not rows:
            print(f"  {engine:12} has no counterpart of this law")
            continue
        show(f"{engine}*", law, wanted, rows)
        at_match = [abs(rows[partner, MATCHED] / wanted[partner, MATCHED] - 1) for partner in ("apple", "steel")]
        failed += max(at_match) > 0.01
        if engine == "yade" and shutil.which("yade"):
            found = on_yade(outcome["file"])
            worst = show(engine, law, wanted, found)
            failed += worst is None or worst > 0.01
            # What is said is what comes, at every speed.
            if isinstance(found, dict):
                said = [abs(found[key] / rows[key] - 1) for key in rows if key in found]
                failed += max(said) > 0.01
print("\n* by the published formula of its force, not run here")
sys.exit(1 if failed else 0 if shutil.which("yade") else 75)
