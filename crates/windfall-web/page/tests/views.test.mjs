/** What is done with results: table, laws, regression, surface, calibration, report. */

import assert from "node:assert/strict";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { accessible, end, fits, launch, open, pictures, scratch, serve, visit, windfall } from "./helpers.mjs";

let place;
let server;
let browser;
let view;
let page;

before(async () => {
  place = await scratch();
  const apples = await campaign();
  await mkdir(join(apples, "tables"));
  await writeFile(join(apples, "tables", "runs.csv"), await designed());
  await windfall(
    ...["simulate", "drop", join(place.directory, "drops")],
    ...["--law", 'adams-impact(k="0.868 N/mm^1.91", e=1.91, c="5.56e-4 N s/mm", d="0.001 mm")'],
    ...["--mass", "4.8 g", "--height", "100 mm", "--height", "500 mm", "--drops", "2"],
    ...["--plate-mass", "0.2 kg", "--plate-stiffness", "645.8 N/mm", "--plate-damping", "0.05247 N s/mm"],
  );
  server = await serve(place.directory);
  browser = await launch();
  // Requests that are wrong on purpose are told by the browser as well.
  const expected = (words) => /status of (400|422).*\/(regress|surface)/.test(words);
  view = await open(browser, server, { hash: "#/c/apples/table", expected });
  page = view.page;
});

after(() => end({ browser, server, place }));

/** Twelve apples, struck twice each. */
async function campaign() {
  const directory = join(place.directory, "apples");
  await windfall(
    ...["simulate", "pendulum", "--law", "kuwabara-kono(k=753599, c=1524)"],
    ...["--recordings", directory, "--specimens", "12", "--repeats", "2"],
    ...["--spread", "k=133165", "--spread", "c=263", "--seed", "7"],
  );
  return directory;
}

/** A design with two responses: planes and a square, of which the settings with
 *  force 12 and interval 300 are a line, c = 2 e there. */
async function designed() {
  const text = await windfall(
    ...["design", "ccd", "--factor", "k=-1..1", "--factor", "e=-1..1", "--factor", "c=-1..1"],
    ...["--centre", "4", "--format", "csv"],
  );
  const lines = text.trim().split("\n");
  const start = lines.findIndex((line) => !line.startsWith("#"));
  const header = lines[start].split(",");
  const rows = lines.slice(start + 1).map((line, place) => {
    const [k, e, c] = ["k", "e", "c"].map((name) => Number(line.split(",")[header.indexOf(name)]));
    // The same small noise in every run.
    const noise = 0.01 * Math.sin(12.9898 * (place + 1));
    return `${line},${12 + k + 2 * e - c + noise},${300 - 20 * k + 5 * k * k + 3 * noise}`;
  });
  return [...lines.slice(0, start), `${lines[start]},force_N,interval_ms`, ...rows].join("\n") + "\n";
}

async function inspect(name) {
  await accessible(page, name);
  await fits(page, name);
  await pictures(page, name);
  const words = await page.evaluate(() => document.body.innerText);
  for (const wrong of ["NaN", "undefined", "[object", "Infinity"]) {
    assert.ok(!words.includes(wrong), `${name} shows ${wrong}`);
  }
}

