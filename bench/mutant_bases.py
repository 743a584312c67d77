"""Files that check_mutants.py changes, with recordings that fit and the commands that use them."""

import shutil
import subprocess
from pathlib import Path

from kill_kinds import SCENE, STUDY, change, relaxation, run

ROOT = Path(__file__).resolve().parent.parent
LAW = "kuwabara-kono(k=753599, c=1524)"
DROP = ["simulate", "drop", "c", "--law", "adams-impact(k=466143, e=1.91, c=0.556, d=1e-6)", "--mass", "4.8 g",
        "--drops", "1", "--plate-mass", "0.2 kg", "--plate-stiffness", "648 N/mm", "--plate-damping", "0.05247 N s/mm"]
OWN_LAWS = """# Laws of one's own.
[laws.soft]
force = "k * x^n + c * v"
[laws.soft.parameters]
k = { unit = "N/m^n", start = 5e5, lower = 1 }
n = { unit = "1", default = 1.5, lower = 0.5, upper = 4 }
c = { unit = "N s/m", start = 100, meaning = "damping" }
[laws.steps]
displacement_m = [0, 0.0002, 0.001, 0.003]
force_N = [0, 3, 30, 150]
damping_N_s_m = [0, 10, 20, 30]
[laws.read]
table = "force.csv"
"""
FORCE = "displacement_m,force_N\n0,0\n0.0005,10\n0.001,30\n0.003,150\n"
REGRESSION = """response = "log(bruise_volume_mm3)"
terms = [
  { term = "(Intercept)", estimate = 8 },
  { term = "log(absorbed_energy_mJ / 1000)", estimate = 1.1 },
  { term = "temperature_C", estimate = -0.02 },
]
ranges = [{ column = "absorbed_energy_mJ", low = 0, high = 100 }]
"""
TABLE = "".join(
    [f"variety,fruit,dose,peak_N,bruise_mm3\n"]
    + [f"{'Gala' if i % 2 else 'Fuji'},f{i // 3},{1 + i % 3},{20 + 3 * i + (i * 7) % 5},{100 + 11 * i + (i * 5) % 7}\n"
       for i in range(18)])
# One thread, so that the limit of time holds for the work and not for the machine.
ONE = ["--threads", "1"]


class Base:
    """Files of one kind, and commands that use them.

    files: those that are changed, and how often one is chosen
    commands: lists of words, of which one is chosen
    usual: what they print when nothing is wrong
    """

    def __init__(self, name, folder, files, commands):
        self.name, self.folder, self.files, self.commands = name, folder, files, commands
        self.usual = []


def uncommented(folder, template, keep=()):
    """Takes the remarks of a template that name further keys into a campaign.toml, as remarks."""
    text = (ROOT / "crates/campaign/templates" / template).read_text()
    tables = {}
    table = ""
    for line in text.splitlines():
        if line.startswith("["):
            table = line.split("]")[0] + "]"
        elif line.startswith("# ") and " = " in line and line[2:].split(" = ")[0].isidentifier():
            tables.setdefault(table, []).append(line)
    path = folder / "campaign.toml"
    out = []
    for line in path.read_text().splitlines():
        out.append(line)
        out += tables.pop(line.split("]")[0] + "]", []) if line.startswith("[") else []
    for table, lines in tables.items():
        if table.startswith("[") and table in keep:
            out += [table, *lines]
    path.write_text("\n".join(out) + "\n")


