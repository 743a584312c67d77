"""Reports, figures, tables and law cards of campaigns."""

import collections
import csv
import io
import shutil
import subprocess
import tomllib
import xml.etree.ElementTree as ElementTree

from check import BLANKS, is_number, parts, plain
from decks import toml_string

FITTED = 2  # impacts of a campaign that are fitted, with figures; of the others the recording is missing
LISTED = 65


def write_campaign(folder, check, names):
    """A campaign whose title, ids, specimens, groups and files have these names."""
    law = "kuwabara-kono(k=753599,c=1524)"
    check.run("simulate", "carriage", "--law", law, "--mass", "0.2kg", "--velocity", "0.5m/s", "--specimens", 1,
              "--recordings", folder)
    names = iter(names)
    settings = (folder / "campaign.toml").read_text()
    settings = settings.replace('"Simulated carriage campaign"', toml_string(next(names)), 1)
    (folder / "campaign.toml").write_text(settings, newline="")
    impacts = [(next(names), next(names), "specimen-01.csv", next(names)) for _ in range(FITTED)]
    impacts += [(next(names), next(names), next(names), "") for _ in range(LISTED)]
    # A spreadsheet quotes what begins like a formula; here the user has not.
    with (folder / "impacts.csv").open("w", newline="") as file:
        table = csv.writer(file, quoting=csv.QUOTE_ALL)
        table.writerows([("id", "specimen", "file"), *(row[:3] for row in impacts)])
    with (folder / "specimens.csv").open("w", newline="") as file:
        table = csv.writer(file, quoting=csv.QUOTE_ALL)
        table.writerows([("id", "variety"), *((row[1], row[3]) for row in impacts)])
    return impacts


NAMES = 1 + 4 * FITTED - FITTED + 3 * LISTED


def rows_of(check, target, text):
    """Rows of a table, in which no cell is a formula for a spreadsheet."""
    rows = list(csv.reader(io.StringIO(text, newline=""), strict=True))
    for row in rows:
        check.expect(len(row) == len(rows[0]), target, "a row of another length", row, rows[0])
        for cell in row:
            start = cell.lstrip(BLANKS)
            formula = start.startswith(("=", "+", "-", "@", "＝", "＋", "－", "＠")) or cell.startswith(("\t", "\r", "\n"))
            check.expect(not formula or is_number(start.rstrip(BLANKS)), target, "a cell is a formula", cell)
    return rows


def said(cell):
    """What a cell says to those who know the convention: an apostrophe marks a text."""
    rest = cell[1:].lstrip(BLANKS + "'")
    marked = cell.startswith("'") and (rest.startswith(("=", "+", "-", "@", "＝", "＋", "－", "＠")) or
                                       any(own in cell[:len(cell) - len(rest)] for own in "\t\r\n"))
    return cell[1:] if marked and not is_number(rest) else cell


def shape(root, inner="svg"):
    """Elements with the names of their attributes, apart from the layout inside of pictures."""
    found, hostile = collections.Counter(), []

    def walk(element, within):
        tag = element.tag.split("}")[-1] if isinstance(element.tag, str) else "comment"
        for name, value in element.attrib.items():
            elsewhere = {"href": "#", "src": "data:image/svg+xml;base64,"}
            if name.lower().startswith("on") or value == "HIT" or not value.startswith(elsewhere.get(name, "")):
                hostile.append((tag, name, value))
        if tag in ("script", "iframe", "object", "embed", "comment", "foreignObject"):
            hostile.append((tag, str(element.attrib)))
        if not within:
            # Cells of words and of numbers are told apart by what is in them.
            names = set(element.attrib) - ({"class"} if tag == "td" else set())
            found[tag, tuple(sorted(names))] += 1
        for child in element:
            walk(child, within or tag == inner)

    walk(root, False)
    return found, hostile


def shown(name):
    """A cell of a table as HTML gives it back, which has no character of the number 0."""
    return said(name.strip(BLANKS)).replace("\r\n", "\n").replace("\r", "\n").replace("\0", "")


