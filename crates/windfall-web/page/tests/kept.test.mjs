/** Work that is kept: in the address, in the campaign's files, in its store. */

import assert from "node:assert/strict";
import { readFile, rename, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { atRest, end, fits, launch, open, pendulum, pictures, scratch, serve, visit, windfall } from "./helpers.mjs";

let place;
let server;
let browser;
let view;
let page;
let apples;

before(async () => {
  place = await scratch();
  apples = await pendulum(place.directory, "apples", 6);
  await windfall("fit", apples, "--quiet");
  server = await serve(place.directory);
  browser = await launch();
  const expected = (words) => /status of 409|\/events\)$/.test(words);
  view = await open(browser, server, { hash: "#/", expected });
  page = view.page;
});

after(() => end({ browser, server, place }));

const inspect = (name) => atRest(page, name);

/** Writes a file as an editor does: whole, or not at all. */
async function edit(file, text) {
  await writeFile(`${file}.new`, text);
  await rename(`${file}.new`, file);
}

const title = (words) => page.getByRole("heading", { level: 1, name: words }).waitFor();
const hash = () => page.evaluate(() => location.hash);
/** The state in the address, once it holds a key. */
async function held(key) {
  await page.waitForFunction((of) => location.hash.includes(`${of}=`), key);
  return Object.fromEntries(new URLSearchParams((await hash()).split("?")[1]));
}
const depth = () => page.evaluate(() => history.length);

test("laws, window and zoom of an impact are in the address, and come back", async () => {
  await visit(page, "#/c/apples/impact/specimen-02");
  await title("Impact specimen-02");
  await page.getByLabel("End of the used part, ms").waitFor();
  const entries = await depth();
  await page.getByRole("checkbox", { name: "hunt-crossley" }).check();
  const end = page.getByLabel("End of the used part, ms");
  const moved = String(Number(await end.inputValue()) - 1);
  await end.fill(moved);
  await end.press("Tab");
  await page.getByRole("button", { name: "Zoom in" }).first().click();
  const state = await held("recording");
  assert.match(state.laws, /;hunt-crossley$/);
  assert.equal(Number(state.to).toFixed(6), (Number(moved) / 1000).toFixed(6));
  assert.match(state.recording, /^-?[\d.e-]+\.\.[\d.e-]+$/);
  assert.equal(await depth(), entries, "small changes make no entries of the history");
  const before = await hash();
  await page.reload();
  await title("Impact specimen-02");
  assert.ok(await page.getByRole("checkbox", { name: "hunt-crossley" }).isChecked());
  assert.equal(await page.getByLabel("End of the used part, ms").inputValue(), moved);
  await page.getByRole("button", { name: "All of it" }).first().and(page.locator(":enabled")).waitFor();
  assert.equal(await hash(), before);
  // The next impact is another place: its zoom is its own, the laws stay.
  await page.keyboard.press("n");
  await title("Impact specimen-03");
  const next = await held("laws");
  assert.equal(next.recording, undefined);
  assert.match(next.laws, /;hunt-crossley$/);
  await page.goBack();
  await title("Impact specimen-02");
  assert.equal((await held("recording")).recording, state.recording);
});

test("a link shows the same elsewhere, without the token", async () => {
  await view.context.grantPermissions(["clipboard-read", "clipboard-write"]);
  await page.getByRole("button", { name: "Copy link" }).click();
  await page.getByText("The link was copied").waitFor();
  const link = await page.evaluate(() => navigator.clipboard.readText());
  assert.ok(link.includes("/impact/specimen-02?") && link.includes("hunt-crossley"), link);
  assert.ok(!link.includes("token"), link);
  const other = await open(browser, server, { hash: new URL(link).hash });
  await other.page.getByRole("heading", { level: 1, name: "Impact specimen-02" }).waitFor();
  assert.ok(await other.page.getByRole("checkbox", { name: "hunt-crossley" }).isChecked());
  await other.context.close();
  assert.deepEqual(other.troubles, []);
});

test("what an address names and is not there is left out and told", async () => {
  await visit(page, "#/c/apples/impact/specimen-01?laws=hertz;banana-law&weights=heavy&t=no");
  await title("Impact specimen-01");
  await page.getByText("not there any more, which was left out: banana-law, heavy").waitFor();
  assert.ok(await page.getByRole("checkbox", { name: "hertz", exact: true }).isChecked());
  await inspect("kept-left-out");
  await page.getByRole("button", { name: "Close this message" }).first().click();
});

