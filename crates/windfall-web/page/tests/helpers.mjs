/**
 * What the tests of the page share: a server of the real program on a directory of its
 * own, a real browser, and an account of what went wrong in it.
 *
 * WINDFALL: the program; CHROMIUM: the browser; SCREENSHOTS: a folder for pictures.
 */

import assert from "node:assert/strict";
import { execFile, spawn } from "node:child_process";
import { existsSync } from "node:fs";
import { mkdir, mkdtemp, readFile, rm } from "node:fs/promises";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { delimiter, dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { promisify } from "node:util";
import { chromium } from "playwright-core";

const here = dirname(fileURLToPath(import.meta.url));
export const PROGRAM = resolve(
  process.env.WINDFALL ?? join(here, "../../../../target/debug/windfall"),
);
const AXE = await readFile(join(here, "../node_modules/axe-core/axe.min.js"), "utf8");

export const WIDE = { width: 1440, height: 900 };
export const NARROW = { width: 390, height: 844 };

function executable() {
  if (process.env.CHROMIUM) return process.env.CHROMIUM;
  const names = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];
  const found = (process.env.PATH ?? "")
    .split(delimiter)
    .flatMap((folder) => names.map((name) => join(folder, name)))
    .find((path) => existsSync(path));
  assert.ok(found, "no Chromium on the PATH; set CHROMIUM");
  return found;
}

/** Runs the program and answers what it wrote to standard output. */
export async function windfall(...words) {
  const { stdout } = await promisify(execFile)(PROGRAM, words, { maxBuffer: 1 << 28 });
  return stdout;
}

/** A new empty directory; `remove` takes it away. */
export async function scratch() {
  const directory = await mkdtemp(join(tmpdir(), "windfall-page-"));
  return { directory, remove: () => rm(directory, { recursive: true, force: true }) };
}

/** A campaign of simulated impacts of a carriage, one of each fruit; its directory. */
export async function carriage(parent, name, specimens) {
  const directory = join(parent, name);
  await windfall(
    ...["simulate", "carriage", "--law", "kuwabara-kono(k=753599, c=1524)", "--mass", "0.3 kg"],
    ...["--velocity", "1 m/s", "--specimens", `${specimens}`, "--spread", "k=133165"],
    ...["--recordings", directory],
  );
  return directory;
}

/** A campaign of simulated pendulum impacts; its directory. */
export async function pendulum(parent, name = "apples", specimens = 6) {
  const directory = join(parent, name);
  await windfall(
    ...["simulate", "pendulum", "--law", "kuwabara-kono(k=753599, c=1524)"],
    ...["--recordings", directory, "--specimens", String(specimens)],
    ...["--spread", "k=133165", "--spread", "c=263", "--seed", "7"],
  );
  return directory;
}

/** A recording as a German spreadsheet writes it: an impact with noise, from the law. */
export async function germanRecording() {
  const words = await windfall("simulate", "pendulum", "--law", "kuwabara-kono(k=753599, c=1524)", "--rate", "100 kHz", "--format", "csv");
  const [header, ...rows] = words.trim().split("\n").map((line) => line.split(","));
  const at = (name) => header.indexOf(name);
  let seed = 7;
  const noise = () => {
    // Park and Miller's generator: the same noise in every run.
    seed = (seed * 48271) % 2147483647;
    return seed / 2147483647 - 0.5;
  };
  const german = (value) => value.toPrecision(9).replace(".", ",");
  const start = Number(rows[0][at("time_s")]);
  // More of the free flight before it, so that the noise without contact is seen.
  const step = Number(rows[1][at("time_s")]) - start;
  const velocity = Number(rows[0][at("rate_m_s")]);
  const flight = Array.from({ length: 300 }, (_, index) => ({
    time: start - (300 - index) * step,
    force: 0,
    displacement: Number(rows[0][at("displacement_m")]) - (300 - index) * step * velocity,
  }));
  const impact = rows.map((row) => ({
    time: Number(row[at("time_s")]),
    force: Number(row[at("force_N")]),
    displacement: Number(row[at("displacement_m")]),
  }));
  const lines = [...flight, ...impact].map(({ time, force, displacement }) =>
    [1000 * (time - start) + 3, force + 0.4 * noise(), 1000 * displacement + 2e-4 * noise()]
      .map(german)
      .join(";"),
  );
  return ["Zeit [ms];Kraft [N];Weg [mm]", ...lines].join("\r\n");
}

async function freePort() {
  const server = createServer();
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  const { port } = server.address();
  await new Promise((done) => server.close(done));
  return port;
}

/** `windfall serve` on a directory; waits until it answers. `address` is the one that it
 *  prints, with its token. */
