#!/usr/bin/env python3
"""A server with one fault, on which hostile_requests.py is tried.

    scripts/faulty_server.py FAULT serve DIR …     as `windfall serve` is started
    scripts/faulty_server.py FAULT simulate …      makes a campaign of one file
"""

import json
import os
import sys
import time
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from urllib.parse import unquote, urlsplit

# Faults, and a part of the problem that is to be reported of each; none where there is no fault.
FAULTS = {
    "": None,
    "fails on a percent sign": "500 ",
    "fails on a deep body": "500 ",
    "dies of a long name": "the server has died",
    "hangs on a blank": "late ",
    "is slow on a blank": "slow ",
    "reads through ..": "told what lies outside",
    "reads absolute paths": "told what lies outside",
    "reads through links": "told what lies outside",
    "writes through ..": "something outside",
    "writes where it was started": "something outside",
    "leaves files in the temporary folder": "something outside",
    "stops listing": "does not list its campaigns",
    "panics and answers": "panicked",
}
TOKEN = "0" * 32
NAME = {"name": "id", "in": "path", "required": True, "schema": {"type": "string"}}
GIVEN = {"type": "object", "properties": {"id": {"type": "string"}, "file": {"type": "string"}}}
DESCRIPTION = {
    "components": {"schemas": {"Given": GIVEN}},
    "paths": {
        "/api/campaigns": {"get": {}, "post": {"requestBody": {"content": {
            "application/json": {"schema": {"$ref": "#/components/schemas/Given"}}}}}},
        "/api/campaigns/{id}/events": {"get": {"parameters": [NAME]}},
        "/api/campaigns/{id}": {"get": {"parameters": [NAME]}, "put": {"parameters": [NAME]}},
        "/api/files/{file}": {"get": {"parameters": []}},
    },
}


class Handler(BaseHTTPRequestHandler):
    fault, served, broken = "", None, False

    def answer(self):
        length = self.headers.get("Content-Length") or "0"
        body = self.rfile.read(int(length) if length.isdigit() else 0)
        path = urlsplit(self.path.encode("latin-1", "replace").decode("latin-1")).path
        status, told = self.answered(path, body)
        self.send_response(status)
        self.send_header("Content-Length", str(len(told)))
        self.end_headers()
        self.wfile.write(told)

    def answered(self, path, body):
        """Status and text; nothing else happens without the fault."""
        fault, name = self.fault, unquote(path.rsplit("/", 1)[-1])
        if path == "/api/openapi.json":
            return 200, json.dumps(DESCRIPTION).encode()
        if path == "/api/campaigns" and self.command == "GET":
            return (503 if self.broken else 200), b"[]"
        if fault == "fails on a percent sign" and "%25" in path:
            return 500, b""
        if fault == "fails on a deep body" and body.startswith(b"[[[["):
            return 500, b""
        if fault == "dies of a long name" and len(name) > 2000:
            os._exit(1)
        if " " in name and fault in ("hangs on a blank", "is slow on a blank"):
            time.sleep(60 if fault.startswith("hangs") else 0.7)
        if fault == "panics and answers" and "\0" in name:
            print("thread 'main' panicked at a name", file=sys.stderr, flush=True)
        if fault == "stops listing" and self.command == "PUT":
            Handler.broken = True
        try:
            return self.file(name, body)
        except (OSError, ValueError):
            return 404, b""

    def file(self, name, body):
        fault = self.fault
        plain = "/" not in name and name not in ("", ".", "..")
        place = Path(self.served, name)
        if self.command != "GET":
            if fault == "writes through .." and ".." in name:
                place.write_bytes(body)
            if fault == "writes where it was started" and plain:
                Path(name).write_bytes(body)
            if fault.startswith("leaves files"):
                Path(os.environ["TMPDIR"], "left").write_bytes(body)
            return 204, b""
        allowed = plain
        if fault == "reads through ..":
            allowed = not name.startswith("/")
        if fault == "reads absolute paths":
            allowed = ".." not in name
        # Devices and pipes would take for ever.
        if not allowed or not place.is_file() or place.is_symlink() and fault != "reads through links":
            return 404, b""
        return 200, place.read_bytes()

    def log_message(self, *_):
        pass


for method in ["GET", "HEAD", "POST", "PUT", "DELETE", "PATCH", "OPTIONS", "TRACE", "CONNECT", "BREW"]:
    setattr(Handler, f"do_{method}", Handler.answer)


def main(fault, command, *words):
    if command == "simulate":
        bench = Path(words[words.index("--recordings") + 1])
        Path(bench, "raw").mkdir(parents=True)
        Path(bench, "campaign.toml").write_text("format = 1\n")
    if command == "serve":
        Handler.fault, Handler.served = fault, Path(words[0]) / "bench"
        server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        print(f"http://127.0.0.1:{server.server_port}/?token={TOKEN}", flush=True)
        server.serve_forever()


if __name__ == "__main__":
    main(*sys.argv[1:])
