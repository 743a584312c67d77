#!/usr/bin/env python3
"""Sends hostile requests to `windfall serve`: names that lead out of the directory, pipes and
devices, bodies of wrong types, depths and sizes, wrong methods and content types.

    scripts/hostile_requests.py PROGRAM [NUMBER [SEED]]     2000 requests by default
    scripts/hostile_requests.py --self-test [NUMBER]        the same of servers with faults

No answer may be a failure of the server (status 500 and above) or come late, and nothing
outside of the served directory may change or be told. The self-test asks servers that do one
of these each (faulty_server.py) and fails where that is not found. Standard library only.
"""

import hashlib
import http.client
import json
import os
import random
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from urllib.parse import quote

import faulty_server

PATIENCE = 20  # s
ENOUGH = 10  # problems
SECRET = "7391846520"

# A name is put into paths, queries and bodies as it is and quoted.
NAMES = [
    "..", ".", "", "/", "//", "../..", "../beside/secret.csv", "../../beside/secret.csv", "..\\beside",
    "%2e%2e", "%2e%2e%2fbeside", "..%2f..%2fbeside%2fsecret.csv", "%252e%252e", "%00", "a%00.csv", "\0", "a\nb",
    "a\r\nSet-Cookie: x=y", "/etc/passwd", "/dev/zero", "/dev/stdin", "/proc/self/environ", "//host/share",
    "C:\\Windows", "C:x", "CON", "NUL.csv", "aux", "com1.txt", "a:b", "file.csv::$DATA", "*", "?", "|", "<>",
    '"', "'", "`id`", "$(id)", "${HOME}", "~", "~root", "-rf", "--help", "x" * 121, "x" * 300, "y" * 5000,
    "a/" * 500 + "b", "é" * 60, "\u202e.csv", "\ufeff", "🍏.csv", " ", "a ", "a.", ".hidden", "link",
    "link/secret.csv", "zero.csv", "pipe.csv", "pipe", "zero", "secret-link.csv", "folder.csv", "bench",
    "bench/raw", "impacts.csv", "campaign.toml", "results.sqlite", "specimen-01.csv", "tables/pipe.csv",
    "tables/results.csv", "report.html", "figures", "law.toml", "scene.run", "pipe.run", "bench/../bench",
    "1", "0", "-1", "1e309", "9" * 400, "NaN", "undefined", "null", "[]", "{}", "\ud800",
]
TYPES = ["application/json", "application/json; charset=utf-16", "text/plain", "multipart/form-data", "", "é"]
METHODS = ["GET", "HEAD", "POST", "PUT", "DELETE", "PATCH", "OPTIONS", "TRACE", "CONNECT", "BREW"]
QUERIES = ["file", "channel", "from", "to", "points", "law", "most", "fruit", "token"]
EVENTS = "/api/campaigns/{id}/events"  # never ends


def prepare(program, scratch):
    """A served directory with traps in it, and one beside that nobody may touch."""
    served, beside = scratch / "served", scratch / "beside"
    beside.mkdir(parents=True)
    for name in ["secret.csv", "laws.toml", "campaign.toml"]:
        (beside / name).write_text(f"displacement_m,force_N\n0,0\n1,{SECRET}\n")
    run = lambda *words: subprocess.run([*program, *map(str, words)], check=True, capture_output=True)
    bench = served / "bench"
    run("simulate", "pendulum", "--law", "kuwabara-kono(k=394931, c=681)", "--recordings", bench,
        "--specimens", 2, "--repeats", 1)
    run("fit", bench)
    (bench / "tables").mkdir(exist_ok=True)
    (served / "pipe.run").mkdir()
    for folder in [served, bench, bench / "raw", bench / "tables"]:
        (folder / "link").symlink_to(beside)
        (folder / "secret-link.csv").symlink_to(beside / "secret.csv")
        for name in ["zero", "zero.csv"]:
            (folder / name).symlink_to("/dev/zero")
        for name in ["pipe", "pipe.csv"]:
            os.mkfifo(folder / name)
        (folder / "folder.csv").mkdir()
    for name in ["frames.bin", "scene.json"]:
        os.mkfifo(served / "pipe.run" / name)
    return served, beside


def state(folder):
    """Digests of all files in a folder, and its names."""
    found = sorted(folder.rglob("*"))
    return [(str(own), own.is_file() and hashlib.sha256(own.read_bytes()).hexdigest()) for own in found]


