/** Every kind of campaign in every state: every view, at two sizes, in both colours. */

import assert from "node:assert/strict";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { KINDS, STATES, everyCampaign } from "./campaigns.mjs";
import { accessible, end, launch, NARROW, open, scratch, serve, visit, WIDE } from "./helpers.mjs";

let place;
let server;
let browser;
let view;
let page;
/** Views opened, looks at them, and runs of axe. */
const counted = { opened: 0, looked: 0, axe: 0 };

before(async () => {
  place = await scratch();
  await everyCampaign(place.directory);
  server = await serve(place.directory);
  browser = await launch("--js-flags=--expose-gc");
  // Recordings that are missing or damaged are told by the browser as well.
  const expected = (words) => /status of (404|422).*\/(refit|recording|outline)/.test(words);
  view = await open(browser, server, { expected });
  page = view.page;
});

after(() => end({ browser, server, place }));

/** Views of a kind. */
const viewsOf = (kind) => [
  "overview",
  "recordings",
  kind === "impacts" ? "impact" : "item",
  "table",
  ...(kind === "impacts" ? ["laws"] : []),
  "regress",
  "surface",
  ...(kind === "drop" ? ["calibrate"] : []),
  "report",
];

/** Waits until nothing is being read or fitted any more. */
async function settled(where) {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  await page
    .waitForFunction(
      () => {
        const main = document.querySelector("main");
        return main.querySelector("h1, .note") !== null && !/(Reading|Fitting|Opening|Making) .*…/.test(main.innerText);
      },
      null,
      { timeout: 20000, polling: 30 },
    )
    .catch(async () => {
      const words = await page.evaluate(() => document.querySelector("main").innerText);
      assert.fail(`${where} is still being read: ${words.slice(0, 400)}`);
    });
}

/** What is wrong with the layout and the words of what is shown. */
const wrongs = () =>
  page.evaluate(() => {
    const found = [];
    const root = document.documentElement;
    if (root.scrollWidth > root.clientWidth) found.push(`${root.scrollWidth - root.clientWidth} px too wide`);
    for (const table of document.querySelectorAll("main table")) {
      const name = table.caption?.innerText ?? table.getAttribute("aria-label") ?? table.innerText.slice(0, 30);
      if (table.getClientRects().length === 0) continue;
      let scroller = table.parentElement;
      while (scroller && !/auto|scroll/.test(getComputedStyle(scroller).overflowX)) scroller = scroller.parentElement;
      const last = [...(table.rows[0]?.cells ?? [])].at(-1);
      if (!last) continue;
      const before = scroller?.scrollLeft ?? 0;
      if (scroller) scroller.scrollLeft = 1e6;
      const edge = scroller ? scroller.getBoundingClientRect().right : root.clientWidth;
      const over = last.getBoundingClientRect().right - Math.min(edge, root.clientWidth);
      if (over > 1) found.push(`the last column of "${name}" lies ${Math.round(over)} px out of reach`);
      if (scroller && scroller.scrollWidth > scroller.clientWidth + 1 && !scroller.matches("[tabindex]") && !scroller.querySelector("[tabindex], a, button, input"))
        found.push(`"${name}" cannot be scrolled by keys`);
      if (scroller) scroller.scrollLeft = before;
    }
    const words = document.body.innerText;
    for (const bad of ["NaN", "undefined", "[object", "Infinity", "cannot be shown"]) {
      if (words.includes(bad)) found.push(`shows ${bad}: ${words.slice(Math.max(words.indexOf(bad) - 60, 0), words.indexOf(bad) + 80)}`);
    }
    return found;
  });

/** Looks at what is shown in both colours and sizes; what is wrong. */
async function look(where, axe) {
  const found = [];
  for (const colorScheme of ["light", "dark"]) {
    await page.emulateMedia({ colorScheme });
    // Each change of the window once.
    for (const viewport of colorScheme === "light" ? [WIDE, NARROW] : [NARROW, WIDE]) {
      await page.setViewportSize(viewport);
      await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
      found.push(...(await wrongs()).map((wrong) => `${colorScheme}, ${viewport.width} px: ${wrong}`));
      counted.looked += 1;
      if (process.env.SCREENSHOTS) {
        await mkdir(process.env.SCREENSHOTS, { recursive: true });
        const name = `${where.replaceAll("/", "-")}-${viewport.width}-${colorScheme}.png`;
        await page.screenshot({ path: join(process.env.SCREENSHOTS, name), fullPage: true });
      }
      if (!axe || viewport !== WIDE) continue;
      await accessible(page, colorScheme).catch((error) => found.push(error.message));
      counted.axe += 1;
    }
  }
  return [...found, ...view.troubles.splice(0)].map((wrong) => `${where}: ${wrong}`);
}

