/** Numbers on the page: units of models, and tables that go into a spreadsheet. */

import assert from "node:assert/strict";
import { copyFile, mkdir, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch, open, pendulum, pictures, scratch, serve, visit, windfall } from "./helpers.mjs";

let folder, server, browser, page, troubles, context;

before(async () => {
  folder = await scratch();
  const campaign = await pendulum(folder.directory);
  await windfall("fit", campaign);
  await mkdir(join(campaign, "tables"), { recursive: true });
  const rows = Array.from({ length: 16 }, (_, i) => {
    const [speed, mass] = [0.4 + 0.1 * (i % 4), 150 + 7 * Math.floor(i / 4) + (i % 3)];
    return `${speed.toFixed(1)},${mass},${(40 * speed + 0.2 * mass + Math.sin(17 * i)).toFixed(4)}`;
  });
  await writeFile(join(campaign, "tables/forces.csv"), `speed_m_s,mass_g,force_N\n${rows.join("\n")}\n`);
  server = await serve(folder.directory);
  browser = await launch();
  ({ page, troubles, context } = await open(browser, server));
  await context.grantPermissions(["clipboard-read", "clipboard-write"], { origin: server.origin });
});

after(async () => {
  await browser?.close();
  await server?.stop();
  await folder?.remove();
});

const clipboard = async () => (await page.evaluate(() => navigator.clipboard.readText())).split("\n").map((line) => line.split("\t"));
const isNumber = (cell) => cell !== "" && Number.isFinite(Number(cell));

test("a regression names the units of its coefficients, and its table is copied with all digits", async () => {
  await visit(page, "#/c/apples/regress");
  await page.getByLabel("Table for the regression").selectOption("tables/forces.csv");
  await page.getByRole("combobox", { name: "Response", exact: true }).selectOption("force_N");
  const columns = page.getByRole("group", { name: "Columns" });
  for (const name of ["speed_m_s", "mass_g"]) await columns.getByRole("button", { name, exact: true }).click();
  const table = page.getByRole("region", { name: "Coefficients" });
  await table.getByText("N/(m/s)").first().waitFor();
  await table.getByText("N/g", { exact: true }).first().waitFor();
  await pictures(page, "numbers-regress");
  await table.getByRole("button", { name: "Copy table" }).click();
  await table.getByRole("button", { name: "Copied" }).waitFor();
  const [head, ...rows] = await clipboard();
  assert.deepEqual(head, ["Term", "Estimate", "SE", "95 % from", "to", "Unit", "t", "df", "p"]);
  assert.ok(rows.length >= 2);
  for (const row of rows) {
    assert.equal(row.length, head.length);
    for (const place of [1, 2, 3, 4, 6, 7, 8]) assert.ok(isNumber(row[place]), `${row[place]} of ${row}`);
    // All digits: more than the page shows.
    assert.ok(row[1].length > 8, row[1]);
  }
  assert.deepEqual(troubles, []);
});

test("a table of the results that is made meanwhile moves nothing under the pointer", async () => {
  const campaign = await pendulum(folder.directory, "pears", 2);
  await windfall("fit", campaign);
  await mkdir(join(campaign, "tables"));
  await copyFile(join(folder.directory, "apples/tables/forces.csv"), join(campaign, "tables/forces.csv"));
  let release;
  const held = new Promise((done) => (release = done));
  await page.route("**/api/jobs/*/events", async (route) => {
    await held;
    await route.continue();
  });
  const asked = page.waitForRequest("**/api/jobs/*/events");
  await visit(page, "#/c/pears/regress");
  await page.getByLabel("Table for the regression").selectOption("tables/forces.csv");
  const chip = page.getByRole("group", { name: "Columns" }).getByRole("button", { name: "speed_m_s", exact: true });
  await chip.waitFor();
  await asked;
  const before = await chip.boundingBox();
  release();
  await page.getByLabel("Table for the regression").locator("option", { hasText: "tables/results.csv" }).waitFor({ state: "attached" });
  await page.getByText("Making the table of the results …").waitFor({ state: "detached" });
  assert.deepEqual(await chip.boundingBox(), before);
  await page.unroute("**/api/jobs/*/events");
  assert.deepEqual(troubles, []);
});

test("rows of the table of results are copied with all digits", async () => {
  await visit(page, "#/c/apples/table");
  await page.getByRole("button", { name: "Copy table" }).click();
  await page.waitForTimeout(200);
  const [head, ...rows] = await clipboard();
  assert.equal(rows.length, 6);
  const place = head.indexOf("k (N/m^1.5)");
  assert.ok(place > 0, head.join());
  assert.equal(head[place + 1], "k sd");
  for (const row of rows) {
    assert.equal(row.length, head.length);
    assert.ok(isNumber(row[place]) && isNumber(row[place + 1]) && row[place].length > 8, row.join());
  }
});

test("what is selected in a table and copied is numbers, without thin spaces", async () => {
  await visit(page, "#/c/apples/overview");
  const region = page.locator('div.table[aria-label="Parameters by group"]');
  await region.waitFor();
  assert.match(await region.innerText(), /\d\u202f\d{3}/, "large numbers are shown in groups");
  await region.locator("table").evaluate((table) => getSelection().selectAllChildren(table));
  await page.keyboard.press("Control+c");
  const [head, ...rows] = await clipboard();
  assert.deepEqual(head.slice(-2), ["Mean", "Standard deviation"]);
  assert.ok(rows.length >= 2);
  for (const row of rows) assert.ok(row.slice(-2).every(isNumber), row.join());
  // A single cell keeps its words, with plain numbers.
  await region.locator("td.number").last().evaluate((cell) => getSelection().selectAllChildren(cell));
  await page.keyboard.press("Control+c");
  const [[cell]] = await clipboard();
  assert.match(cell, /^-?[\d.]+ ± [\d.]+/);
  assert.deepEqual(troubles, []);
});