/** The first number of a text as people read it: "−1 234.5 ± 2", "2.0·10⁻⁵". */
function numberIn(words) {
  const plain = words.split("±")[0].replace(/[\s(]/g, "").replaceAll("−", "-");
  const [, mantissa, power] = /^(-?[\d.]+)(?:·10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+))?/.exec(plain) ?? [];
  const digits = [...(power ?? "⁰")].map((each) => (each === "⁻" ? "-" : "⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(each)));
  return Number(mantissa) * 10 ** Number(digits.join(""));
}

const title = (words) => page.getByRole("heading", { level: 1, name: words }).waitFor();
const button = (name, options) => page.getByRole("button", { name, ...options });
const grid = () => page.getByRole("grid");
const chosenRows = () => page.locator('tr[aria-selected="true"]').count();
const chosenPoints = async () =>
  (await page.locator(".brush .chosen").evaluateAll((paths) => paths.map((path) => path.getAttribute("d") ?? "")))
    .join("")
    .split("M").length - 1;

test("a table without results says what to do, and fitting fills it", async () => {
  await title("Table of results");
  await page.getByText("Nothing is fitted yet").waitFor();
  await inspect("table-empty");
  await button("Fit now").click();
  await grid().waitFor({ timeout: 60_000 });
  assert.equal(await grid().getAttribute("aria-rowcount"), "25");
});

test("rows are sorted by a column, and filtered by words and ranges", async () => {
  const values = async () =>
    (await page.locator("tbody tr[aria-rowindex] td:nth-child(3)").allInnerTexts()).map((words) =>
      numberIn(words),
    );
  await grid().getByRole("button", { name: /^k/ }).click();
  const up = await values();
  assert.equal(up.length, 24);
  assert.deepEqual(up, [...up].sort((a, b) => a - b));
  await grid().getByRole("button", { name: /^k/ }).click();
  assert.deepEqual(await values(), [...up].reverse());
  await page.getByRole("searchbox").fill("03-0");
  await page.getByText("2 of 24 rows").waitFor();
  await page.getByRole("searchbox").fill("");
  await page.getByLabel("Add a range of").selectOption({ label: "k" });
  await page.getByLabel("Lowest k").fill(String((up[11] + up[12]) / 2));
  await page.getByText("12 of 24 rows").waitFor();
  await button("Clear filters").click();
  await page.getByText("24 of 24 rows").waitFor();
});

test("points and rows are selected together, by pointer and by keys", async () => {
  const area = page.locator(".brush");
  await area.scrollIntoViewIfNeeded();
  const box = await area.boundingBox();
  await page.mouse.move(box.x + 75, box.y + 12);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height - 60, { steps: 5 });
  await page.mouse.up();
  const some = await chosenRows();
  assert.ok(some > 0 && some < 24, `${some} rows`);
  assert.equal(await chosenPoints(), some);
  await page.getByText(`· ${some} selected`).waitFor();
  await page.getByRole("columnheader", { name: `Selected (${some})` }).waitFor();

  // From the row that the keyboard is at, two more.
  await grid().focus();
  await page.keyboard.press("Escape");
  await page.keyboard.press("Home");
  await page.keyboard.press("Shift+ArrowDown");
  await page.keyboard.press("Shift+ArrowDown");
  assert.equal(await chosenRows(), 3);
  assert.equal(await chosenPoints(), 3);
  await inspect("table");

  // From point to point in the scatter.
  await area.focus();
  await page.keyboard.press("Escape");
  assert.equal(await chosenRows(), 0);
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Shift+ArrowRight");
  assert.equal(await chosenRows(), 2);
});

test("the shown rows are saved as CSV, with uncertainties and units", async () => {
  await page.getByRole("searchbox").fill("02-02");
  const [download] = await Promise.all([page.waitForEvent("download"), button("Download CSV").click()]);
  const lines = (await readFile(await download.path(), "utf8")).trim().split("\r\n");
  assert.equal(lines.length, 2);
  const header = lines[0].split(",");
  for (const name of ["id", "k (N/m^1.5)", "k sd", "k low", "k high", "contact_duration (s)"]) {
    assert.ok(header.includes(name), `${name} in ${lines[0]}`);
  }
  await page.getByRole("searchbox").fill("");
});

test("Enter opens the impact of a row", async () => {
  await grid().focus();
  await page.keyboard.press("Home");
  await page.keyboard.press("Enter");
  await page.waitForURL(/#\/c\/apples\/impact\/./);
});

test("a comparison that is cancelled leaves nothing, and can be made again", async () => {
  await visit(page, "#/c/apples/laws");
  await title("Which law");
  await button("Compare").click();
  await page.locator("main").getByRole("button", { name: "Cancel" }).click();
  await page.getByText("Cancelled").first().waitFor();
  assert.equal(await page.getByRole("region", { name: "Ranking of laws" }).count(), 0);
  await button("Compare").waitFor();
});

test("laws are compared, and the population estimated", async () => {
  for (const law of ["hertz", "kuwabara-kono"]) await page.getByRole("checkbox", { name: law, exact: true }).check();
  await button("Compare").click();
  await page.getByRole("heading", { level: 2, name: "kuwabara-kono Sure" }).waitFor({ timeout: 60_000 });
  const first = page.getByRole("region", { name: "Ranking of laws" }).locator("tbody tr").first();
  assert.match(await first.innerText(), /1\. kuwabara-kono\s+0\s+0\s/);
  assert.match(await page.getByRole("region", { name: "The same on the command line" }).innerText(), /^windfall laws /);

  await button("Estimate the population").click();
  const medians = page.getByRole("region", { name: "Parameters of the population" });
  await medians.waitFor({ timeout: 60_000 });
  // Put in: k 753599 with a spread of 18 %, c 1524 with one of 17 %.
  const row = await medians.locator("tbody tr").first().innerText();
  const median = numberIn(row.split("\t")[1]);
  assert.ok(Math.abs(median / 753599 - 1) < 0.25, row);
  await inspect("laws");
});

test("a law alone cannot be compared, and is not asked for", async () => {
  await page.getByRole("checkbox", { name: "hertz", exact: true }).uncheck();
  await page.getByText("A single law cannot be compared").waitFor();
  assert.ok(await button("Compare").isDisabled());
});

test("a regression is refitted as terms are toggled or written", async () => {
  await visit(page, "#/c/apples/regress");
  await title("Regression");
  await page.getByLabel("Table for the regression").selectOption("tables/runs.csv");
  await page.getByRole("combobox", { name: "Response", exact: true }).selectOption("force_N");
  for (const name of ["k", "e", "c"]) await page.getByRole("group", { name: "Columns" }).getByRole("button", { name, exact: true }).click();
  const coefficients = page.getByRole("region", { name: "Coefficients" }).locator("table");
  const of = async (term) => {
    const row = coefficients.getByRole("row", { name: new RegExp(`^${term.replace(/[()^]/g, "\\$&")}\\s`) });
    return numberIn(await row.locator("td").first().innerText());
  };
  await coefficients.getByRole("row", { name: /^c\s/ }).waitFor();
  for (const [term, truth] of [["(Intercept)", 12], ["k", 1], ["e", 2], ["c", -1]]) {
    assert.ok(Math.abs((await of(term)) - truth) < 0.02, `${term}: ${await of(term)}`);
  }
  await page.getByRole("group", { name: "Interactions" }).getByRole("button", { name: "k × e" }).click();
  await coefficients.getByRole("row", { name: /^k:e\s/ }).waitFor();
  const formula = page.getByRole("textbox", { name: /^Formula/ });
  assert.equal(await formula.inputValue(), "k + e + c + k:e");
  await inspect("regress");

  // Written by hand: chips follow. A wrong name is told beside it, and nothing is lost.
  await formula.fill("k*e + c");
  await formula.press("Enter");
  assert.equal(
    await page.getByRole("group", { name: "Interactions" }).getByRole("button", { name: "k × e" }).getAttribute("aria-pressed"),
    "true",
  );
  await formula.fill("k + nothing");
  await formula.press("Enter");
  await page.locator("main").getByRole("alert").filter({ hasText: "nothing" }).waitFor();
  assert.ok(await coefficients.isVisible());
  await formula.fill("k");
  await formula.press("Enter");
  await page.locator("main").getByRole("alert").waitFor({ state: "detached" });
});

test("impacts on one specimen are not independent: a random effect", async () => {
  const table = page.getByLabel("Table for the regression");
  // While a table is being read nothing of the one before can be chosen, only to be lost.
  const response = page.getByRole("combobox", { name: "Response", exact: true });
  await page.route(/results\.csv/, async (route) => {
    await new Promise((done) => setTimeout(done, 300));
    await route.continue();
  });
  await table.selectOption("tables/results.csv");
  assert.equal(await response.count(), 0);
  await response.waitFor();
  await page.unroute(/results\.csv/);
  await response.selectOption("c");
  await page.getByRole("textbox", { name: /^Formula/ }).fill("k");
  await page.getByRole("textbox", { name: /^Formula/ }).press("Enter");
  await page.getByRole("region", { name: "Analysis of variance" }).waitFor();
  await page.getByRole("group", { name: "Main effects" }).getByRole("button", { name: "✓ k", exact: true }).waitFor();
  await page.getByLabel(/^Varies between/).selectOption("specimen");
  await page.getByRole("table", { name: /^Variation/ }).getByRole("row", { name: /^specimen/ }).waitFor();
  await page.getByRole("heading", { name: /^Effects of the groups/ }).waitFor();
  await inspect("regress-mixed");
});

test("surfaces: the optimum is a line, and sliders turn through it", async () => {
  await visit(page, "#/c/apples/surface");
  await title("Response surface");
  await page.getByLabel("Table for the surface").selectOption("tables/runs.csv");
  await page.getByRole("group", { name: "Response 1" }).getByLabel("Column").selectOption("force_N");
  await button("Add a response").click();
  for (const [number, target] of [[1, "12"], [2, "300"]]) {
    const own = page.getByRole("group", { name: `Response ${number}` });
    await own.getByLabel("Wanted").selectOption("target");
    await own.getByRole("textbox", { name: "Target" }).fill(target);
    await own.getByRole("textbox", { name: "Target" }).press("Enter");
  }
  // The answer to the second goal, not that to the first alone.
  await page.getByRole("row", { name: /^interval_ms, predicted 300\.0/ }).waitFor();
  await page.getByText("The optimum is one of many.").waitFor();
  const contour = page.getByRole("img", { name: /^Contours of force_N/ });
  await contour.waitFor();
  // Of every member: force 12 + k + 2 e − c = 12 and interval 300, so k = 0 and c = 2 e.
  const members = page.getByRole("region", { name: "Settings as good as the optimum" }).locator("tbody tr");
  assert.ok((await members.count()) > 5);
  for (const text of await members.allInnerTexts()) {
    const [k, e, c] = text.split("\t").slice(0, 3).map(numberIn);
    assert.ok(Math.abs(k) < 0.05 && Math.abs(c - 2 * e) < 0.05, text);
  }

  // A slider off the picture moves the bands; the others move the mark alone.
  const bands = () => page.locator(".bands").first().innerHTML();
  const before = await bands();
  const slider = page.getByRole("slider", { name: /^C · c/ });
  await slider.focus();
  for (let i = 0; i < 20; i += 1) await page.keyboard.press("ArrowRight");
  await page.waitForFunction((old) => document.querySelector(".bands").innerHTML !== old, before);
  await page.getByRole("slider", { name: /^Along the family/ }).focus();
  await page.keyboard.press("End");
  await members.last().getByRole("button", { name: /here/ }).waitFor();

  // The surface is turned by keys.
  const picture = () => page.locator(".turning canvas").evaluate((canvas) => canvas.toDataURL());
  const still = await picture();
  await page.locator(".turning").focus();
  await page.keyboard.press("ArrowLeft");
  await page.waitForTimeout(50);
  assert.notEqual(await picture(), still);
  await page.keyboard.press("Home");
  await inspect("surface");
});

test("factors, goals and sliders of a surface are in the address, and come back", async () => {
  const sliders = () => page.locator(".sliders input").evaluateAll((all) => all.map((own) => own.value));
  await page.waitForTimeout(400);
  const [before, hash] = [await sliders(), await page.evaluate(() => location.hash)];
  const held = Object.fromEntries(new URLSearchParams(hash.split("?")[1]));
  assert.equal(held.table, "tables/runs.csv");
  assert.match(held.responses, /^force_N~.*~target~12~~;interval_ms~.*~target~300~~$/);
  await page.reload();
  await page.getByText("The optimum is one of many.").waitFor();
  await page.getByRole("img", { name: /^Contours of force_N/ }).waitFor();
  await page.waitForTimeout(400);
  assert.deepEqual(await sliders(), before);
  assert.equal(await page.evaluate(() => location.hash), hash);
});

test("a goal that cannot be is told beside it", async () => {
  const own = page.getByRole("group", { name: "Response 1" });
  await own.getByRole("textbox", { name: "Target" }).fill("1e9");
  await own.getByRole("textbox", { name: "Target" }).press("Enter");
  await page.locator("main").getByRole("alert").filter({ hasText: "target" }).waitFor();
});

test("the overview of a campaign of another kind shows its values by group", async () => {
  const printed = await windfall("fit", join(place.directory, "drops"));
  await visit(page, "#/c/drops/overview");
  const groups = page.getByRole("region", { name: /^drop: mean ± SD/ });
  await groups.getByRole("columnheader", { name: "restitution" }).waitFor();
  for (const group of ["100 mm", "500 mm", "all"]) await groups.getByRole("rowheader", { name: group }).waitFor();
  // They are the numbers of the command.
  const cells = await groups.getByRole("cell").allInnerTexts();
  assert.ok(cells.length >= 3 * 7, cells.join(", "));
  for (const cell of cells.filter((each) => each !== "–")) assert.ok(printed.includes(cell), `${cell} is not in ${printed}`);
});

test("drops are calibrated, and the law leaves as a card", async () => {
  await visit(page, "#/c/drops/calibrate");
  await title("Calibration");
  await page.getByText("Nothing is calibrated yet").waitFor();
  await button("Calibrate", { exact: true }).click();
  const ways = page.getByRole("region", { name: "Parameters by method" });
  await ways.waitFor({ timeout: 120_000 });
  // Put in: k 0.868 N/mm^1.91, e 1.91.
  const cell = async (row) => numberIn(await ways.locator("tbody tr").nth(row).locator("td").first().innerText());
  assert.ok(Math.abs((await cell(0)) / 0.868 - 1) < 0.05);
  assert.ok(Math.abs((await cell(1)) / 1.91 - 1) < 0.02);
  await page.getByRole("heading", { name: "Laws that the features cannot tell apart" }).waitFor();
  await page.getByRole("heading", { name: "Which drops to make next" }).waitFor();
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    page.getByRole("link", { name: "Download the law card" }).click(),
  ]);
  assert.match(await readFile(await download.path(), "utf8"), /adams-impact/);
  await inspect("calibrate");
});

