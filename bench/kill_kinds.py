"""Kinds of work that check_kills.py kills: their inputs, their commands, how they are taken up again."""

import contextlib
import http.client
import json
import math
import os
import random
import re
import shutil
import signal
import subprocess
import tempfile
import threading
import time
from pathlib import Path

PATIENCE = 120  # s

SCENE = """format = 1
materials = ["apple", "steel", "foam"]
[scene]
title = "Apples one by one on a floor"
seed = 1
time_step = "50 us"
end = "0.4 s"
checkpoint = "0.02 s"
[[contacts]]
between = ["apple", "apple"]
law = "kuwabara-kono(k=753599, c=1524)"
effective_radius = "18.75 mm"
friction = 0.3
annuli = 1
[[contacts]]
between = ["apple", "steel"]
law = "kuwabara-kono(k=1065750, c=2155)"
effective_radius = "37.5 mm"
friction = 0.3
annuli = 1
[[fruit]]
name = "apples"
material = "apple"
count = 5
diameter = "75 mm"
diameter_sd = "2 mm"
density = "840 kg/m^3"
drop = { place = [0, 0, 0.2], velocity = [0.5, 0, 0], interval = "0.04 s" }
[[walls]]
name = "floor"
material = "steel"
plane = { point = [0, 0, 0], normal = [0, 0, 1] }
[record]
frames = "10 ms"
[bruise]
predictor = "absorbed energy"
threshold = "5 mJ"
threshold_sd = "1 mJ"
susceptibility = "3000 mm^3/J"
limits = ["100 mm^3"]
"""
STUDY = """format = 1
title = "Height of the fall"
scene = "scene.toml"
replicates = 2
[[vary]]
name = "height"
levels = [{ name = "low" }, { name = "high", move = { names = ["apples"], by = [0, 0, 0.1] } }]
"""


