/** What goes wrong around the page: servers and campaigns that vanish, files changed by
 *  hand, browsers without WebGL, names and tables out of measure, clocks elsewhere. */

import assert from "node:assert/strict";
import { mkdir, readFile, rm, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import {
  accessible,
  end,
  fits,
  launch,
  open,
  pendulum,
  pictures,
  scratch,
  serve,
  visit,
  windfall,
} from "./helpers.mjs";

let place;
let server;
let browser;

before(async () => {
  place = await scratch();
  for (const name of ["apples", "gone"]) await pendulum(place.directory, name);
  await windfall("simulate", "tap", join(place.directory, "taps"), "--frequency", "800 Hz", "--quality", "20");
  await windfall("fit", join(place.directory, "taps"), "--quiet");
  server = await serve(place.directory);
  browser = await launch("--disable-3d-apis");
});

after(() => end({ browser, server, place }));

/** A page with its own window; the server is asked for a new one, as its token is spent. */
let shared;
async function window(options = {}) {
  shared ??= await open(browser, server, { expected: () => true });
  if (Object.keys(options).length === 0) return shared;
  const cookies = await shared.context.cookies();
  const view = await open(browser, { ...server, address: server.origin }, { ...options, expected: () => true });
  await view.context.addCookies(cookies);
  await view.page.reload();
  return view;
}

const mainWords = (page) => page.evaluate(() => document.querySelector("main").innerText);

/** No exception; failed requests are what these tests are about. */
const exceptions = (view) => view.troubles.splice(0).filter((trouble) => trouble.startsWith("exception"));

test("a campaign that is deleted while it is open says so, and the others open", async () => {
  const view = await window();
  const { page } = view;
  await visit(page, "#/c/gone/overview");
  await page.getByRole("heading", { name: "Simulated pendulum campaign" }).waitFor();
  await rm(join(place.directory, "gone"), { recursive: true });
  await visit(page, "#/c/gone/recordings");
  await page.getByRole("alert").filter({ hasText: /gone/ }).first().waitFor();
  await pictures(page, "bad-deleted");
  await fits(page, "deleted");
  await page.reload();
  await page.getByRole("alert").filter({ hasText: /gone/ }).first().waitFor();
  assert.doesNotMatch(await mainWords(page), /Reading/);
  await page.getByRole("link", { name: "All campaigns", exact: true }).click();
  await page.getByRole("heading", { name: "Campaigns", exact: true }).waitFor();
  assert.deepEqual(exceptions(view), []);
});

test("a campaign.toml that is broken by hand keeps what was shown, and mends itself", async () => {
  const view = await window();
  const { page } = view;
  const file = join(place.directory, "taps", "campaign.toml");
  const text = await readFile(file, "utf8");
  await visit(page, "#/c/taps/overview");
  await page.getByRole("heading", { name: "Results" }).waitFor();
  await writeFile(file, text.replace("[rig]", "[rig"));
  await page.getByRole("alert").filter({ hasText: /campaign\.toml/ }).first().waitFor();
  await page.getByRole("heading", { name: "State" }).waitFor();
  await pictures(page, "bad-toml");
  await writeFile(file, text.replace(/title = ".*"/, 'title = "Taps anew"'));
  await page.getByRole("heading", { name: "Taps anew" }).waitFor();
  await page.getByRole("alert").filter({ hasText: /campaign\.toml/ }).waitFor({ state: "hidden" });
  // A recording that is cut off while it is shown.
  await visit(page, "#/c/taps/item/fruit-1-1");
  await page.getByRole("heading", { name: "Values" }).waitFor();
  const raw = join(place.directory, "taps", "raw", "fruit-1-1.wav");
  const bytes = await readFile(raw);
  await writeFile(raw, bytes.subarray(0, 60));
  await writeFile(file, text);
  await page.getByText(/changed since|Not evaluated/).first().waitFor();
  await writeFile(raw, bytes);
  assert.deepEqual(exceptions(view), []);
});

test("names of 300 letters and from right to left fit, and lead nowhere else", async () => {
  const directory = join(place.directory, "names");
  await windfall("simulate", "tap", directory, "--frequency", "800 Hz", "--quality", "20");
  const long = "Ω".repeat(300);
  const arabic = "تفاح ذهبي (٣)";
  const toml = join(directory, "campaign.toml");
  await writeFile(toml, (await readFile(toml, "utf8")).replace(/title = ".*"/, `title = "${long} ${arabic}"`));
  for (const name of ["impacts.csv", "specimens.csv"]) {
    const path = join(directory, name);
    const renamed = (await readFile(path, "utf8"))
      .replaceAll("fruit-1-1,", `${long},`)
      .replaceAll("fruit-2-1,", `${arabic},`)
      .replaceAll("fruit-3,", `${arabic} ${long},`);
    await writeFile(path, renamed);
  }
  await windfall("fit", directory, "--quiet");
  const view = await window();
  const { page } = view;
  for (const part of ["overview", `item/${encodeURIComponent(long)}`, `item/${encodeURIComponent(arabic)}`, "table", "recordings", "report"]) {
    await visit(page, `#/c/names/${part}`);
    await page.locator("main h1").waitFor();
    await page.waitForFunction(() => !/Reading/.test(document.querySelector("main").innerText));
    await fits(page, part.slice(0, 20));
    await accessible(page, part.slice(0, 20));
  }
  await visit(page, `#/c/names/item/${encodeURIComponent(arabic)}`);
  await page.getByRole("heading", { name: "Values" }).waitFor();
  await pictures(page, "bad-names");
  await visit(page, "#/");
  await page.getByRole("heading", { name: "Campaigns", exact: true }).waitFor();
  await fits(page, "list of campaigns");
  assert.deepEqual(exceptions(view), []);
});

test("a table of 200 columns is scrolled within itself", async () => {
  const directory = join(place.directory, "apples");
  const names = Array.from({ length: 200 }, (_, column) => `measured_${column + 1}_N`);
  const rows = Array.from({ length: 40 }, (_, row) => names.map((_, column) => (row * 7 + column * column) % 23));
  await mkdir(join(directory, "tables"), { recursive: true });
  await writeFile(join(directory, "tables", "wide.csv"), [names, ...rows].map((row) => row.join(",")).join("\n") + "\n");
  await windfall("fit", directory, "--quiet");
  // The table of results has as many, from impacts.csv.
  const file = join(directory, "impacts.csv");
  const [header, ...lines] = (await readFile(file, "utf8")).trim().split("\n");
  await writeFile(file, [`${header},${names}`, ...lines.map((line, row) => `${line},${rows[row]}`)].join("\n") + "\n");
  const view = await window();
  const { page } = view;
  for (const part of ["regress", "surface", "table", "import/specimen-01.csv"]) {
    await visit(page, `#/c/apples/${part}`);
    await page.locator("main h1").waitFor();
    await page.waitForFunction(() => !/Reading/.test(document.querySelector("main").innerText));
    await page.waitForTimeout(500);
    await fits(page, part);
  }
  await visit(page, "#/c/apples/table");
  await page.getByText(/^Columns \(/).click();
  await page.evaluate(() => {
    for (const box of document.querySelectorAll("details.choice input:not(:checked)")) box.click();
  });
  await page.getByText(/^Columns \(2\d\d\)/).click();
  const last = page.getByRole("columnheader", { name: "measured_200_N" });
  await last.scrollIntoViewIfNeeded();
  const box = await last.boundingBox();
  assert.ok(box.x >= 0 && box.x + box.width <= 1441, JSON.stringify(box));
  await fits(page, "all columns");
  await pictures(page, "bad-columns");
  assert.deepEqual(exceptions(view), []);
});

test("without WebGL a scene says so, and its numbers are there", async () => {
  const file = join(place.directory, "chute", "scene.toml");
  await windfall("new", "scene", join(place.directory, "chute"));
  const text = (await readFile(file, "utf8")).replace("count = 100", "count = 5").replace('end = "4 s"', 'end = "0.5 s"');
  await writeFile(file, text);
  await windfall("scene", "run", file);
  const view = await window();
  const { page } = view;
  await visit(page, "#/");
  await page.locator("section[aria-labelledby=scenes] a").first().click();
  await page.getByText(/WebGL/).first().waitFor();
  assert.doesNotMatch(await mainWords(page), /Reading|Opening/);
  await fits(page, "no WebGL");
  await pictures(page, "bad-webgl");
  assert.deepEqual(exceptions(view), []);
});

test("a clock in another zone shows the moment of the fit there", async () => {
  const [{ run }] = (
    await (await fetch(`${server.origin}/api/campaigns`, { headers: server.admitted })).json()
  ).filter((entry) => entry.id === "taps");
  for (const timezoneId of ["Pacific/Kiritimati", "America/St_Johns"]) {
    const view = await window({ timezoneId });
    const { page } = view;
    await visit(page, "#/c/taps/overview");
    await page.getByRole("heading", { name: "State" }).waitFor();
    const there = new Intl.DateTimeFormat("en-US", { timeZone: timezoneId, dateStyle: "medium", timeStyle: "short" }).format(new Date(run.time));
    const words = await page.locator("dl.pairs").first().innerText();
    assert.ok(words.replace(/\s/g, " ").includes(there.replace(/\s/g, " ")), `${there} is not in ${words}`);
    await view.context.close();
  }
});

test("a server that is gone is told, whatever is open", async () => {
  const view = await window();
  const { page } = view;
  await visit(page, "#/c/taps/overview");
  await page.getByRole("heading", { name: "Results" }).waitFor();
  await server.stop();
  for (const part of ["item/fruit-1-2", "recordings", "table", "report", "regress", "overview"]) {
    await visit(page, `#/c/taps/${part}`);
    await page.locator("main h1").waitFor();
    await page.getByText(/windfall does not answer|No connection/).first().waitFor();
    await page.waitForFunction(() => !/Reading/.test(document.querySelector("main").innerText));
  }
  await pictures(page, "bad-server");
  await visit(page, "#/");
  await page.getByRole("button", { name: "Try again" }).waitFor();
  assert.deepEqual(exceptions(view), []);
});
