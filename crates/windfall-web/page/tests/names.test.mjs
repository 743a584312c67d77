/** Hostile names: of campaigns, impacts, specimens and groups. On every view they are words,
 *  and nothing in them runs. NAMES: how many, 100 by default. */

import assert from "node:assert/strict";
import { writeFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { end, launch, open, pendulum, scratch, serve, visit, windfall } from "./helpers.mjs";

const HIT = "document.documentElement.id='HIT'";
const PIECES = [
  "<", ">", "&", '"', "'", "`", "<b>", "</td>", "</script>", "</style>", "</textarea>", "<!--", "-->", "]]>", "<![CDATA[",
  `<script>${HIT}</script>`, `<svg onload="${HIT}">`, `<img src=x onerror="${HIT}">`, `" autofocus onfocus="${HIT}`,
  `' onmouseover='${HIT}`, `javascript:${HIT}`, "{@html x}", "{x}", "${x}", "{{x}}", "&lt;b&gt;", "&amp;lt;", "&#10;", "%3Cb%3E", "%",
  "\\u003cb>", "\\", "#", "#/c/x", "?", "/", "..", "\u202e", "\u200b", "\ufeff", "\u2028", "=1+1", "🍏", "é", "x".repeat(300),
];

/** Numbers from 0 to 1 that are the same each time. */
function random(seed) {
  return () => {
    seed = (seed * 1664525 + 1013904223) % 2 ** 32;
    return seed / 2 ** 32;
  };
}

function namesOf(count) {
  const next = random(1);
  const names = new Set();
  while (names.size < count) {
    let name = ["apple", "wall", "1"][Math.floor(next() * 3)];
    for (let pieces = 1 + Math.floor(next() * 3); pieces > 0; pieces--) {
      const letters = [...name];
      letters.splice(Math.floor(next() * (letters.length + 1)), 0, PIECES[Math.floor(next() * PIECES.length)]);
      name = letters.join("");
    }
    // An apostrophe before a formula would mark a text.
    if (!name.startsWith("'")) names.add(name.trim());
  }
  return [...names];
}

const names = namesOf(Number(process.env.NAMES ?? 100));
const cell = (text) => `"${text.replaceAll('"', '""')}"`;
/** Words as a page shows them. */
const seen = (text) => text.replace(/\s+/g, " ").trim();

let place;
let server;
let browser;
let view;
let page;

before(async () => {
  place = await scratch();
  const directory = await pendulum(place.directory, "names", 1);
  const rows = names.map((name) => `${cell(name)},${cell(name)},specimen-01.csv`);
  await writeFile(join(directory, "impacts.csv"), `id,specimen,file\n${rows.join("\n")}\n`);
  const specimens = names.map((name) => `${cell(name)},${cell(`group ${name}`)}`);
  await writeFile(join(directory, "specimens.csv"), `id,variety\n${specimens.join("\n")}\n`);
  await windfall("fit", directory);
  server = await serve(place.directory);
  browser = await launch();
  view = await open(browser, server, { hash: "#/c/names/table" });
  page = view.page;
});

after(() => end({ browser, server, place }));

/** What is on the page that windfall did not put there, and the words of its elements. */
async function look() {
  const found = await page.evaluate(() => ({
    hit: document.documentElement.id,
    foreign: [...document.querySelectorAll("body *")]
      .filter((own) => ["SCRIPT", "IMG", "B", "IFRAME", "OBJECT", "EMBED", "STYLE"].includes(own.tagName) ||
        [...own.attributes].some(({ name, value }) => name.startsWith("on") || (/href|src|action/.test(name) && /^\s*javascript:/i.test(value))))
      .map((own) => own.outerHTML.slice(0, 200)),
    words: [...document.querySelectorAll("body *")].map((own) => own.textContent),
  }));
  assert.notEqual(found.hit, "HIT");
  assert.deepEqual(found.foreign, []);
  return new Set(found.words.map(seen));
}

test("the table shows every name as words", async () => {
  await page.setViewportSize({ width: 1440, height: 2000 });
  await page.getByRole("grid").waitFor();
  const words = new Set();
  const scroller = await page.getByRole("grid").evaluateHandle((own) => {
    for (let at = own; at; at = at.parentElement) if (at.scrollHeight > at.clientHeight + 40) return at;
    return own;
  });
  for (let top = 0; top < 30 * names.length + 2000; top += 600) {
    await scroller.evaluate((own, to) => own.scrollTo(0, to), top);
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    for (const word of await look()) words.add(word);
  }
  assert.deepEqual(names.filter((name) => !words.has(seen(name))), []);
});

test("views of single impacts and the overview run no name", async () => {
  for (const name of names.slice(0, 12)) {
    await visit(page, `#/c/names/impact/${encodeURIComponent(name)}`);
    await page.getByRole("heading", { level: 1 }).first().waitFor();
    await page.waitForTimeout(100);
    await look();
  }
  for (const hash of ["#/c/names", "#/c/names/recordings", "#/"]) {
    await visit(page, hash);
    await page.waitForTimeout(400);
    await look();
  }
  assert.deepEqual(view.troubles, []);
});
