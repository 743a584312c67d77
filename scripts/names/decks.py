"""Contacts of scenes for engines that windfall does not run."""

import ast
import json
import re
import subprocess
from concurrent.futures import ThreadPoolExecutor

from check import JOBS, plain

def toml_string(text):
    """A basic string of TOML: JSON has the same escapes."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def scene_text(title, materials, walls=None):
    """A fruit that falls, walls and sinks: the first material is the fruit's."""
    fruit, *others = materials
    walls = others if walls is None else walls
    lines = ["format = 1", f"materials = [{', '.join(map(toml_string, materials))}]", "[scene]",
             f"title = {toml_string(title)}", 'end = "0.002 s"', 'time_step = "20 us"']
    for other in materials:
        lines += ["[[contacts]]", f"between = [{toml_string(fruit)}, {toml_string(other)}]",
                  'law = "hertz(k=753599)"', 'effective_radius = "18 mm"', "friction = 0.3"]
    lines += ["[[fruit]]", f"name = {toml_string(fruit)}", f"material = {toml_string(fruit)}", "count = 1",
              'diameter = "75 mm"', 'density = "840 kg/m^3"', 'drop = { place = [0, 0, 0.038], velocity = [0, 0, -1], interval = "1 s" }']
    for place, wall in enumerate(walls):
        lines += ["[[walls]]", f"name = {toml_string(wall)}", f"material = {toml_string(others[place % len(others)])}",
                  f"plane = {{ point = [0, 0, {-0.1 * place}], normal = [0, 0, 1] }}",
                  "[[sinks]]", f"name = {toml_string(wall)}", f"low = [-1, -1, {-50 + place / 10}]",
                  f"high = [1, 1, {-49 + place / 10}]"]
    return "\n".join(lines) + "\n[record]\nframes = \"1 ms\"\n"


def accepted_names(check):
    """Those that a scene may hold; of the others windfall says that they are not one line."""
    folder = check.folder("accepted")

    def accepted(numbered):
        number, name = numbered
        file = folder / f"{number}.toml"
        file.write_text(scene_text(name, [name, "steel"]), newline="")
        status, _, told = check.run("scene", "export", file, "--engine", "edem", "--out", folder / str(number), status=2)
        if status:
            check.expect("must be one line" in told, "decks", "refused for another reason", name, told)
        return not status

    with ThreadPoolExecutor(JOBS) as pool:
        taken = pool.map(accepted, enumerate(check.names))
    return [name for name, good in zip(check.names, taken) if good]


class Blanked(ast.NodeTransformer):
    """Takes the texts out of a tree."""

    def __init__(self):
        self.texts = []

    def visit_Constant(self, node):
        if isinstance(node.value, str):
            self.texts.append(node.value)
            node.value = ""
        return node


def python_code(data):
    tree = ast.parse(data)  # bytes: what the first lines say of their encoding counts
    blanked = Blanked()
    return ast.dump(blanked.visit(tree)), blanked.texts


# Ends of lines for anything that reads text.
LINE = re.compile("\r\n|[\n\r\v\f\x1c-\x1e\x85\u2028\u2029]")


def adams_code(data):
    """Lines without comments; a comma or an ampersand at an end continues a line."""
    lines = LINE.split(data.decode())
    active = [line.split("!")[0].rstrip() for line in lines]
    ends = [line for line in lines if line.startswith("!") and line.rstrip().endswith(("&", "\\"))]
    return [line for line in active if line] + ends


def edem_code(data):
    """Lines of a key and a value."""
    return [line for line in LINE.split(data.decode()) if "\t" in line]


STUBS = """
struct Species { void setStiffness(double); void setDissipation(double); void setSlidingStiffness(double);
    void setSlidingFrictionCoefficient(double); void setEffectiveElasticModulusAndRestitutionCoefficient(double, double);
    void setEffectiveShearModulus(double); };
struct Handler { Species* getMixedObject(int); }; extern Handler speciesHandler; const int SPECIES = 0;
namespace chrono_types { template <class T> T* make_shared() { return new T; } }
struct ChContactMaterialSMC { void SetKn(double); void SetGn(double); void SetKt(double); void SetGt(double);
    void SetFriction(double); };
"""


def compile_decks(check, target, folder, decks):
    """Tokens that the compiler is left with, and whether they compile; trigraphs count."""
    source = folder / "all.cpp"
    bodies = [f"void deck{own}() {{\n".encode() + deck + b"\n}\n" for own, deck in enumerate(decks)]
    source.write_bytes(STUBS.encode() + b"".join(bodies))
    tokens = []
    for standard in ["c++11", "gnu++17"]:
        strict = ["-Werror=comment", "-Werror=trigraphs", "-Werror=bidi-chars", "-Wbidi-chars=any"]
        for step in [["-E", "-P"], ["-fsyntax-only", *strict]]:
            done = subprocess.run(["g++", f"-std={standard}", "-Wall", *step, source], capture_output=True)
            check.expect(done.returncode == 0, target, "does not compile", done.stderr.decode(errors="replace"))
            tokens.append(done.stdout)
    return tokens


def check_decks(check):
    names = accepted_names(check)
    refused = len(check.names) - len(names)
    # Every name once as title, and several times as fruit, wall and material.
    scenes = [(name, [names[(place + own) % len(names)] for own in range(1, 7)]) for place, name in enumerate(names)]
    usual = [(f"plain title {place}", plain(6)) for place in range(len(names))]

    def exported(engine, folder, numbered):
        number, (title, materials) = numbered
        file = folder / f"{number}.toml"
        file.write_text(scene_text(title, materials), newline="")
        out = folder / str(number)
        _, told, _ = check.run("scene", "export", file, "--engine", engine, "--out", out, "--format", "json")
        between = [own["between"] for own in json.loads(told)["contacts"]]
        wanted = [[materials[0], own] for own in materials]
        check.expect(between == wanted, engine, "names do not come back", between, wanted)
        [deck] = [own for own in out.iterdir() if not own.name.startswith(".")]
        return deck.read_bytes()

    for engine, code in [("yade", python_code), ("chrono", None), ("mercurydpm", None), ("adams", adams_code),
                         ("edem", edem_code)]:
        folder = check.folder(engine)
        with ThreadPoolExecutor(JOBS) as pool:
            hostile = list(pool.map(lambda own: exported(engine, folder, own), enumerate(scenes)))
            harmless = exported(engine, check.folder(f"{engine}-plain"), (0, usual[0]))
        if code is None:
            found = compile_decks(check, engine, folder, hostile)
            wanted = compile_decks(check, engine, check.folder(f"{engine}-all"), [harmless] * len(hostile))
            check.expect(found == wanted, engine, "other tokens", *first_difference(found[0], wanted[0]))
        elif engine == "yade":
            wanted, _ = code(harmless)
            for (title, materials), deck in zip(scenes, hostile):
                try:
                    tree, texts = code(deck)
                except (SyntaxError, ValueError, LookupError) as error:
                    tree, texts = str(error), None
                data = [own for other in materials for own in (materials[0], other)]
                check.expect(tree == wanted, engine, "other code", title, materials, tree)
                check.expect(texts == data, engine, "names do not come back", texts, data)
        else:
            wanted = code(harmless)
            for scene, deck in zip(scenes, hostile):
                check.expect(code(deck) == wanted, engine, "other code", scene, code(deck))
        check.count(engine, len(names), refused)


def first_difference(found, wanted):
    lines = zip(found.split(b"\n"), wanted.split(b"\n"))
    return next(((a, b) for a, b in lines if a != b), (len(found), len(wanted)))
