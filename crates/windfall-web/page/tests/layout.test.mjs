/** Where things stand: the table has the width, three laws fit, and models begin with the
 *  campaign's own results. */

import assert from "node:assert/strict";
import { readdir } from "node:fs/promises";
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

let place, server, browser, view, page;

before(async () => {
  place = await scratch();
  const directory = await pendulum(place.directory);
  // By the command, not by the page.
  await windfall("fit", directory);
  server = await serve(place.directory);
  browser = await launch();
  view = await open(browser, server);
  page = view.page;
});

after(() => end({ browser, server, place }));

test("regression and surface begin with results that a command fitted", async () => {
  const tables = join(place.directory, "apples/tables");
  await assert.rejects(readdir(tables), "nothing but the store has the results");
  await visit(page, "#/c/apples/regress");
  const regression = page.getByLabel("Table for the regression");
  await regression.waitFor();
  await page.waitForFunction(() => location.hash.includes("results.csv"));
  assert.equal(await regression.inputValue(), "tables/results.csv");
  // A parameter over the velocity, calculated already.
  assert.match(decodeURIComponent(page.url()), /response=k&formula=impact_velocity/);
  await page.getByLabel("Quality", { exact: true }).first().waitFor();
  assert.ok((await regression.locator("option").allInnerTexts()).includes("truth.csv"));
  await regression.selectOption("truth.csv");
  await page.waitForFunction(() => location.hash.includes("truth.csv"));
  await visit(page, "#/c/apples/surface");
  const surface = page.getByLabel("Table for the surface");
  await surface.waitFor();
  await page.waitForFunction((own) => own.value !== "", await surface.elementHandle());
  assert.equal(await surface.inputValue(), "tables/results.csv");
});

test("the table has the width, and the place of the scatter is kept", async () => {
  await visit(page, "#/c/apples/table");
  const width = (name) => page.getByLabel(name, { exact: true }).first().evaluate((own) => own.getBoundingClientRect().width);
  const all = () => page.locator(".view .sides").evaluate((own) => own.getBoundingClientRect().width);
  await page.getByLabel("Place of the scatter").waitFor();
  assert.equal(await width("Rows"), await all());
  await accessible(page, "table");
  await fits(page, "table");
  await pictures(page, "table-below");
  await page.getByLabel("Place of the scatter").selectOption("beside");
  assert.ok((await width("Rows")) < 0.65 * (await all()));
  await pictures(page, "table-beside");
  await page.getByLabel("Place of the scatter").selectOption("folded");
  assert.equal(await page.getByLabel("Across").count(), 0);
  await page.waitForFunction(() => location.hash.includes("scatter=folded"));
  await page.reload();
  await page.getByLabel("Place of the scatter").waitFor();
  assert.equal(await page.getByLabel("Place of the scatter").inputValue(), "folded");
  assert.equal(await page.getByLabel("Across").count(), 0);
  await pictures(page, "table-folded");
});

test("three laws of an impact stand side by side whole", async () => {
  const laws = ["kuwabara-kono", "hunt-crossley", "tsuji"].join(";");
  await visit(page, `#/c/apples/impact?laws=${laws}`);
  const table = page.locator("div[aria-label='Laws side by side']");
  await page.waitForFunction(
    () => document.querySelectorAll("div[aria-label='Laws side by side'] thead th").length === 4,
    undefined,
    { timeout: 60_000 },
  );
  for (const width of [1280, 800]) {
    await page.setViewportSize({ width, height: 900 });
    await page.waitForTimeout(200);
    const [inner, outer] = await table.evaluate((own) => [own.scrollWidth, own.clientWidth]);
    assert.ok(inner <= outer, `${inner} pixels in ${outer} at ${width}`);
    if (process.env.SCREENSHOTS) await table.screenshot({ path: join(process.env.SCREENSHOTS, `laws-${width}.png`) });
  }
  await accessible(page, "impact with three laws");
});

test("nothing went wrong on the way", () => {
  assert.deepEqual(view.troubles, []);
});
