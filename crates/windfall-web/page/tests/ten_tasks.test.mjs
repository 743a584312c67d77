/**
 * Ten tasks of somebody who sees the page for the first time, with a count of what the hands
 * do: a click, a choice, a field that is filled, a key. None needs a file of text typed by hand.
 */

import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { end, germanRecording, launch, open, pendulum, scratch, serve, visit, windfall } from "./helpers.mjs";
import { KINDS } from "./campaigns.mjs";

const ODD = "specimen-04";

let place;
let server;
let browser;
let view;
let page;
let recording;
/** Tasks and their steps. */
const counted = [];

before(async () => {
  place = await scratch();
  const apples = await pendulum(place.directory, "apples", 8);
  // One recording whose amplifier stood at another gain.
  const raw = join(apples, "raw", `${ODD}.csv`);
  const [head, ...lines] = (await readFile(raw, "utf8")).trimEnd().split("\n");
  const force = head.split(",").findIndex((name) => name.startsWith("force"));
  const doubled = lines.map((line) => line.split(",").map((cell, at) => (at === force ? String(2 * Number(cell)) : cell)).join(","));
  await writeFile(raw, [head, ...doubled, ""].join("\n"));
  await windfall("fit", apples, "--quiet");
  const drops = join(place.directory, "drops");
  await windfall("simulate", ...KINDS.drop.words(drops));
  await windfall("fit", drops, "--quiet");
  const scene = join(place.directory, "chute", "scene.toml");
  await windfall("new", "scene", join(place.directory, "chute"));
  const text = await readFile(scene, "utf8");
  await writeFile(scene, text.replace("count = 100", "count = 20").replace('end = "4 s"', 'end = "2 s"'));
  await windfall("scene", "run", scene);
  recording = Buffer.from(await germanRecording());
  server = await serve(place.directory);
  browser = await launch("--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist");
  view = await open(browser, server, { hash: "#/" });
  page = view.page;
  await view.context.grantPermissions(["clipboard-read", "clipboard-write"]);
});

after(() => end({ browser, server, place }));

const title = (words) => page.getByRole("heading", { level: 1, name: words }).waitFor();
const button = (name, within = page) => within.getByRole("button", { name, exact: true });
const link = (name, within = page) => within.getByRole("link", { name, exact: true });
const part = (name) => page.getByRole("navigation", { name: "Parts of the campaign" }).getByRole("link", { name });

/** A task that takes at most so many steps. */
function task(name, most, work) {
  test(name, async () => {
    const steps = [];
    const hand = (kind, how) => async (locator, ...more) => {
      await locator.first().waitFor();
      assert.notEqual(await locator.evaluate((own) => own.tagName), "TEXTAREA", `${name}: text is typed by hand`);
      steps.push(kind);
      return how(locator, ...more);
    };
    await work({
      click: hand("click", (locator) => locator.click()),
      fill: hand("field", (locator, text) => locator.fill(text)),
      choose: hand("choice", (locator, value) => locator.selectOption(value)),
      give: hand("file", (locator, files) => locator.setInputFiles(files)),
      /** A click, and the file that comes of it. */
      take: hand("click", async (locator) => {
        const [file] = await Promise.all([page.waitForEvent("download"), locator.click()]);
        return file;
      }),
    });
    counted.push([name, steps]);
    assert.ok(steps.length <= most, `${name}: ${steps.length} steps, ${most} before: ${steps.join(", ")}`);
  });
}

task("import a foreign file", 8, async (user) => {
  await title("Campaigns");
  await user.choose(page.getByLabel("Kind"), "pendulum");
  await user.fill(page.getByLabel("Directory name"), "german");
  await user.click(button("Make it"));
  await title(/german|pendulum/i);
  await user.click(part("Recordings"));
  const file = { name: "stoss-1.csv", mimeType: "text/csv", buffer: recording };
  await user.give(page.getByLabel("Files to import"), [file]);
  await user.click(link("Channels and impacts …").first());
  await user.click(button("Write the channels into campaign.toml"));
  await page.getByText("The channels were written").waitFor();
  await user.click(button("Add 1 impact"));
  await title(/^Impact stoss-1/);
});