/** Fits a campaign by the button of its overview. */
async function fitInPage(id) {
  await visit(page, `#/c/${id}/overview`);
  await settled(id);
  await page.getByRole("button", { name: "Fit", exact: true }).click();
  await page.getByText("Everything is fitted.").waitFor({ timeout: 60000 });
  await page.getByRole("button", { name: "Close this message" }).first().click();
}

for (const kind of Object.keys(KINDS)) {
  test(`every view of ${kind} in every state`, async (t) => {
    const wrong = [];
    for (const state of STATES) {
      const id = `${kind}-${state}`;
      if (state === "page") await fitInPage(id);
      for (const part of viewsOf(kind)) {
        const where = `${id}/${part}`;
        await visit(page, `#/c/${where}`);
        await settled(where);
        counted.opened += 1;
        // What axe sees hardly depends on the state: once full of results is enough.
        wrong.push(...(await look(where, state === "command")));
      }
    }
    assert.deepEqual(wrong, []);
    t.diagnostic(`so far ${counted.opened} views, ${counted.looked} looks, ${counted.axe} runs of axe`);
  });
}

/** Memory of the page after its rubbish was taken away, bytes, and canvases alive, also
 *  those that are no longer shown. */
async function weight(client) {
  await client.send("HeapProfiler.collectGarbage");
  const { result } = await client.send("Runtime.evaluate", { expression: "HTMLCanvasElement.prototype" });
  const { objects } = await client.send("Runtime.queryObjects", { prototypeObjectId: result.objectId });
  const length = { functionDeclaration: "function () { return this.length; }", objectId: objects.objectId, returnByValue: true };
  const canvases = (await client.send("Runtime.callFunctionOn", length)).result.value;
  await client.send("Runtime.releaseObject", { objectId: objects.objectId });
  const { usedSize } = await client.send("Runtime.getHeapUsage");
  return { heap: usedSize, canvases };
}

/** The weight once there are no more canvases than that, or after five seconds: what is under
 *  way, such as a fit, holds the view that asked for it until it ends. */
async function rested(client, most) {
  let found = await weight(client);
  for (let look = 0; look < 20 && found.canvases > most; look++) {
    await page.waitForTimeout(250);
    found = await weight(client);
  }
  return found;
}

/** How many are stepped through; WINDFALL_STEPS says another number. */
const STEPS = Number(process.env.WINDFALL_STEPS ?? 40);

for (const [kind, heading] of [["impacts", "Impact"], ["drop", "Drop"]]) {
  test(`stepping through many of ${kind} takes no memory, and leaving frees it`, async (t) => {
    const client = await view.context.newCDPSession(page);
    await visit(page, `#/c/${kind}-many/overview`);
    await settled(kind);
    const before = await weight(client);
    await visit(page, `#/c/${kind}-many/${kind === "impacts" ? "impact" : "item"}/item-001`);
    let tenth;
    for (let at = 1; at <= STEPS; at++) {
      const id = `item-${String(at).padStart(3, "0")}`;
      await page.getByRole("heading", { name: `${heading} ${id}`, exact: true }).waitFor();
      await settled(id);
      // Not by handles on elements, which would keep them.
      await page.locator(kind === "impacts" ? ".plots canvas" : ".drawing svg").first().waitFor();
      if (at === 10) tenth = await weight(client);
      if (at < STEPS) await page.keyboard.press("n");
    }
    const last = await rested(client, tenth.canvases);
    await visit(page, `#/c/${kind}-many/overview`);
    await settled(kind);
    const left = await rested(client, before.canvases + 2);
    const words = ({ heap, canvases }) => `${(heap / 1e6).toFixed(1)} MB and ${canvases} canvases`;
    t.diagnostic(`before ${words(before)}; 10th ${words(tenth)}; ${STEPS}th ${words(last)}; left ${words(left)}`);
    assert.ok(last.canvases <= tenth.canvases, `${tenth.canvases} canvases, then ${last.canvases}`);
    // A megabyte is what measurements and compiled code differ by.
    assert.ok(last.heap < tenth.heap + 1e6, `${tenth.heap} bytes, then ${last.heap}`);
    // The browser keeps one destroyed plot among what it learnt of the code.
    assert.ok(left.canvases <= before.canvases + 2, `${before.canvases} canvases, then ${left.canvases}`);
    assert.ok(left.heap < before.heap + 3e6, `${before.heap} bytes, then ${left.heap}`);
    assert.deepEqual(view.troubles.splice(0), []);
    await client.detach();
  });
}

