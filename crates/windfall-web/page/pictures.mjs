/**
 * The pictures of the page that README and guide show, taken of the page itself.
 *
 *   npm run pictures [NAME …]      writes docs/guide/src/images/page-NAME.png
 *
 * The campaigns are simulated with fixed seeds.
 */

import { mkdir, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { KINDS } from "./tests/campaigns.mjs";
import { germanRecording, launch, open, scratch, serve, windfall } from "./tests/helpers.mjs";

const FOLDER = fileURLToPath(new URL("../../../docs/guide/src/images", import.meta.url));
const SIZE = { width: 1280, height: 860 };

/** What is seen of each: the campaign's part, what to wait for and do, what is cut out. */
const VIEWS = {
  findings: {
    hash: "#/c/study/overview",
    async make(page) {
      const findings = page.getByRole("region", { name: "Findings" });
      await findings.waitFor();
      return findings;
    },
  },
  impact: {
    hash: "#/c/study/impact/apple-03?laws=kuwabara-kono;hunt-crossley;hertz",
    async make(page) {
      await page.getByRole("region", { name: "Laws side by side" }).getByRole("columnheader", { name: "hertz" }).waitFor();
    },
  },
  laws: {
    hash: "#/c/study/impact/apple-03?laws=kuwabara-kono;hunt-crossley;hertz",
    async make(page) {
      const laws = page.getByRole("region", { name: "Laws side by side" });
      await laws.getByRole("row", { name: /^ΔAICc/ }).waitFor();
      return page.locator("section", { has: page.getByRole("heading", { name: "Laws side by side" }) }).first();
    },
  },
  rig: {
    hash: "#/c/own/overview",
    async make(page) {
      const rig = page.getByRole("region", { name: "The rig" });
      await rig.getByLabel(/^Inertia/).fill("0.01435");
      await rig.getByLabel(/^Arm/).fill("0.505");
      return rig;
    },
  },
  table: {
    hash: "#/c/study/table",
    async make(page) {
      await page.getByText("apple-01").first().waitFor();
    },
  },
  drop: {
    hash: "#/c/drops/item",
    async make(page) {
      await page.getByRole("region", { name: "Figure" }).locator("svg").first().waitFor();
    },
  },
  scene: {
    async make(page) {
      await page.getByRole("region", { name: "Scenes" }).getByRole("link").first().click();
      const hardest = page.getByRole("region", { name: "Fruit that were hit hardest" });
      await hardest.getByRole("button").first().click();
      const own = page.getByRole("region", { name: /^Contacts of fruit/ });
      await own.waitFor();
      await own.getByRole("button").nth(3).click();
    },
  },
};

async function campaigns(directory) {
  await windfall("simulate", "pendulum", "--example", join(directory, "study"));
  await windfall("fit", join(directory, "study"), "--quiet");
  const drops = join(directory, "drops");
  await windfall("simulate", ...KINDS.drop.words(drops));
  await windfall("fit", drops, "--quiet");
  const own = join(directory, "own");
  await windfall("new", "pendulum", own);
  await writeFile(join(own, "raw", "stoss-1.csv"), await germanRecording());
  const scene = join(directory, "chute", "scene.toml");
  await windfall("new", "scene", join(directory, "chute"));
  await windfall("scene", "run", scene);
}

const place = await scratch();
await campaigns(place.directory);
const server = await serve(place.directory);
const browser = await launch("--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist");
await mkdir(FOLDER, { recursive: true });
const asked = process.argv.slice(2);
for (const [name, view] of Object.entries(VIEWS)) {
  if (asked.length > 0 && !asked.includes(name)) continue;
  const { page, context, troubles } = await open(browser, server, { hash: view.hash ?? "#/", viewport: SIZE });
  const part = await view.make(page);
  await page.waitForLoadState("networkidle").catch(() => {});
  await page.waitForTimeout(1500);
  await (part ?? page).screenshot({ path: join(FOLDER, `page-${name}.png`) });
  if (troubles.length > 0) console.error(name, troubles);
  await context.close();
}
await browser.close();
await server.stop();
await place.remove();