task("correct the rig", 7, async (user) => {
  await user.click(link("Give the rig"));
  const rig = page.getByRole("region", { name: "The rig" });
  await user.fill(rig.getByLabel(/^Inertia/), "0.01435");
  await user.fill(rig.getByLabel(/^Arm/), "0.505");
  await user.fill(rig.getByLabel(/^Mass/), "0.11");
  await user.fill(rig.getByLabel(/^Centre of mass/), "0.3");
  await user.click(button("Write the rig into campaign.toml", rig));
  await page.getByText("The rig was written").waitFor();
  await user.click(part(/^Impact/));
  await page.getByRole("columnheader", { name: "kuwabara-kono" }).first().waitFor();
});

task("find the odd impact", 2, async (user) => {
  await visit(page, "#/");
  await title("Campaigns");
  await user.click(link("Simulated pendulum campaign"));
  await title("Simulated pendulum campaign");
  const findings = page.getByRole("region", { name: "Findings" });
  await user.click(link(ODD, findings).first());
  await title(`Impact ${ODD}`);
});

task("exclude it with a reason", 2, async (user) => {
  await user.fill(page.getByLabel("Why"), "gain of the amplifier");
  await user.click(button("Leave it out"));
  await page.getByText("is left out from the next fit on").waitFor();
  const impacts = await readFile(join(place.directory, "apples/impacts.csv"), "utf8");
  assert.match(impacts, /specimen-04,.*gain of the amplifier/);
});

task("compare laws", 2, async (user) => {
  await user.click(page.getByRole("checkbox", { name: "hunt-crossley" }));
  await user.click(page.getByRole("checkbox", { name: "hertz", exact: true }));
  const laws = page.getByRole("region", { name: "Laws side by side" });
  for (const name of ["kuwabara-kono", "hunt-crossley", "hertz"]) {
    await laws.getByRole("columnheader", { name, exact: true }).waitFor();
  }
  await laws.getByRole("row", { name: /^ΔAICc/ }).waitFor();
});

task("export the figure for a paper at 84 mm", 1, async (user) => {
  const pdf = await user.take(button("Save figure"));
  assert.equal(pdf.suggestedFilename(), `${ODD}.pdf`);
  const bytes = await readFile(await pdf.path());
  assert.equal(bytes.subarray(0, 5).toString(), "%PDF-");
  // 84 mm in points, as the page of the file says.
  const box = /\/MediaBox\s*\[\s*0 0 ([\d.]+)/.exec(bytes.toString("latin1"));
  assert.ok(Math.abs(Number(box[1]) - (84 * 72) / 25.4) < 0.2, box[0]);
});

task("copy the table", 2, async (user) => {
  await user.click(part("Table"));
  await title("Table of results");
  await user.click(button("Copy table").first());
  await page.getByText("8 rows copied").waitFor();
  const text = await page.evaluate(() => navigator.clipboard.readText());
  const rows = text.replace(/\n$/, "").split("\n").map((line) => line.split("\t"));
  assert.equal(rows.length, 9, text);
  assert.ok(rows.every((row) => row.length === rows[0].length), text);
});

task("see a drop's ringing", 2, async (user) => {
  await visit(page, "#/");
  await user.click(page.getByRole("link", { name: /drop/i }).first());
  await user.click(part("Drop"));
  await page.getByRole("region", { name: "Figure" }).locator("svg").first().waitFor();
});

task("play a scene to the worst blow", 3, async (user) => {
  await visit(page, "#/");
  await user.click(page.getByRole("region", { name: "Scenes" }).getByRole("link").first());
  const hardest = page.getByRole("region", { name: "Fruit that were hit hardest" });
  await user.click(hardest.getByRole("button").first());
  const own = page.getByRole("region", { name: /^Contacts of fruit/ });
  await own.waitFor();
  const forces = await own.locator("tbody tr").evaluateAll((rows) => rows.map((row) => Number(row.cells[2].innerText)));
  const worst = forces.indexOf(Math.max(...forces));
  await user.click(own.getByRole("button").nth(worst));
});

task("send a colleague the link", 1, async (user) => {
  await user.click(button("Copy link"));
  await page.getByText("The link was copied").waitFor();
  const there = await page.evaluate(() => navigator.clipboard.readText());
  const other = await open(browser, server, { hash: new URL(there).hash });
  await other.page.getByRole("region", { name: /^Contacts of fruit/ }).waitFor();
  await other.context.close();
});

test("ten tasks, and nothing went wrong", (context) => {
  assert.equal(counted.length, 10);
  for (const [name, steps] of counted) context.diagnostic(`${String(steps.length).padStart(2)}  ${name}: ${steps.join(", ")}`);
  assert.deepEqual(view.troubles, []);
});