def value(random, depth=0):
    """Any JSON, often wrong and sometimes large."""
    kinds = [
        lambda: random.choice(NAMES),
        lambda: random.choice([0, -1, 1, 2**31, 2**63, 2**64, -(2**63), 1e308, -0.0, 5e-324, 10**400]),
        lambda: random.choice([None, True, False]),
        lambda: "x" * random.choice([0, 1, 1000, 100_000]),
        lambda: [value(random, depth + 1) for _ in range(random.randrange(4))],
        lambda: {random.choice(NAMES): value(random, depth + 1) for _ in range(random.randrange(4))},
    ]
    return random.choice(kinds[: 4 if depth > 3 else 6])()


def filled(description, schema, random, depth=0):
    """A value of a schema, with some of it replaced."""
    if random.random() < 0.15 or depth > 8:
        return value(random)
    if "$ref" in schema:
        name = schema["$ref"].rsplit("/", 1)[1]
        return filled(description, description["components"]["schemas"][name], random, depth + 1)
    for key in ["oneOf", "anyOf", "allOf"]:
        if key in schema:
            return filled(description, random.choice(schema[key]), random, depth + 1)
    if "enum" in schema:
        return random.choice(schema["enum"])
    kind = schema.get("type")
    kind = random.choice(kind) if isinstance(kind, list) else kind
    if kind == "object" or "properties" in schema:
        own = schema.get("properties", {})
        return {key: filled(description, of, random, depth + 1) for key, of in own.items() if random.random() < 0.9}
    if kind == "array":
        count = random.randrange(3)
        return [filled(description, schema.get("items", {}), random, depth + 1) for _ in range(count)]
    if kind in ("integer", "number"):
        return random.choice([0, 1, -1, 2**53, 1e300, 0.5, 10**30])
    if kind == "boolean":
        return random.random() < 0.5
    return random.choice(NAMES + ["bench", "hertz", "fit", "quadratic", "specimen-01"])


def texts(random, own):
    """campaign.toml with paths in it that lead elsewhere."""
    name = random.choice(NAMES + ["/etc/passwd", "../../beside/secret.csv"])
    line = random.choice(
        ["[laws.own]\ntable = {}", "[files]\ndirectory = {}", "[calibrate]\ncard = {}", "laws = {}", "x = {}"]
    ).format(json.dumps(name))
    deep = "a = " + "[" * 20_000
    return {"text": random.choice([f"{own}\n{line}\n", f"{line}\n{own}", line, deep, name])}


def request(description, own, random):
    """Method, path, headers and body of a hostile request."""
    paths = [path for path in description["paths"] if path != EVENTS]
    path = random.choice([*paths, "/{file}", "/api/{file}"])
    known = description["paths"].get(path, {})
    method = random.choice(list(known)).upper() if known and random.random() < 0.8 else random.choice(METHODS)

    def part(found):
        usual = {"id": ["bench", "pipe.run"], "job": ["1"], "file": ["report.html"]}[found[1]]
        name = random.choice(usual) if random.random() < 0.5 else random.choice(NAMES)
        name = name.encode(errors="surrogatepass")
        return quote(name, safe=random.choice(["", "/%.\\:*"]))

    target = re.sub(r"\{(\w+)\}", part, path)
    if random.random() < 0.7:
        keys = [own["name"] for own in known.get(method.lower(), {}).get("parameters", []) if own["in"] == "query"]
        keys = keys or [random.choice(QUERIES)]
        names = [random.choice(NAMES).encode(errors="surrogatepass") for _ in keys]
        target += "?" + "&".join(f"{key}={quote(name, safe='%/')}" for key, name in zip(keys, names))
    headers = {"X-Windfall": "x", "If-Match": random.choice(["*", '"*"', "x", '"' + "9" * 3000])}
    headers["Content-Type"] = TYPES[0] if random.random() < 0.8 else random.choice(TYPES)
    content = known.get(method.lower(), {}).get("requestBody", {}).get("content", {})
    schema = content.get("application/json", {}).get("schema")
    if path.endswith("/text") and random.random() < 0.7:
        body = json.dumps(texts(random, own))
    elif schema and random.random() < 0.8:
        body = json.dumps(filled(description, schema, random))
    else:
        body = random.choice([None, "", "{", "[" * 50_000, '{"a":' * 5000, "\0", json.dumps(value(random)), b"\xff\xfe"])
    return method, target, headers, body.encode() if isinstance(body, str) else body


