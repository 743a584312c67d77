/** A scene that has run: found, played, scrubbed, and the history of its fruit. */

import assert from "node:assert/strict";
import { cp, readFile, rm, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { accessible, end, fits, launch, open, pictures, scratch, serve, visit, windfall } from "./helpers.mjs";

let place;
let server;
let browser;
let view;
let page;
/** Rows of events.csv and fruit.csv as objects. */
let events;
let fruit;

before(async () => {
  place = await scratch();
  const file = join(place.directory, "chute", "scene.toml");
  await windfall("new", "scene", join(place.directory, "chute"));
  let text = await readFile(file, "utf8");
  for (const [old, changed] of [
    ["count = 100", "count = 40"],
    ['end = "4 s"', 'end = "2 s"'],
    ['least_peak_force = "0.5 N"', 'least_peak_force = "0 N"'],
  ]) {
    assert.ok(text.includes(old), old);
    text = text.replace(old, changed);
  }
  await writeFile(file, text);
  await windfall("scene", "run", file);
  const run = join(place.directory, "chute", "scene.run");
  events = await table(join(run, "events.csv"));
  fruit = await table(join(run, "fruit.csv"));
  // One without frames, one whose frames are cut off within its walls.
  for (const name of ["still.run", "broken.run"]) {
    await cp(run, join(place.directory, name), { recursive: true });
  }
  await rm(join(place.directory, "still.run", "frames.bin"));
  const frames = await readFile(join(run, "frames.bin"));
  await writeFile(join(place.directory, "broken.run", "frames.bin"), frames.subarray(0, 60));
  server = await serve(place.directory);
  browser = await launch("--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist");
  const expected = (words) => /status of (404|422).*\/scenes\//.test(words);
  view = await open(browser, server, { hash: "#/", expected });
  page = view.page;
});

after(() => end({ browser, server, place }));

async function table(file) {
  const [header, ...lines] = (await readFile(file, "utf8")).trim().split("\n");
  const names = header.split(",");
  return lines.map((line) => Object.fromEntries(line.split(",").map((cell, at) => [names[at], cell])));
}

const now = async () => Number((await page.locator("output.now").innerText()).replace(" s", ""));
const slider = () => page.getByRole("slider", { name: "Time" });
const stage = () => page.locator(".stage");
const settle = () => page.waitForTimeout(400);
const heading = (words) => page.getByRole("heading", { level: 2, name: words, exact: true });

/** Contacts of a fruit in events.csv, as it sees them, by time. */
function contactsOf(number) {
  const own = String(number);
  return events
    .filter((row) => row.fruit === own || row.partner_fruit === own)
    .map((row) => ({
      time: Number(row.time_s),
      touched: row.partner === "fruit" ? `fruit ${row.fruit === own ? row.partner_fruit : row.fruit}` : row.partner,
      force: Number(row.peak_force_N),
      speed: Number(row.normal_speed_m_s),
      absorbed: 1e3 * Number(row.absorbed_energy_J),
    }))
    .sort((a, b) => a.time - b.time);
}

/** The table of contacts must say what events.csv says. */
async function historyHolds(number) {
  await heading(`Fruit ${number}`).waitFor();
  const rows = page.locator("table.history tbody tr");
  await rows.first().waitFor();
  const cells = await rows.evaluateAll((all) => all.map((row) => [...row.cells].map((cell) => cell.innerText)));
  const expected = contactsOf(number);
  assert.equal(cells.length, expected.length, `contacts of fruit ${number}`);
  const plain = (words) => {
    const [, mantissa, power] = /^([−\d.\s\u202f]+)(?:·10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+))?$/.exec(words.trim());
    const digits = [...(power ?? "⁰")].map((each) => (each === "⁻" ? "-" : "⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(each)));
    return Number(mantissa.replace(/[\s\u202f]/g, "").replace("−", "-")) * 10 ** Number(digits.join(""));
  };
  for (const [at, [time, touched, force, speed, absorbed]] of cells.entries()) {
    const own = expected[at];
    assert.equal(time.trim(), own.time.toFixed(4));
    assert.equal(touched.replace(", lasting", ""), own.touched);
    for (const [shown, value, digits] of [[force, own.force, 4], [speed, own.speed, 3], [absorbed, own.absorbed, 3]]) {
      const off = Math.abs(plain(shown) - value);
      assert.ok(off <= 0.51 * 10 ** (1 - digits) * Math.abs(value) + 1e-12, `${shown} for ${value}`);
    }
  }
}

test("scenes are listed beside campaigns, also those that cannot be played", async () => {
  await page.getByRole("heading", { level: 2, name: "Scenes" }).waitFor();
  const cards = page.locator("section", { has: page.getByRole("heading", { name: "Scenes" }) }).locator("li");
  assert.equal(await cards.count(), 3);
  await cards.filter({ hasText: "still.run" }).getByText("It was run without frames").waitFor();
  await cards.filter({ hasText: "broken.run" }).getByText("Cannot be read").waitFor();
  await accessible(page, "list of scenes");
  await fits(page, "list of scenes");
  await pictures(page, "scenes");
  await cards.filter({ hasText: "chute/scene.run" }).getByRole("link").click();
  await page.getByRole("heading", { level: 1, name: "Apples over an edge into a bin" }).waitFor();
  await page.waitForFunction(() => document.querySelector(".stage canvas")?.width > 300);
});

test("it starts at the end, is scrubbed by keys, and what is drawn changes", async () => {
  await settle();
  const end = await now();
  assert.ok(Math.abs(end - 2) < 1e-3, `${end}`);
  const last = await stage().screenshot();
  await slider().focus();
  await page.keyboard.press("Home");
  assert.equal(await now(), 0);
  for (let k = 0; k < 10; k++) await page.keyboard.press("ArrowRight");
  assert.ok(Math.abs((await now()) - 0.2) < 1e-9);
  await page.getByRole("button", { name: "One frame forward" }).click();
  assert.ok(Math.abs((await now()) - 0.22) < 1e-3, `${await now()}`);
  await settle();
  // Released until then.
  const there = fruit.filter((row) => row.released_s !== "" && Number(row.released_s) <= 0.2).length;
  const words = await page.locator(".legend figcaption").innerText();
  const shown = Number(/(\d+) fruit in the scene/.exec(words)[1]);
  assert.ok(Math.abs(shown - there) <= 1, `${shown} and ${there}`);
  assert.notDeepEqual(await stage().screenshot(), last);
});

test("time, fruit and camera are in the address, and come back", async () => {
  await stage().focus();
  await page.keyboard.press("ArrowLeft");
  const held = () => page.evaluate(() => Object.fromEntries(new URLSearchParams(location.hash.split("?")[1])));
  await page.waitForFunction(() => location.hash.includes("camera="));
  const before = await held();
  assert.ok(Math.abs(Number(before.time) - (await now())) < 1e-3, before.time);
  await page.reload();
  await page.waitForFunction(() => document.querySelector(".stage canvas")?.width > 300);
  await page.waitForTimeout(1000);
  assert.deepEqual(await held(), before);
  assert.ok(Math.abs((await now()) - Number(before.time)) < 1e-3);
  // Another fruit and time, as a link has them.
  const to = (await page.evaluate(() => location.hash)).split("?")[0];
  await visit(page, `${to}?time=1&fruit=5`);
  await heading("Fruit 5").waitFor();
  assert.equal(await now(), 1);
  await visit(page, `${to}?time=0.22&fruit=900`);
  await page.getByText("which was left out: fruit 900").waitFor();
  await page.getByRole("button", { name: "Close this message" }).click();
});

test("it plays at the speed asked for, and pauses", async () => {
  await slider().focus();
  await page.keyboard.press("Home");
  await page.getByLabel("Speed").selectOption("0.25");
  const from = Date.now();
  await page.getByRole("button", { name: "Play" }).click();
  await page.waitForTimeout(1500);
  await page.getByRole("button", { name: "Pause" }).click();
  const [passed, time] = [(Date.now() - from) / 1000, await now()];
  // Slow machines show fewer frames; only a pause of a quarter of a second is left out.
  assert.ok(time > 0.1 && time <= 0.25 * passed + 0.01, `${time} s of the scene in ${passed} s`);
  const still = await now();
  await page.waitForTimeout(300);
  assert.equal(await now(), still);
  await stage().focus();
  await page.keyboard.press("Space");
  await page.getByRole("button", { name: "Pause" }).waitFor();
  await page.keyboard.press("Space");
  await page.getByRole("button", { name: "Play" }).waitFor();
});

test("a fruit that is clicked tells its history, as events.csv has it", async () => {
  await slider().focus();
  await page.keyboard.press("Home");
  for (let k = 0; k < 12; k++) await page.keyboard.press("ArrowRight");
  await settle();
  // Where fruit 1 is seen; a click there chooses it, or one before it.
  await page.getByLabel("Number").fill("1");
  await page.getByRole("button", { name: "Show", exact: true }).click();
  await historyHolds(1);
  await page.locator(".label").waitFor();
  const at = await page.locator(".label").evaluate((own) => [parseFloat(own.style.left), parseFloat(own.style.top)]);
  await stage().focus();
  await page.keyboard.press("Escape");
  await heading("A fruit").waitFor();
  const box = await stage().boundingBox();
  await page.mouse.click(box.x + at[0], box.y + at[1]);
  await page.locator(".label").waitFor();
  const found = Number(/Fruit (\d+)/.exec(await page.locator(".label").innerText())[1]);
  await historyHolds(found);
  assert.equal(found, 1, "nothing is before the first fruit");
  // A click beside everything chooses nothing.
  await page.mouse.click(box.x + 3, box.y + 3);
  await heading("A fruit").waitFor();
});

test("the fruit hit hardest is chosen in the list, marked, and looked at through the others", async () => {
  await slider().focus();
  await page.keyboard.press("End");
  await settle();
  const plain = await stage().screenshot();
  const forces = fruit.filter((row) => row.largest_peak_force_N !== "");
  forces.sort((a, b) => Number(b.largest_peak_force_N) - Number(a.largest_peak_force_N));
  const list = page.getByRole("region", { name: "Fruit that were hit hardest" });
  const first = list.locator("tbody button").first();
  assert.equal(await first.innerText(), forces[0].fruit);
  await first.click();
  await historyHolds(Number(forces[0].fruit));
  await page.getByLabel("See through the others").check();
  await settle();
  const marked = await stage().screenshot();
  assert.notDeepEqual(marked, plain);
  // To the moment of a contact.
  await page.locator("table.history tbody button").first().click();
  const contact = contactsOf(Number(forces[0].fruit))[0];
  assert.ok(Math.abs((await now()) - contact.time) < 1e-3);
  await page.getByRole("button", { name: "Top" }).click();
  await settle();
  await page.getByRole("button", { name: "Aslant" }).click();
  await slider().focus();
  await page.keyboard.press("End");
  await settle();
  await accessible(page, "scene");
  await fits(page, "scene");
  await pictures(page, "scene");
  await page.getByLabel("See through the others").uncheck();
  await settle();
  await pictures(page, "scene-whole");
});

test("fruit are coloured by force, speed and absorbed energy, each with its scale", async () => {
  const choices = page.getByLabel("Colour by");
  const words = await choices.locator("option").allInnerTexts();
  assert.deepEqual(words, ["peak force", "speed", "absorbed energy"]);
  const energies = fruit.map((row) => 1e3 * Number(row.absorbed_energy_J));
  const seen = [];
  for (const word of words) {
    await choices.selectOption(word);
    await settle();
    seen.push(await stage().screenshot());
    const said = await page.locator(".legend svg").getAttribute("aria-label");
    if (word === "absorbed energy") {
      const most = Number(/to ([\d.\u202f]+) millijoule/.exec(said)[1].replace("\u202f", ""));
      assert.ok(Math.abs(most / Math.max(...energies) - 1) < 0.006, `${said}: ${Math.max(...energies)}`);
    }
  }
  assert.notDeepEqual(seen[0], seen[1]);
  assert.notDeepEqual(seen[1], seen[2]);
  await accessible(page, "scene coloured by energy");
  await fits(page, "scene coloured by energy");
  await choices.selectOption("peak force");
});

/** The file that a button gives. */
async function saved(name) {
  const arriving = page.waitForEvent("download", { timeout: 60_000 });
  await page.getByRole("button", { name }).click();
  const file = await arriving;
  return { name: file.suggestedFilename(), bytes: await readFile(await file.path()) };
}

test("what is seen is saved as a picture that is wide enough for print", async () => {
  const { name, bytes } = await saved("Save picture (PNG)");
  assert.equal(name, "chute-scene.png");
  assert.equal(bytes.toString("latin1", 1, 4), "PNG");
  assert.equal(bytes.readUInt32BE(16), 2400);
  // The scene is drawn, not only the paper: noise of edges and shades does not compress away.
  assert.ok(bytes.length > 60_000, `${bytes.length} bytes`);
  if (process.env.SCREENSHOTS) await writeFile(join(process.env.SCREENSHOTS, "saved.png"), bytes);
  // The scene on the page is as large as before.
  const ratio = await page.evaluate(() => {
    const canvas = document.querySelector(".stage canvas");
    return canvas.width / canvas.clientWidth / Math.min(window.devicePixelRatio, 2);
  });
  assert.ok(Math.abs(ratio - 1) < 0.01, `${ratio}`);
});

test("a film plays from the time shown to the end", async () => {
  await slider().focus();
  await page.keyboard.press("End");
  for (let k = 0; k < 10; k++) await page.keyboard.press("ArrowLeft");
  await page.getByLabel("Speed").selectOption("0.5");
  const from = await now();
  const { name, bytes } = await saved("Save film (WebM)");
  assert.equal(name, "chute-scene.webm");
  assert.ok(Math.abs((await now()) - 2) < 1e-3);
  if (process.env.SCREENSHOTS) await writeFile(join(process.env.SCREENSHOTS, "saved.webm"), bytes);
  // The page itself may load no film.
  const blank = await page.context().newPage();
  const film = await blank.evaluate(async (data) => {
    const video = document.createElement("video");
    video.muted = true;
    video.src = URL.createObjectURL(new Blob([new Uint8Array(data)], { type: "video/webm" }));
    await new Promise((done, failed) => {
      video.onloadeddata = done;
      video.onerror = () => failed(new Error("no film"));
    });
    const { duration } = video;
    const ended = new Promise((done) => (video.onended = done));
    await video.play();
    await ended;
    const length = video.currentTime;
    const frames = video.getVideoPlaybackQuality().totalVideoFrames;
    // One can jump to any of its times, and sees another picture there.
    const sheet = new OffscreenCanvas(160, 120).getContext("2d");
    const pictures = [];
    for (const time of [0, 0.5 * duration]) {
      const there = new Promise((done) => (video.onseeked = done));
      video.currentTime = time;
      await there;
      sheet.drawImage(video, 0, 0, 160, 120);
      pictures.push(sheet.getImageData(0, 0, 160, 120).data.join());
    }
    return { width: video.videoWidth, duration, length, frames, moved: pictures[0] !== pictures[1] };
  }, [...bytes]);
  await blank.close();
  assert.equal(film.width, 1280);
  // The last picture stands for 0.4 s.
  const expected = (2 - from) / 0.5 + 0.4;
  for (const found of [film.duration, film.length]) {
    assert.ok(Math.abs(found - expected) < 0.05, `${found} s of ${expected}`);
  }
  assert.ok(film.frames >= 0.9 * 30 * (expected - 0.4), `${film.frames} pictures`);
  assert.ok(film.moved);
});

test("a number that no fruit has is told, and a scene that is not there", async () => {
  await page.getByLabel("Number").fill("41");
  await page.getByRole("button", { name: "Show", exact: true }).click();
  await page.getByText("There is no fruit 41").waitFor();
  await visit(page, "#/s/none.run");
  await page.getByRole("alert").getByText("there are no results of a scene").waitFor();
  await visit(page, "#/s/broken.run");
  await page.getByRole("alert").getByText("broken.run/frames.bin").waitFor();
});

test("what is asked wrongly is answered so", async () => {
  const asked = (path) => fetch(`${server.origin}/api/scenes/${path}`, { headers: server.admitted });
  const status = async (path) => (await asked(path)).status;
  const id = encodeURIComponent("chute/scene.run");
  assert.equal(await status(`${id}/history?fruit=0`), 404);
  assert.equal(await status(`${id}/history?fruit=x`), 400);
  assert.equal(await status(`${id}/history`), 400);
  assert.equal(await status(`${encodeURIComponent("../chute/scene.run")}`), 404);
  assert.equal(await status("chute"), 404);
  assert.equal(await status("still.run/frames"), 404);
  assert.equal(await status("broken.run/frames"), 422);
  const beyond = await asked(`${id}/frames?from=100000`);
  assert.equal((await beyond.arrayBuffer()).byteLength, 0);
});

test("nothing went wrong on the way", () => {
  assert.deepEqual(view.troubles, []);
});

test("without 3D graphics the page says so, and shows the tables", async () => {
  const plain = await launch("--disable-3d-apis");
  const own = await open(plain, server, {
    hash: `#/s/${encodeURIComponent("chute/scene.run")}`,
    expected: (words) => /WebGL/.test(words),
  });
  await own.page.getByRole("alert").getByText("no 3D graphics").waitFor();
  await own.page.getByRole("region", { name: "Fruit that were hit hardest" }).locator("button").first().click();
  await own.page.locator("table.history tbody tr").first().waitFor();
  assert.deepEqual(own.troubles, []);
  await plain.close();
});