test("results of long work are still there after a look elsewhere", async () => {
  await visit(page, "#/c/drops/table");
  await title("Table of results");
  await visit(page, "#/c/drops/calibrate");
  await page.getByRole("region", { name: "Parameters by method" }).waitFor();
  // The member of the family that was looked at is in the address.
  const along = page.getByRole("slider", { name: "Along the family" });
  await along.fill("3");
  await page.waitForFunction(() => location.hash.includes("member=4"));
  await page.reload();
  await along.waitFor();
  assert.equal(await along.inputValue(), "3");
});

test("the report is written and shown where nothing can run", async () => {
  await visit(page, "#/c/apples/report");
  await title("Report");
  await page.getByText("There is no report yet").waitFor();
  await button("Write the report").click();
  const frame = page.locator("iframe");
  await frame.waitFor({ timeout: 120_000 });
  assert.equal(await frame.getAttribute("sandbox"), "");
  const inside = frame.contentFrame();
  await inside.getByRole("heading", { level: 1 }).first().waitFor();
  await inspect("report");
});

test("the table of results follows what a command has fitted", async () => {
  const own = join(place.directory, "apples", "tables", "results.csv");
  const settings = join(place.directory, "apples", "campaign.toml");
  const text = await readFile(settings, "utf8");
  await writeFile(settings, text.replace(/^laws = .*$/m, 'laws = ["tsuji"]'));
  await windfall("fit", join(place.directory, "apples"));
  assert.ok(!(await readFile(own, "utf8")).includes(",tsuji,"));
  await visit(page, "#/c/apples/regress");
  await title("Regression");
  for (let tries = 0; !(await readFile(own, "utf8")).includes(",tsuji,"); tries++) {
    assert.ok(tries < 100, "the table is of the other law still");
    await page.waitForTimeout(100);
  }
});

test("nothing went wrong on the way", () => {
  assert.deepEqual(view.troubles, []);
});