def campaigns(program, scratch):
    """Simulated campaigns of every kind."""
    fits = lambda *more: [["fit", "c", *ONE], ["fit", "c", *ONE, "--format", "json"], *more]
    made = [
        ("pendulum", ["simulate", "pendulum", "--law", LAW, "--recordings", "c", "--specimens", "2", "--repeats", "1"],
         (), fits(["laws", "c", *ONE], ["population", "c", *ONE], ["fit", "c", *ONE, "--card", "law.toml"],
                  ["fit", "c", *ONE, "--intervals", "profile"])),
        ("carriage", ["simulate", "carriage", "--law", LAW, "--mass", "0.2 kg", "--velocity", "0.5 m/s",
                      "--recordings", "c", "--specimens", "2", "--repeats", "1"],
         (), fits(["population", "c", *ONE, "--format", "json"], ["fit", "c", *ONE, "--law", "hertz"])),
        ("drop", [*DROP, "--height", "100 mm"], ("[bounces]",),
         fits(["calibrate", "c", "--way", "features", *ONE],
              ["calibrate", "c", "--way", "waveform", *ONE, "--format", "json"])),
        ("compression", ["simulate", "compression", "c", "--law", "kuwabara-kono(k=300000, c=20000)",
                         "--rate", "1 mm/s"], ("[compression]",), fits()),
        ("relaxation", relaxation, ("[relaxation]",), fits()),
        ("acoustic", ["simulate", "tap", "c", "--fruit", "2"], ("[acoustic]",), fits()),
        ("repeats", ["simulate", "repeats", "c", "--fruit", "2", "--energy", "0.04 J", "--energy", "0.08 J"],
         (), fits()),
    ]
    for name, words, tables, commands in made:
        folder = scratch / name
        folder.mkdir()
        words(program, folder) if callable(words) else run(program, folder, *words)
        if name == "drop":
            change(folder / "c/campaign.toml", "adams-impact(d=1e-6)", "adams-impact(e=1.91, d=1e-6)")
        uncommented(folder / "c", f"{name}.toml", tables)
        recordings = sorted((folder / "c/raw").iterdir())
        files = {"c/campaign.toml": 8, "c/impacts.csv": 2, f"c/raw/{recordings[0].name}": 1}
        if (folder / "c/specimens.csv").exists():
            files["c/specimens.csv"] = 1
        yield Base(name, folder, files, commands)


def real(scratch, data):
    """Campaigns of recordings of others, which are read in place."""
    read = [*ONE, "--also-read", str(data)]
    for name, needed, laws in [("foam_pads", "impact", ["hertz", "kelvin-voigt"]),
                               ("fruit_grip", "compression", ["hertz"])]:
        folder = scratch / name
        shutil.copytree(ROOT / "examples" / name, folder / "c")
        text = (folder / "c/campaign.toml").read_text().replace("${WINDFALL_DATA}", str(data))
        (folder / "c/campaign.toml").write_text(text)
        if not (data / needed / name).is_dir():
            continue
        chosen = [word for law in laws for word in ("--law", law)]
        yield Base(name, folder, {"c/campaign.toml": 6, "c/impacts.csv": 2, "c/specimens.csv": 1},
                   [["fit", "c", *read, *chosen], ["fit", "c", *read, *chosen, "--format", "json"]])