test("the table's filter, order, selection and columns come back", async () => {
  await visit(page, "#/c/apples/table");
  await title("Table of results");
  await page.getByRole("searchbox", { name: "Words in a row" }).fill("specimen-0");
  await page.getByLabel("Add a range of").selectOption("impact_velocity");
  await page.getByRole("columnheader", { name: /^k/ }).getByRole("button").click();
  await page.getByRole("checkbox", { name: "Select specimen-04" }).check();
  const state = await held("rows");
  assert.equal(state.find, "specimen-0");
  assert.equal(state.where, "impact_velocity:..");
  assert.equal(state.sort, "k");
  assert.equal(state.rows, "specimen-04");
  await page.reload();
  await title("Table of results");
  await page.getByRole("searchbox", { name: "Words in a row" }).waitFor();
  assert.equal(await page.getByRole("searchbox", { name: "Words in a row" }).inputValue(), "specimen-0");
  await page.locator('th[aria-sort="ascending"]').waitFor();
  assert.deepEqual(await held("sort"), state);
  await visit(page, "#/c/apples/table?where=weight:1..2&sort=-impact_velocity&rows=specimen-05;specimen-99");
  await page.getByText("which was left out: weight, specimen-99").waitFor();
  await page.locator('th[aria-sort="descending"]').waitFor();
  await page.waitForFunction(() => !location.hash.includes("specimen-99"));
  assert.equal((await held("rows")).rows, "specimen-05");
});

test("a regression comes back with its table and formula", async () => {
  // A fit of the page writes the table.
  await visit(page, "#/c/apples/overview");
  await page.getByRole("button", { name: /^Fit/ }).click();
  await page.getByText("Everything is fitted").waitFor();
  await visit(page, "#/c/apples/regress?table=tables/results.csv&response=log(k)&formula=impact_velocity_m_s&columns=impact_velocity_m_s;weight");
  await page.getByText("which was left out: weight.").waitFor();
  const formula = page.getByRole("textbox", { name: /Formula/ });
  assert.equal(await formula.inputValue(), "impact_velocity_m_s");
  await page.getByText("Formula: log(k) ~").waitFor();
  await page.getByRole("button", { name: "impact_velocity_m_s²" }).click();
  await page.waitForFunction(() => location.hash.includes("^2") || location.hash.includes("%5E2"));
  await page.reload();
  await page.getByText("Formula: log(k) ~").waitFor();
  assert.equal(await formula.inputValue(), "impact_velocity_m_s + impact_velocity_m_s^2");
});

test("a save is undone and done again; what came since stands in its way", async () => {
  await visit(page, "#/c/apples/impact/specimen-03");
  await title("Impact specimen-03");
  const file = join(apples, "impacts.csv");
  const began = await readFile(file, "utf8");
  // Without a reason nothing is left out.
  await page.getByRole("button", { name: "Leave it out" }).click();
  await page.getByText("Say why first").waitFor();
  assert.equal(await readFile(file, "utf8"), began);
  await page.getByLabel("Why").fill("slipped");
  await page.getByRole("button", { name: "Leave it out" }).click();
  const undo = page.getByRole("button", { name: "Undo: excluded specimen-03" });
  await undo.waitFor();
  await inspect("kept-undo");
  const excluded = await readFile(file, "utf8");
  await undo.click();
  await page.getByText("Undone: excluded specimen-03").waitFor();
  assert.equal(await readFile(file, "utf8"), began);
  await page.getByRole("button", { name: "Redo: excluded specimen-03" }).click();
  await undo.waitFor();
  assert.equal(await readFile(file, "utf8"), excluded);
  // By hand, in an editor.
  const byHand = excluded.replace("slipped", "slipped twice");
  await edit(file, byHand);
  await page.getByText("slipped twice").first().waitFor();
  await undo.click();
  await page.getByText("Not undone:").waitFor();
  assert.match(await page.locator("pre.difference").textContent(), /- .*slipped twice/);
  assert.equal(await readFile(file, "utf8"), byHand);
  await inspect("kept-not-undone");
  await page.getByRole("button", { name: "Close", exact: true }).click();
});

test("what was read earlier and answered later replaces nothing", async () => {
  await visit(page, "#/c/apples/impact/specimen-03");
  await title("Impact specimen-03");
  await page.getByText("slipped twice").first().waitFor();
  const file = join(apples, "impacts.csv");
  const began = await readFile(file, "utf8");
  let held;
  let release;
  const waits = new Promise((resolve) => (release = resolve));
  const asked = new Promise((resolve) => (held = resolve));
  const address = "**/api/campaigns/apples/results?*";
  await page.route(
    address,
    async (route) => {
      const response = await route.fetch();
      held();
      await waits;
      await route.fulfill({ response });
    },
    { times: 1 },
  );
  await edit(file, began.replace("slipped twice", "slipped thrice"));
  await asked;
  await edit(file, began.replace("slipped twice", "slipped again"));
  await page.getByText("slipped again").first().waitFor();
  const late = page.waitForEvent("requestfinished", (request) => request.url().includes("/apples/results?"));
  release();
  await late;
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  assert.equal(await page.getByText("slipped thrice").count(), 0);
  await edit(file, began);
  await page.getByText("slipped twice").first().waitFor();
});