export async function serve(directory, port) {
  port ??= await freePort();
  const origin = `http://127.0.0.1:${port}`;
  const child = spawn(PROGRAM, ["serve", directory, "--port", String(port), "--no-open"], {
    stdio: ["ignore", "pipe", "pipe"],
  });
  let words = "";
  for (const stream of [child.stdout, child.stderr]) stream.on("data", (part) => (words += part));
  const ended = new Promise((done) => child.once("exit", done));
  let address;
  for (let tries = 0; ; tries++) {
    // It listens before it prints where.
    address = /^http:\S+\n/m.exec(words)?.[0].trim();
    if (address) break;
    assert.ok(child.exitCode === null && tries < 200, `windfall serve does not answer: ${words}`);
    await new Promise((done) => setTimeout(done, 50));
  }
  return {
    origin,
    address,
    port,
    /** What programs send. */
    admitted: { Authorization: `Bearer ${new URL(address).searchParams.get("token")}` },
    said: () => words,
    async stop() {
      child.kill("SIGTERM");
      await ended;
    },
  };
}

/** A browser; `more` are switches of it. */
export const launch = (...more) =>
  chromium.launch({ executablePath: executable(), args: ["--disable-gpu", "--no-first-run", ...more] });

/**
 * A page in a window of its own. `troubles` holds errors of the console, exceptions and
 * requests to other origins; `weight()` is what the page itself weighed on its way.
 */
export async function open(browser, server, options = {}) {
  const context = await browser.newContext({
    viewport: options.viewport ?? WIDE,
    colorScheme: options.colours ?? "light",
    reducedMotion: "reduce",
    acceptDownloads: true,
    timezoneId: options.timezoneId,
  });
  const page = await context.newPage();
  const troubles = [];
  const expected = options.expected ?? (() => false);
  page.on("console", (message) => {
    const words = `${message.text()} (${message.location().url})`;
    if (message.type() === "error" && !expected(words)) troubles.push(`console: ${words}`);
  });
  page.on("pageerror", (error) => troubles.push(`exception: ${error.message}`));
  page.on("request", (request) => {
    const url = request.url();
    if (!url.startsWith(server.origin) && !/^(data|blob):/.test(url)) troubles.push(`request: ${url}`);
  });
  const assets = [];
  page.on("requestfinished", (request) => {
    if (new URL(request.url()).pathname.startsWith("/api/")) return;
    const sizes = request.sizes();
    // A page that is closed knows none: that is an error for `weight` alone.
    sizes.catch(() => {});
    assets.push(sizes);
  });
  await page.goto(`${server.address}${options.hash ?? ""}`);
  return {
    page,
    context,
    troubles,
    async weight() {
      const sizes = await Promise.all(assets);
      return sizes.reduce((sum, size) => sum + size.responseBodySize, 0);
    },
  };
}

/** Goes to a part of the page, `#/…`. */
export async function visit(page, hash) {
  await page.evaluate((to) => {
    location.hash = to;
  }, hash);
}

/** Fails where axe-core finds a serious or critical violation. */
export async function accessible(page, where) {
  // As a function of the tests, not of the page, whose policy allows no foreign script.
  await page.evaluate(AXE);
  const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  const grave = violations
    .filter((violation) => ["serious", "critical"].includes(violation.impact))
    .map((violation) => `${violation.id}: ${violation.help}\n    ${violation.nodes.map((node) => node.html.slice(0, 200)).slice(0, 4).join("\n    ")}`);
  assert.deepEqual(grave, [], `${where}: accessibility`);
}

/** Pictures of a view at both sizes in both colours, where SCREENSHOTS says a folder.
 *  Leaves the window as it was. */
export async function pictures(page, name) {
  const folder = process.env.SCREENSHOTS;
  if (!folder) return;
  await mkdir(folder, { recursive: true });
  for (const colorScheme of ["light", "dark"]) {
    await page.emulateMedia({ colorScheme });
    for (const [size, viewport] of Object.entries({ wide: WIDE, narrow: NARROW })) {
      await page.setViewportSize(viewport);
      await page.waitForTimeout(300);
      await page.screenshot({ path: join(folder, `${name}-${size}-${colorScheme}.png`) });
      await page.screenshot({
        path: join(folder, `${name}-${size}-${colorScheme}-full.png`),
        fullPage: true,
      });
    }
  }
  await page.emulateMedia({ colorScheme: "light" });
  await page.setViewportSize(WIDE);
}

/** The view must not be wider than the window: one does not scroll a page sideways. */
export async function fits(page, where) {
  for (const viewport of [WIDE, NARROW]) {
    await page.setViewportSize(viewport);
    await page.waitForTimeout(150);
    const over = await page.evaluate(
      () => document.documentElement.scrollWidth - document.documentElement.clientWidth,
    );
    assert.ok(over <= 0, `${where}: ${over} pixels too wide at ${viewport.width}`);
  }
  await page.setViewportSize(WIDE);
}

/** A view at rest: as it should be for everybody, and its pictures. */
export async function atRest(page, name) {
  await accessible(page, name);
  await fits(page, name);
  await pictures(page, name);
}

/** Ends what the tests of a file began. */
export async function end({ browser, server, place }) {
  await browser?.close();
  await server?.stop();
  await place?.remove();
}

/** The number below which `part` of the values lie. */
export function quantile(values, part) {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.min(sorted.length - 1, Math.ceil(part * sorted.length) - 1)];
}