def others(program, scratch):
    """Scenes, studies, law cards, own laws, designs and tables."""
    folder = scratch / "cards"
    folder.mkdir()
    run(program, folder, "simulate", "pendulum", "--law", LAW, "--recordings", "c", "--specimens", "3",
        "--repeats", "1", "--spread", "k=50000", "--spread", "c=100")
    run(program, folder, "fit", "c", "--card", "law.toml")
    (folder / "c/results.sqlite").unlink()
    (folder / ".windfall-wrote").unlink()
    (folder / "laws.toml").write_text(OWN_LAWS)
    (folder / "force.csv").write_text(FORCE)
    impact = ["--mass", "0.2 kg", "--velocity", "0.5 m/s"]
    yield Base("card", folder, {"law.toml": 1}, [
        ["card", "show", "--file", "law.toml"], ["card", "show", "--file", "law.toml", "--format", "json"],
        ["card", "transfer", "--file", "law.toml", "--from", "37.5 mm, plane", "--to", "37.5 mm, 37.5 mm"],
        ["simulate", "impact", "--law", "law.toml", *impact]])
    yield Base("laws", folder, {"laws.toml": 5, "force.csv": 1}, [
        ["card", "show", "--laws", "laws.toml"],
        ["simulate", "impact", "--laws", "laws.toml", "--law", "soft(k=5e5, c=100)", *impact],
        ["simulate", "impact", "--laws", "laws.toml", "--law", "steps(scale=1, damping_scale=1)", *impact],
        ["simulate", "impact", "--laws", "laws.toml", "--law", "read(scale=1)", *impact, "--format", "json"],
        ["fit", "c", "--laws", "laws.toml", "--law", "soft", *ONE]])

    scene = scratch / "scene"
    scene.mkdir()
    shutil.copy(folder / "law.toml", scene / "law.toml")
    (scene / "bruise.toml").write_text(REGRESSION)
    text = SCENE.replace("count = 5", "count = 3\nproperties = { temperature_C = { mean = 12, sd = 1 } }")
    text = text.replace('law = "kuwabara-kono(k=1065750, c=2155)"\neffective_radius = "37.5 mm"', 'card = "law.toml"')
    text = text.replace('end = "0.4 s"', 'end = "0.25 s"\ntime_step_error = "1 %"\ngravity = "9.81 m/s^2"')
    text += '# susceptibility_sd = "300 mm^3/J"\n# same_spot = "largest"\n[events]\nleast_peak_force = "0.5 N"\n'
    text += '[[sinks]]\nname = "end"\nlow = [5, 5, 5]\nhigh = [6, 6, 6]\n'
    text += '[air]\ndensity = "1.2 kg/m^3"\ndrag_coefficient = 0.47\n'
    (scene / "scene.toml").write_text(text)
    runs = [["scene", "run", "scene.toml", *ONE], ["scene", "run", "scene.toml", *ONE, "--format", "json"],
            ["scene", "export", "scene.toml", "--engine", "liggghts"], ["scene", "export", "scene.toml", "--engine", "edem"]]
    yield Base("scene", scene, {"scene.toml": 8, "law.toml": 1}, runs)

    template = scratch / "template"
    run(program, scratch, "new", "scene", "template")
    change(template / "scene.toml", "count = 100", "count = 3")
    change(template / "scene.toml", 'end = "4 s"', 'end = "0.05 s"')
    yield Base("scene template", template, {"scene.toml": 1}, [["scene", "run", "scene.toml", *ONE]])

    by_regression = scratch / "regression"
    by_regression.mkdir()
    start = text.index("[bruise]")
    end = text.index("[events]")
    (by_regression / "scene.toml").write_text(
        text[:start] + '[bruise]\nregression = "bruise.toml"\npredictor = "absorbed energy"\nthreshold = "5 mJ"\nlimits = ["100 mm^3"]\n' + text[end:])
    for name in ["law.toml", "bruise.toml"]:
        shutil.copy(scene / name, by_regression / name)
    yield Base("bruises", by_regression, {"bruise.toml": 1}, [["scene", "run", "scene.toml", *ONE]])

    study = scratch / "study"
    study.mkdir()
    (study / "scene.toml").write_text(SCENE.replace('end = "0.4 s"', 'end = "0.05 s"').replace("count = 5", "count = 1"))
    (study / "study.toml").write_text(STUDY + """[[vary]]
name = "floor"
levels = [
  { name = "steel" },
  { name = "other", set = { "contacts.apple+steel.friction" = 0.5, "scene.end" = "0.04 s" } },
]
""")
    yield Base("study", study, {"study.toml": 3, "scene.toml": 1}, [["scene", "study", "study.toml", *ONE]])

    tables = scratch / "tables"
    tables.mkdir()
    (tables / "table.csv").write_text(TABLE)
    run(program, tables, "design", "ccd", "--factor", "k=0.3..1 N/mm^1.91", "--factor", "e=1.5..3", "--out", "design.csv")
    lines = (tables / "design.csv").read_text().splitlines()
    head = next(i for i, line in enumerate(lines) if not line.startswith("#"))
    lines[head] += ",peak_N"
    lines[head + 1:] = [f"{line},{20 + 3 * i % 11}" for i, line in enumerate(lines[head + 1:])]
    (tables / "design.csv").write_text("\n".join(lines) + "\n")
    yield Base("tables", tables, {"table.csv": 1}, [
        ["regress", "table.csv", "--formula", "bruise_mm3 ~ dose * variety"],
        ["regress", "table.csv", "--formula", "log(bruise_mm3) ~ dose", "--random", "fruit", "--format", "json"],
        ["compare", "table.csv", "--value", "bruise_mm3", "--by", "variety"],
        ["summary", "table.csv", "--by", "variety"], ["summary", "table.csv", "--format", "json"]])
    yield Base("design", tables, {"design.csv": 1}, [
        ["surface", "design.csv", "--response", "peak_N"],
        ["surface", "design.csv", "--response", "peak_N", "--model", "linear", "--format", "json"]])


def bases(program, scratch, data):
    """All of them; `data` is a folder of real recordings, or none."""
    found = [*campaigns(program, scratch), *others(program, scratch)]
    if data:
        found += real(scratch, data)
    for base in found:
        for number, words in enumerate(base.commands):
            # Elsewhere, so that no result lies beside the files.
            copy = scratch / f"usual-{base.name}-{number}"
            shutil.copytree(base.folder, copy)
            own = subprocess.run([program, *words], cwd=copy, capture_output=True, text=True)
            if own.returncode != 0:
                raise SystemExit(f"{base.name}: {' '.join(words)}: {own.stderr[-500:]}")
            base.usual.append(own.stdout)
            shutil.rmtree(copy)
    return found