test("a part that breaks says so, and the rest lives", async () => {
  // An answer that the page does not expect.
  await page.route("**/api/campaigns/drop-command/measured*", (route) =>
    route.fulfill({ json: { tables: [{ caption: "broken", columns: ["a"], rows: [null] }], figures: [], findings: [], failed: [] } }),
  );
  await visit(page, "#/c/drop-command/overview");
  const alert = page.getByRole("alert").filter({ hasText: "The table “broken” cannot be shown" });
  await alert.waitFor();
  await accessible(page, "a broken part");
  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  await alert.getByRole("button", { name: "Copy details" }).click();
  await page.getByText("The details were copied.").waitFor();
  const details = await page.evaluate(() => navigator.clipboard.readText());
  assert.match(details, /TypeError/);
  assert.match(details, /#\/c\/drop-command\/overview/);
  // What is beside it still works, and so does the navigation.
  await page.getByRole("button", { name: "Fit (all is up to date)" }).waitFor();
  await page.unroute("**/api/campaigns/drop-command/measured*");
  await page.getByRole("link", { name: "Table", exact: true }).first().click();
  await page.getByRole("heading", { name: "Table of results" }).waitFor();
  await visit(page, "#/c/drop-command/overview");
  await page.getByText("drop: mean ± SD").first().waitFor();
  // The exception is in the console, for those who look for it.
  const told = view.troubles.splice(0);
  assert.ok(told.length > 0 && told.every((each) => /TypeError/.test(each)), told.join("\n"));
});

test("an answer that fails leaves no \"Reading …\"", async () => {
  const problem = { title: "Broken", status: 500, code: "internal", detail: "the disk is on fire" };
  const refuse = (route) => route.fulfill({ status: 500, contentType: "application/problem+json", json: problem });
  const unexpected = view.troubles.splice(0);
  assert.deepEqual(unexpected, []);
  for (const [pattern, hash] of [
    ["**/measured*", "#/c/drop-command/overview"],
    ["**/measured*", "#/c/drop-command/item"],
    ["**/recordings", "#/c/drop-command/recordings"],
    ["**/recording?*", "#/c/drop-command/recordings/drop-100-2.csv"],
    ["**/recording?*", "#/c/drop-command/import/drop-100-2.csv"],
    ["**/outline?*", "#/c/drop-command/recordings/drop-100-1.csv"],
    ["**/refit", "#/c/impacts-command/impact"],
    ["**/results?*", "#/c/acoustic-command/table"],
    ["**/api/campaigns", "#/"],
  ]) {
    // Another campaign, so that everything is asked anew.
    await visit(page, "#/c/repeats-new/report");
    await settled(hash);
    await page.route(pattern, refuse);
    await visit(page, hash);
    await page.getByText("the disk is on fire").first().waitFor({ timeout: 5000 }).catch(() => assert.fail(`${hash} without ${pattern}`));
    await settled(hash);
    await page.unroute(pattern);
  }
  view.troubles.splice(0);
});

test("a view that a kind does not have says why", async () => {
  for (const [hash, words] of [
    ["#/c/acoustic-command/laws", /Not for campaigns of this kind/],
    ["#/c/acoustic-command/impact", /Not for campaigns of this kind/],
    ["#/c/compression-command/laws", /stand side by side/],
    ["#/c/impacts-command/calibrate", /A calibration needs drops/],
    ["#/c/impacts-command/item", /view of their own/],
  ]) {
    await visit(page, hash);
    await settled(hash);
    assert.match(await page.evaluate(() => document.querySelector("main").innerText), words);
    assert.deepEqual(await wrongs(), []);
  }
  assert.deepEqual(view.troubles.splice(0), []);
});

test("a fit of which nothing comes says why", async () => {
  for (const kind of ["drop", "impacts"]) {
    await visit(page, `#/c/${kind}-new/overview`);
    await settled(kind);
    // The rig of the template is nobody's; one that somebody has edited is theirs.
    const fit = page.getByRole("button", { name: "Fit", exact: true });
    assert.ok(await fit.isDisabled());
    await page.getByText("the rig is still the example").first().waitFor();
    const file = join(place.directory, `${kind}-new`, "campaign.toml");
    const text = await readFile(file, "utf8");
    await writeFile(file, text.replace("[rig]\n", "[rig]\n# As measured on the bench.\n"));
    await fit.click();
    const told = page.getByRole("region", { name: "Messages" }).locator(".note", { hasText: /Fitted; \d+ failures below\./ });
    await told.waitFor();
    const rows = page.getByRole("region", { name: "Failures" }).locator("tbody tr");
    await rows.nth(1).waitFor();
    // That of the next kind is another.
    await told.getByRole("button", { name: "Close this message" }).click();
  }
  assert.deepEqual(view.troubles.splice(0), []);
});

test("results of the command become a table", async () => {
  await visit(page, "#/c/acoustic-command/regress");
  await settled("acoustic");
  // As soon as it is asked for.
  await page.getByLabel("Table for the regression").waitFor();
  await page.waitForFunction(() => location.hash.includes("results.csv"));
  assert.equal(await page.getByLabel("Table for the regression").inputValue(), "tables/results.csv");
  assert.deepEqual(view.troubles.splice(0), []);
});