class Run:
    """A command that runs in a folder, with a folder for temporary files of its own."""

    def __init__(self, words, folder, before=()):
        temporary = folder.parent / (folder.name + ".tmp")
        temporary.mkdir(exist_ok=True)
        self.told = tempfile.TemporaryFile()
        self.serves = "serve" in words
        self.process = subprocess.Popen(
            [*before, *words], cwd=folder, env={**os.environ, "TMPDIR": str(temporary)}, start_new_session=True,
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE if self.serves else self.told, stderr=self.told)

    def kill(self, alone=False):
        """Kills it with all that it started, or alone."""
        try:
            (os.kill if alone else os.killpg)(self.process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        self.process.wait()

    def end(self):
        """Its exit status, when it has ended."""
        try:
            return self.process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self.kill()
            return "none: it did not end"

    def was_killed(self):
        return self.process.returncode in (-signal.SIGKILL, 128 + signal.SIGKILL)

    def said(self):
        self.told.seek(0)
        return self.told.read().decode(errors="replace").strip()


def run(program, folder, *words):
    """Runs a command that has to succeed."""
    own = Run([program, *words], folder)
    if own.end() != 0:
        raise SystemExit(f"{' '.join(words)}: {own.said()}")


def change(path, old, new):
    text = path.read_text()
    assert old in text, (path, old)
    path.write_text(text.replace(old, new))


def pendulum(program, folder):
    run(program, folder, "simulate", "pendulum", "--law", "kuwabara-kono(k=753599, c=1524)", "--recordings", "c",
        "--specimens", "1", "--repeats", "2")


def several_fruit(program, folder):
    run(program, folder, "simulate", "pendulum", "--law", "kuwabara-kono(k=753599, c=1524)", "--recordings", "c",
        "--specimens", "4", "--repeats", "2", "--spread", "k=50000", "--spread", "c=100")


def compression(program, folder):
    run(program, folder, "simulate", "compression", "c", "--law", "kuwabara-kono(k=300000, c=20000)",
        "--rate", "1 mm/s", "--rate", "20 mm/s")


def relaxation(program, folder):
    """Two fruit squeezed in half a second and held: a Maxwell solid of two elements, with noise."""
    run(program, folder, "new", "relaxation", "c")
    noise = random.Random(1)
    for name, size in [("a", 1.0), ("b", 1.3)]:
        lines = ["time_s,force_N,position_mm"]
        for i in range(2000):
            t = 0.01 * i
            if t < 0.5:
                force = 20 * (t / 0.5) ** 1.5
            else:
                force = 12 + 5 * math.exp(-(t - 0.5) / 0.8) + 3 * math.exp(-(t - 0.5) / 6)
            lines.append(f"{t:.2f},{size * force + noise.gauss(0, 0.01):.4f},{3 * min(t / 0.5, 1):.4f}")
        (folder / f"c/raw/{name}.csv").write_text("\n".join(lines) + "\n")
    (folder / "c/impacts.csv").write_text("id,specimen,file\na,a,a.csv\nb,b,b.csv\n")
    (folder / "c/specimens.csv").write_text("id,variety\na,Golden\nb,Golden\n")


def drops(program, folder):
    run(program, folder, "simulate", "drop", "c", "--law", "adams-impact(k=466143, e=1.91, c=0.556, d=1e-6)",
        "--mass", "4.8 g", "--height", "100 mm", "--drops", "1", "--plate-mass", "0.2 kg",
        "--plate-stiffness", "648 N/mm", "--plate-damping", "0.05247 N s/mm")
    change(folder / "c/campaign.toml", "adams-impact(d=1e-6)", "adams-impact(e=1.91, d=1e-6)")


def scene(_, folder):
    (folder / "c").mkdir()
    (folder / "c/scene.toml").write_text(SCENE)


def study(program, folder):
    scene(program, folder)
    (folder / "c/study.toml").write_text(STUDY)
    change(folder / "c/scene.toml", "count = 5", "count = 2")


class Command:
    """A command over the files that `make` makes.

    before: words of an earlier run in its place, or a change of a file (name, old, new) during it
    working: further names of unfinished files
    differs: names of files that are never the same
    aside: a folder, and the name that it has until the new one is whole
    resume: words to add where an unfinished run is there
    needs: a program that must be installed
    """

    changes_inputs = False
    # Files of the user among the results.
    given = re.compile("$^")

    def __init__(self, make, words, before, working="$^", differs="$^", aside=("", ""), resume=None, needs=None):
        self.make, self.words, self.before = make, words.split(), before
        self.working, self.differs = re.compile(working), re.compile(differs)
        self.aside, self.resume, self.needs = aside, resume, needs

    def earlier(self, program, folder):
        if isinstance(self.before, str):
            return run(program, folder, *self.before.split())
        name, old, new = self.before
        change(folder / name, old, new)
        run(program, folder, *self.words)
        change(folder / name, new, old)

    def whole(self, program, folder, snapshot, times):
        """States before and after an undisturbed run."""
        states = [snapshot()]
        begin = time.monotonic()
        run(program, folder, *self.words)
        times.append(time.monotonic() - begin)
        return [*states, snapshot()]

    def launch(self, program, folder, before):
        return Run([program, *self.words], folder, before)

    def kill_at(self, own, seconds, alone):
        """Kills it so many seconds after its start; whether it had not ended, and how many states are past."""
        if seconds is None:
            own.end()
        else:
            try:
                own.process.wait(seconds)
            except subprocess.TimeoutExpired:
                own.kill(alone)
        return own.was_killed(), int(own.process.returncode == 0)

    def finish(self, program, folder, _):
        """Takes the work up again; what is wrong with that."""
        own = Run([program, *self.words], folder)
        status = own.end()
        if status and self.resume and "--restart" in own.said():
            own = Run([program, *self.words, self.resume], folder)
            status = own.end()
        return [f"the next run has status {status}: {own.said()[-300:]}"] if status else []


class PageSaves:
    """What the page saves through the HTTP interface of a server, in turn."""

    changes_inputs = True
    given = re.compile(r"/tables/\w+\.csv$")
    working = differs = re.compile("$^")
    aside, needs = ("", ""), None

    def make(self, program, folder):
        pendulum(program, folder)

    def earlier(self, program, folder):
        problems = self.all_steps(program, folder, self.steps(folder, "earlier", "hunt-crossley", 2.0))
        assert not problems, problems

    def steps(self, folder, name="new", law="kuwabara-kono", end=1.0):
        """Method, path and body of each save; `name` is that of what it makes."""
        text = re.sub("^# .*", f"# A remark: {name}.", (folder / "c/campaign.toml").read_text())
        recording = (folder / "c/raw/specimen-01-01.csv").read_bytes()
        own = "/api/campaigns/c"
        impact = {"id": name, "specimen": f"{name}-fruit", "file": f"{name}.csv"}
        return [
            ("PUT", f"{own}/text", {"text": text}),
            ("PUT", f"{own}/raw?file={name}.csv", recording),
            ("POST", f"{own}/impacts", {"impacts": [impact]}),
            ("PUT", f"{own}/window", {"impact": "specimen-01-01", "from": 0.0, "to": end}),
            ("PUT", f"{own}/options", {"laws": [law], "group": "specimen"}),
            ("POST", f"{own}/jobs", {"work": "fit"}),
            ("PUT", f"{own}/table?file={name}.csv", b"a,b\n1,2\n" * 1000),
            ("POST", "/api/campaigns", {"id": name, "kind": "pendulum"}),
        ]

    def launch(self, program, folder, before):
        own = Run([program, "serve", ".", "--no-open", "--port", "0"], folder, before)
        own.folder = folder
        return own

    def save(self, own, step):
        """Makes a save and waits until it is done; the status, and what was told."""
        def ask(method, path, body=None):
            connection = http.client.HTTPConnection("127.0.0.1", own.port, timeout=PATIENCE)
            data = body if body is None or isinstance(body, bytes) else json.dumps(body).encode()
            head = {"Authorization": f"Bearer {own.token}", "X-Windfall": "page", "If-Match": "*"}
            if not isinstance(body, bytes):
                head["Content-Type"] = "application/json"
            connection.request(method, path, data, head)
            answer = connection.getresponse()
            told = answer.read()
            connection.close()
            return answer.status, told

        status, told = ask(*step)
        while status == 202:
            job = json.loads(told)
            if job["state"] != "running":
                return (200 if job["state"] == "done" else 500), told
            time.sleep(0.01)
            told = ask("GET", f"/api/jobs/{job['job']}")[1]
        return status, told

    def begin(self, own):
        """Waits for the address of the server; whether it gave one."""
        found = re.match(rb"http://127\.0\.0\.1:(\d+)/\?token=(\w+)", own.process.stdout.readline())
        if found:
            own.port, own.token = int(found[1]), found[2].decode()
        return bool(found)

    def all_steps(self, program, folder, steps, after=lambda: None):
        """Makes saves; those that are refused because they were made already are right."""
        own = self.launch(program, folder, ())
        problems = []
        if not self.begin(own):
            return [f"the next server does not start: {own.said()[-300:]}"]
        for step in steps:
            status, told = self.save(own, step)
            if status >= 300 and status not in (400, 409, 422):
                problems.append(f"{step[0]} {step[1]}: status {status}: {told[-300:]}")
            after()
        own.process.terminate()
        own.end()
        own.process.stdout.close()
        return problems

    def whole(self, program, folder, snapshot, times):
        states = [snapshot()]
        begin = time.monotonic()
        problems = self.all_steps(program, folder, self.steps(folder), lambda: states.append(snapshot()))
        times.append(time.monotonic() - begin)
        assert not problems, problems
        return states

    def kill_at(self, own, seconds, alone):
        if seconds is not None:
            timer = threading.Timer(seconds, own.kill, [alone])
            timer.start()
        done = 0
        try:
            if self.begin(own):
                for step in self.steps(own.folder):
                    self.save(own, step)
                    done += 1
        except (OSError, http.client.HTTPException):
            pass
        own.process.stdout.close()
        killed = done < len(self.steps(own.folder))
        if seconds is not None:
            timer.cancel()
        if not killed:
            # With the tracer, which would wait for it; the timer may have been as fast.
            with contextlib.suppress(ProcessLookupError):
                os.killpg(own.process.pid, signal.SIGTERM)
        own.end()
        return killed, done

    def finish(self, program, folder, done):
        return self.all_steps(program, folder, self.steps(folder)[done:])


ENGINE = r"/engine/(screen\.txt|log\.\w+|frames\.\w+|restart_forced_liggghts_\d+\.data)$"
SEED = ("c/scene.toml", "seed = 1", "seed = 2")
RUN = "scene run c/scene.toml --threads 2"
KINDS = {
    "fit": Command(pendulum, "fit c --threads 2 --figures figures --card law.toml",
                   "fit c --law hunt-crossley --figures figures --card law.toml"),
    "fit of compressions": Command(compression, "fit c --threads 2 --figures figures",
                                   ("c/campaign.toml", 'title = "', 'title = "earlier ')),
    "fit of relaxations": Command(relaxation, "fit c --threads 2 --figures figures",
                                  ("c/campaign.toml", 'title = "', 'title = "earlier ')),
    "report": Command(pendulum, "report c --threads 2", "report c --law hunt-crossley"),
    "population": Command(several_fruit, "population c --threads 2 --card law.toml",
                          "population c --law hunt-crossley --card law.toml"),
    "calibrate": Command(drops, "calibrate c --way waveform --figures figures --tables tables --card law.toml",
                         ("c/campaign.toml", "e=1.91", "e=1.9")),
    "scene run": Command(scene, RUN, SEED, resume="--resume"),
    "scene run, LAMMPS": Command(scene, f"{RUN} --engine lammps", SEED, working=ENGINE, differs=ENGINE,
                                 resume="--restart", needs="lmp"),
    "scene run, LAMMPS, 2 ranks": Command(scene, f"{RUN} --engine lammps --ranks 2", SEED, working=ENGINE,
                                          differs=ENGINE, resume="--restart", needs="mpirun"),
    "scene run, LIGGGHTS": Command(scene, f"{RUN} --engine liggghts", SEED, working=ENGINE, differs=ENGINE,
                                   resume="--restart", needs="liggghts"),
    "study": Command(study, "scene study c/study.toml --threads 2", SEED, working=r"/variants\.(earlier|replaced)/",
                     aside=("/variants/", "/variants.earlier/")),
    "saves of the page": PageSaves(),
}


def is_there(kind):
    return kind.needs is None or shutil.which(kind.needs) is not None