def check_page(check, target, path, names, usual):
    """The page has the elements of a page with plain names, and these names."""
    import html5lib
    root = html5lib.parse(path.read_bytes(), transport_encoding="utf-8")
    found, hostile = shape(root)
    check.expect(not hostile, target, "elements or attributes that are not windfall's", hostile)
    wanted, _ = shape(html5lib.parse(usual.read_bytes(), transport_encoding="utf-8"))
    check.expect(found == wanted, target, "other elements", found - wanted, wanted - found)
    text = "".join(root.itertext())
    for name in names:
        check.expect(shown(name) in text, target, "a name does not come back", shown(name))
    browser = next(filter(None, map(shutil.which, ["chromium", "chromium-browser", "google-chrome"])), None)
    if browser:
        # Without the policy that keeps scripts out: nothing but the quoting protects.
        open_page = path.with_name("open.html")
        open_page.write_bytes(path.read_bytes().replace(b"default-src 'none'", b"default-src 'unsafe-inline'"))
        done = subprocess.run([browser, "--headless", "--no-sandbox", "--disable-gpu", "--dump-dom", open_page.as_uri()],
                              capture_output=True, timeout=120)
        seen = html5lib.parse(done.stdout, transport_encoding="utf-8")
        check.expect(seen.get("id") != "HIT", target, "a name was run by the browser", path)
        again, _ = shape(seen)
        check.expect(again == wanted, target, "other elements in the browser", again - wanted, wanted - again)
    open_page = path.with_name("open.html")
    open_page.unlink(missing_ok=True)


def check_picture(check, target, path):
    root = ElementTree.fromstring(path.read_bytes())
    known = {"svg", "rect", "text", "tspan", "g", "path", "line", "circle", "polyline", "polygon", "clipPath", "defs",
             "radialGradient", "stop", "ellipse", "use", "linearGradient"}
    found, hostile = shape(root, inner="")
    tags = {tag for tag, _ in found}
    check.expect(not hostile and tags <= known, target, "elements that are not windfall's", hostile, tags - known)


def reported(check, folder, names):
    impacts = write_campaign(folder, check, names)
    _, fitted, _ = check.run("fit", folder, "--format", "csv", "--card", folder / "card.toml")
    check.run("report", folder)
    return impacts, fitted


def check_campaign(check):
    groups = parts(check.names, NAMES)
    groups[-1] = (groups[-1] + check.names)[:NAMES] if len(groups) > 1 else (groups[0] + plain(NAMES))[:NAMES]
    usual = check.folder("campaign-plain") / "campaign"
    reported(check, usual, plain(NAMES))
    page = usual / "report" / "report.html"
    for number, names in enumerate(groups):
        folder = check.folder(f"campaign-{number}") / "campaign"
        impacts, fitted = reported(check, folder, names)
        own = [row[:2] + (row[3],) for row in impacts[:FITTED]]
        for table in [fitted, (folder / "report" / "impacts.csv").read_bytes().decode()]:
            rows = rows_of(check, "csv", table)
            columns = [rows[0].index(name) for name in ("id", "specimen", "group")]
            found = [tuple(said(row[column]) for column in columns) for row in rows[1:]]
            wanted = [tuple(said(name.strip(BLANKS)) for name in row) for row in own]
            check.expect(found == wanted, "csv", "names do not come back", found, wanted)
        for table in (folder / "report").rglob("*.csv"):
            rows_of(check, "csv", table.read_bytes().decode())
        card = tomllib.loads((folder / "card.toml").read_bytes().decode())
        check.expect(card["title"] == card["origin"]["campaign"] == names[0], "toml", "a title does not come back",
                     card["title"], names[0])
        check_page(check, "html", folder / "report" / "report.html", [own[0] for own in impacts], page)
        for picture in (folder / "report" / "figures").glob("*.svg"):
            check_picture(check, "svg", picture)
    for target, each in [("html", NAMES), ("csv", NAMES), ("svg", 3 * FITTED), ("toml", 1)]:
        check.count(target, min(each * len(groups), len(check.names)))