class Server:
    def __init__(self, program, served, log, own):
        words = [*program, "serve", str(served), "--no-open", "--port", "0", "--upload-limit", "1"]
        home, temporary = own
        self.process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=log, cwd=home,
                                        env={**os.environ, "HOME": str(home), "TMPDIR": str(temporary)})
        line = self.process.stdout.readline().decode()
        found = re.match(r"http://127\.0\.0\.1:(\d+)/\?token=(\w+)", line)
        self.port, self.token = int(found[1]), found[2]

    def ask(self, method, target, headers=None, body=None):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE)
        # Nothing of what is sent is checked here.
        connection._validate_path = connection._validate_method = lambda _: None
        headers = {"Authorization": f"Bearer {self.token}", **(headers or {})}
        headers = {key: text.encode("utf-8") for key, text in headers.items()}
        try:
            connection.request(method, target, body, headers)
            answer = connection.getresponse()
            return answer.status, answer.read()
        except TimeoutError:
            return "late", b""
        except (ConnectionError, http.client.HTTPException) as error:
            # Refused before all of the body was read.
            return 0, repr(error).encode()
        finally:
            connection.close()


def attack(program, number, seed):
    """What is wrong with a server, and how often it answered with which status.

    program: words of its command
    """
    draw = random.Random(seed)
    problems, statuses = [], {}
    with tempfile.TemporaryDirectory(prefix="windfall-hostile-") as scratch:
        served, beside = prepare(program, Path(scratch))
        original = (served / "bench" / "campaign.toml").read_text()
        home, temporary = Path(scratch, "home"), Path(scratch, "temporary")
        home.mkdir()
        temporary.mkdir()
        outside = lambda: ([state(own) for own in (beside, home, temporary)], sorted(os.listdir(scratch)))
        before = outside()
        log = tempfile.TemporaryFile()
        server = Server(program, served, log, (home, temporary))
        try:
            description = json.loads(server.ask("GET", "/api/openapi.json")[1])
            for index in range(number):
                asked = request(description, original, draw)
                begin = time.monotonic()
                status, told = server.ask(*asked)
                shown = f"{index}: {asked[0]} {asked[1][:200]} {(asked[3] or b'')[:200]}"
                statuses[status] = statuses.get(status, 0) + 1
                # 507 says that the disk is full.
                if status == "late" or status >= 500:
                    problems.append(f"{status} {shown} {told[:300]}")
                elif SECRET.encode() in told or b"root:x:" in told:
                    problems.append(f"told what lies outside of the directory: {shown}")
                elif time.monotonic() - begin > PATIENCE / 2:
                    problems.append(f"slow {shown}")
                if server.process.poll() is not None:
                    problems.append(f"the server has died: {shown}")
                    break
                if len(problems) >= ENOUGH:
                    break
            listed = server.ask("GET", "/api/campaigns")[0]
            if listed != 200:
                problems.append(f"the server does not list its campaigns any more: {listed}")
        finally:
            server.process.terminate()
            server.process.wait()
        if outside() != before:
            problems.append("something outside of the served directory has changed")
        log.seek(0)
        problems += [line.decode() for line in log if b"panicked" in line]
    return problems, statuses


def main(program, number=2000, seed=1):
    problems, statuses = attack([program], int(number), int(seed))
    print(f"{sum(statuses.values())} hostile requests; statuses {dict(sorted(statuses.items(), key=str))}")
    for problem in problems:
        print(f"hostile_requests: {problem}", file=sys.stderr)
    return bool(problems)


def self_test(number=2000):
    """Whether each fault of faulty_server.py is found, and none in the server without a fault."""
    global PATIENCE
    PATIENCE = 1
    missed = 0
    for fault, sign in faulty_server.FAULTS.items():
        faulty = [sys.executable, faulty_server.__file__, fault]
        problems, _ = attack(faulty, int(number), 1)
        found = [problem for problem in problems if sign in problem] if sign else problems
        right = bool(found) == bool(sign)
        missed += not right
        print(f"{'as it should be' if right else 'WRONG':16}{fault or 'no fault':38}{len(problems)} problems; "
              f"{(found or problems or ['none'])[0].strip()[:90]!r}")
    return bool(missed)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--self-test"]:
        sys.exit(self_test(*sys.argv[2:]))
    sys.exit(main(*sys.argv[1:]))