test("notes on an impact and on the campaign are in its files, and commands show them", async () => {
  await visit(page, "#/c/apples/impact/specimen-01");
  await title("Impact specimen-01");
  await page.getByLabel("Note on this impact").fill("bruised before");
  await page.getByRole("button", { name: "Save note" }).click();
  await page.getByText("The note was saved into impacts.csv").waitFor();
  await visit(page, "#/c/apples/overview");
  await page.getByLabel("Note on the campaign").fill("Picked wet.\nBench moved on the second day.");
  await page.getByRole("button", { name: "Save note" }).click();
  await page.getByText("The note was saved into campaign.toml").waitFor();
  await page.getByRole("definition").getByText("bruised before").waitFor();
  await inspect("kept-notes");
  assert.match(await readFile(join(apples, "impacts.csv"), "utf8"), /specimen-01,.*bruised before/);
  const text = await windfall("fit", apples);
  assert.match(text, /Note: Picked wet\. Bench moved/);
  assert.match(text, /1 (impact )?.*left out|left out/i);
  const told = JSON.parse(await windfall("fit", apples, "--format", "json"));
  assert.equal(told.note, "Picked wet.\nBench moved on the second day.");
  const out = told.impacts.filter((impact) => (impact.left_out ?? []).length > 0);
  assert.deepEqual(out.map((impact) => impact.id), ["specimen-03"]);
  await windfall("report", apples, "--quiet");
  const report = await readFile(join(apples, "report/report.html"), "utf8");
  for (const words of ["Picked wet.", "specimen-01: bruised before", "specimen-03: slipped twice"]) {
    assert.ok(report.includes(words), words);
  }
  await visit(page, "#/c/apples/table");
  await page.getByRole("grid").getByText("bruised before").waitFor();
});

test("a comparison of laws is opened again, and is stale after a change", async () => {
  await visit(page, "#/c/apples/laws");
  await title("Which law fits best");
  for (const law of ["hertz", "kuwabara-kono"]) await page.getByRole("checkbox", { name: law, exact: true }).check();
  await page.getByRole("button", { name: "Compare" }).click();
  const ranking = page.getByRole("region", { name: "Ranking of laws" });
  await ranking.waitFor({ timeout: 120_000 });
  const words = await ranking.textContent();
  await page.getByText("kept in results.sqlite").first().waitFor();
  await inspect("kept-laws");
  // Another browser on a server that was started anew.
  await server.stop();
  server = await serve(place.directory);
  const other = await open(browser, server, { hash: "#/c/apples/laws" });
  const again = other.page.getByRole("region", { name: "Ranking of laws" });
  await again.waitFor();
  assert.equal(await again.textContent(), words);
  assert.equal(await other.page.getByText("Stale:").count(), 0);
  const file = join(apples, "impacts.csv");
  await edit(file, (await readFile(file, "utf8")).replace("slipped twice", "slipped"));
  await other.page.getByText("Stale:").first().waitFor();
  await pictures(other.page, "kept-stale");
  assert.equal(await again.textContent(), words);
  assert.deepEqual(other.troubles, []);
  await other.context.close();
});

test("comparisons and populations that a command calculated are opened, too", async () => {
  const other = await open(browser, server, { hash: "#/c/apples/laws" });
  await other.page.getByText("Stale:").first().waitFor();
  await windfall("laws", apples, "--law", "flores", "--law", "kuwabara-kono", "--quiet");
  const ranking = other.page.getByRole("region", { name: "Ranking of laws" });
  await ranking.getByText("flores").first().waitFor();
  await windfall("population", apples, "--quiet");
  await other.page.getByRole("region", { name: "Parameters of the population" }).waitFor();
  assert.equal(await other.page.getByText("Stale:").count(), 0);
  assert.deepEqual(other.troubles, []);
  await other.context.close();
});

test("results of a command appear, and what one is doing stays", async () => {
  await pendulum(place.directory, "pears", 12);
  const other = await open(browser, server, { hash: "#/c/pears/table" });
  await other.page.getByText("Nothing is fitted yet").waitFor();
  const pears = join(place.directory, "pears");
  const table = await readFile(join(pears, "impacts.csv"), "utf8");
  const [header, ...rows] = table.trim().split("\n");
  await edit(join(pears, "impacts.csv"), `${[header, ...rows.slice(2)].join("\n")}\n`);
  await windfall("fit", pears, "--quiet");
  const grid = other.page.getByRole("grid");
  await grid.getByText("specimen-03").first().waitFor();
  const search = other.page.getByRole("searchbox", { name: "Words in a row" });
  await search.fill("specimen");
  await other.page.getByRole("checkbox", { name: "Select specimen-05" }).check();
  await other.page.waitForFunction(() => location.hash.includes("rows=specimen-05"));
  await search.focus();
  // Two recordings more, before those that were there.
  await edit(join(pears, "impacts.csv"), table);
  await windfall("fit", pears, "--quiet");
  await grid.getByText("specimen-01").first().waitFor();
  assert.equal(await search.inputValue(), "specimen");
  assert.ok(await search.evaluate((own) => own === document.activeElement));
  const selected = other.page.locator('tr[aria-selected="true"]');
  assert.equal(await selected.count(), 1);
  assert.match(await selected.textContent(), /specimen-05/);
  assert.deepEqual(other.troubles, []);
  await other.context.close();
});

test("nothing went wrong on the way", () => {
  assert.deepEqual(view.troubles, []);
});
