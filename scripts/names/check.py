"""Hostile names, and what is checked with them."""

import re
import subprocess
from pathlib import Path

# What some language gives a meaning. HIT: a file or a mark that only a name that was run makes.
PIECES = [
    "\n", "\r", "\r\n", "\t", "\v", "\f", "\0", "\x1b[2J", "\x7f", "\x85", "\u2028", "\u2029", "\ufeff", "\ufffe",
    "\uffff", "\u202e", "\u202d", "\u2066", "\u2069", "\u200b", "\u200f", "\u061c", "\u00ad", "\U000e0041", "\ue000",
    '"', "'", "`", '"""', "'''", "“", "”", "‘", "’", "´", "″", "＂", "＇", "\\", "\\\\", '\\"', "\\n", "\\u000a", "\\x0a",
    "\\N{LINE FEED}", "\\", " \\", "\\ ", "??/", "??/ ", "?\\?/", "&", " &", "& ", "&&", ",", ";", ":", "|", "!", "#", "##",
    "$", "$$", "${", "}", "${HOME}", "$x", "$(", ")", "$(touch HIT)", "`touch HIT`", "; touch HIT", "| touch HIT",
    "\ntouch HIT\n", "&& touch HIT", "' ; touch HIT ; '", '" ; touch HIT ; "', "*/", "/*", "//", "-- ", "<!--", "-->",
    "<![CDATA[", "]]>", "<?", "?>", "</script>", "</style>", "</title>", "</textarea>", "</svg>", "<", ">", "<b>",
    "<script>document.documentElement.id='HIT'</script>", "<svg onload=\"document.documentElement.id='HIT'\">",
    "<img src=x onerror=\"document.documentElement.id='HIT'\">", "\" onload=\"document.documentElement.id='HIT'",
    "' autofocus onfocus='document.documentElement.id=\"HIT\"", "javascript:document.documentElement.id='HIT'",
    "&quot;", "&#10;", "&#x22;", "&amp;lt;", "&lt;script&gt;", "%", "%s", "%n", "%0a", "{}", "{0}", "{{", "}}",
    "=1+1", "=HYPERLINK(\"http://x\")", "+1+1", "-1+1", "@SUM(A1)", "+cmd|' /C calc'!A0", "＝1", "'=1", "''", "-",
    "\nimport os\n", "\nimport os; os.system('touch HIT')\n", "coding: utf-7 +AAo-import os+AAo-",
    "-*- coding: unicode_escape -*-", "coding=utf-7 +AAo-raise SystemExit+AAo-", "vim: set fileencoding=utf-7 :",
    "\nshell touch HIT\n", "\nprint HIT\n", "\nquit\n", "variable x string 1", "include HIT", "jump SELF", "$(step)",
    "#include \"HIT\"", "\n#include \"HIT\"\n", "\n#error HIT\n", "#define auto HIT", "_Pragma(\"HIT\")", "R\"(", ")\"",
    "[", "]", "[[", "]]", "\n[fit]\n", "\nx = 1\n", "(", "^2", "²", "~", "*", "?", "@", "🍏", "👩‍👩‍👧", "é", "e\u0301", "Ω",
    "\u3000", "\u00a0", "\u2009", "x" * 300, "🍏" * 300, "&" * 200 + "\\", "a " * 1200, "y" * 5000,
]
WORDS = ["apple", "steel plate", "Äpfel", "pad 4 mm", "a", "wall", "conveyor", "りんご", "1", "fruit"]
# What windfall, as its readers of tables do, takes off the ends of a cell.
BLANKS = "".join(chr(own) for own in range(0x3001) if chr(own).isspace() and not 0x1c <= own <= 0x1f)

JOBS = 4


def names_of(source, number):
    """Different names, each mutated from a word and some pieces; and plain ones."""
    found = {}
    while len(found) < number:
        name = source.choice(WORDS)
        for _ in range(source.choice([1, 1, 1, 2, 3])):
            piece = source.choice(PIECES)
            at = source.choice([0, len(name), len(name), source.randrange(len(name) + 1)])
            name = name[:at] + piece + name[at:]
        if source.random() < 0.05:
            name = name[source.randrange(len(name)):]
        if name.strip(BLANKS) and name.strip(BLANKS) not in found:
            found[name.strip(BLANKS)] = name
    return list(found.values())


def plain(number):
    return [f"plain name {own}" for own in range(number)]


def parts(items, size):
    return [items[own:own + size] for own in range(0, len(items), size)]


def is_number(text):
    return re.fullmatch(r"[+-]?(\d+[.,]?\d*|[.,]\d+)([eE][+-]?\d+)?|[+-]?(inf(inity)?|nan)", text, re.I) is not None


class Check:
    """What is checked, and what was found."""

    def __init__(self, program, scratch, source, number):
        self.program, self.scratch, self.number = Path(program).resolve(), scratch, number
        self.names = names_of(source, number)
        self.counts = {}
        self.faults = []

    def run(self, *words, folder=None, status=0):
        done = subprocess.run([self.program, *map(str, words)], capture_output=True, cwd=folder or self.scratch,
                              timeout=600)
        told = done.stderr.decode()
        if done.returncode not in (0, status) or "panicked" in told:
            raise RuntimeError(f"{words}: status {done.returncode}: {told[:400]}")
        return done.returncode, done.stdout.decode(), told

    def expect(self, holds, target, what, *shown):
        if not holds:
            self.faults.append(f"{target}: {what}: " + " | ".join(ascii(own)[:300] for own in shown))

    def count(self, target, parsed, refused=0):
        before = self.counts.get(target, (0, 0))
        self.counts[target] = (before[0] + parsed, before[1] + refused)

    def folder(self, name):
        path = self.scratch / name
        path.mkdir(parents=True)
        return path

    def unrun(self, folder, target):
        """Nothing that a name asked for has happened."""
        hits = [str(own) for own in folder.rglob("HIT") if own.is_file()]
        self.expect(not hits, target, "a name was run", hits)
