/** Findings of a campaign and of an impact, laws side by side, and the rig asked for first. */

import assert from "node:assert/strict";
import { copyFile, readFile, readdir } from "node:fs/promises";
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

let browser, place, server, page, troubles;

const title = (words) => page.getByRole("heading", { level: 1, name: words }).waitFor();
const inspect = async (name) => {
  await fits(page, name);
  await accessible(page, name);
  await pictures(page, name);
};

before(async () => {
  place = await scratch();
  await pendulum(place.directory, "apples", 6);
  // Two of six recordings reach the end of a smaller range.
  const small = join(place.directory, "small");
  await windfall(
    ...["simulate", "pendulum", "--law", "kuwabara-kono(k=753599, c=1524)", "--recordings", small],
    ...["--specimens", "6", "--seed", "7", "--bits", "12", "--range", "0.05 V"],
  );
  const files = (await readdir(join(small, "raw"))).sort().slice(0, 2);
  for (const file of files) await copyFile(join(small, "raw", file), join(place.directory, "apples/raw", file));
  await windfall("new", "carriage", join(place.directory, "cart"));
  browser = await launch();
  server = await serve(place.directory);
  // The template of a cart names recordings that are not there.
  ({ page, troubles } = await open(browser, server, { expected: (words) => /\/api\/campaigns\/cart\/(outline|refit)/.test(words) }));
});

after(() => end({ browser, server, place }));

test("the overview has the list that the command prints, the gravest first, with counts and links", async () => {
  const printed = await windfall("fit", join(place.directory, "apples"));
  const list = printed.slice(printed.indexOf("\nFindings:"));
  const codes = [...list.matchAll(/^ {2}\[(\w+)\] ([\w-]+):/gm)].map(([, severity, code]) => `${severity} ${code}`);
  assert.ok(codes.includes("wrong clipped"), list);
  await visit(page, "#/c/apples");
  const section = page.getByRole("region", { name: "Findings", exact: true });
  const shown = section.getByRole("listitem");
  await shown.first().waitFor();
  const words = await shown.evaluateAll((all) =>
    all.map((own) => `${own.querySelector(".word").textContent} ${own.querySelector("strong").textContent}`),
  );
  assert.deepEqual(words, codes);
  // What impulse and momentum of those that are not clipped say of the mass, beside inertia over arm squared, 0.01435/0.505² kg.
  const rig = page.getByRole("region", { name: "The rig" });
  await rig.getByText("What the recordings say").waitFor();
  assert.match(await rig.textContent(), /at the contact \(4\s+impacts\).*your rig makes\s+0\.05627/s);
  // Shape as well as colour.
  const shapes = await shown.evaluateAll((all) => all.map((own) => own.querySelector(".body").outerHTML));
  assert.equal(new Set(shapes).size, new Set(codes.map((code) => code.split(" ")[0])).size);

  const clipped = shown.filter({ hasText: "wrong clipped" });
  await clipped.getByText("What it means, and what to do").click();
  const { findings } = JSON.parse(await windfall("explain", "clipped", "--format", "json"));
  await clipped.getByText(findings[0].advice).waitFor();
  await clipped.getByText("2 of 6 impacts").click();
  await inspect("findings-overview");
  await clipped.getByRole("link", { name: "specimen-02" }).click();
  await title("Impact specimen-02");
});

test("the laws of an impact stand side by side, and a finding names its law", async () => {
  await visit(page, "#/c/apples/impact/specimen-03");
  await title("Impact specimen-03");
  for (const law of ["hertz", "hunt-crossley"]) await page.getByRole("checkbox", { name: law, exact: true }).check();
  const laws = page.getByRole("region", { name: "Laws side by side" });
  await laws.getByRole("columnheader", { name: "hunt-crossley" }).waitFor();
  const row = (name) => laws.getByRole("row", { name });
  await row(/^ΔAICc/).getByText("(best)").waitFor();
  const criteria = await row(/^ΔAICc/).getByRole("cell").allTextContents();
  assert.equal(criteria.length, 3);
  assert.match(criteria[0], /^0 \(best\)/, "the law that made the data");
  assert.match(await row(/^k /).textContent(), /N\/m/);
  assert.deepEqual(await row(/^Converged/).getByRole("cell").allTextContents(), ["yes", "yes", "yes"]);
  const ratios = await row(/^Force: residual \/ noise/).getByRole("cell").allTextContents();
  assert.ok(Number(ratios[1]) > 2 * Number(ratios[0]), `hertz leaves more: ${ratios}`);
  const section = page.getByRole("region", { name: "Findings", exact: true });
  await section.getByRole("listitem").filter({ hasText: "misfit (hertz" }).first().waitFor();
  await inspect("findings-impact");
});

test("the mass of a template is not taken for that of the rig", async () => {
  await visit(page, "#/c/cart/impact");
  await page.getByText("mass = 0.5 kg").waitFor();
  await page.getByRole("link", { name: "Give the rig" }).click();
  const rig = page.getByRole("region", { name: "The rig" });
  const write = rig.getByRole("button", { name: "Write the rig into campaign.toml" });
  assert.ok(await write.isDisabled());
  await rig.getByText("Still needed: mass, driving acceleration.").waitFor();
  assert.equal(await rig.getByLabel("Mass (needed)").inputValue(), "");
  await inspect("rig-asked");
  await rig.getByLabel("Mass (needed)").fill("500");
  await rig.getByLabel("Unit of mass", { exact: true }).selectOption("g");
  await rig.getByLabel("Driving acceleration (needed)").fill("0");
  await write.click();
  await page.getByText("The rig was written").waitFor();
  const text = await readFile(join(place.directory, "cart/campaign.toml"), "utf8");
  assert.match(text, /^mass = "500 g"$/m);
  assert.match(text, /^driving_acceleration = "0 m\/s\^2"$/m);
  await visit(page, "#/c/cart/impact");
  await page.getByText("mass = 0.5 kg").waitFor({ state: "detached" });
});

test("a new campaign is asked for its rig, of every kind", async () => {
  await visit(page, "#/");
  await title("Campaigns");
  for (const kind of ["drop", "compression", "relaxation", "acoustic", "repeats", "carriage", "pendulum"]) {
    await page.getByLabel("Kind").selectOption(kind);
    if (kind !== "relaxation") await page.locator(".rig figure svg[role=img]").waitFor();
    await fits(page, `rig ${kind}`);
    await pictures(page, `rig-${kind}`);
  }
  await page.getByLabel("Directory name").fill("arm");
  for (const [name, value] of [["Inertia", "143.5"], ["Arm", "50,5"], ["Mass", "110"], ["Centre of mass", "30"]]) {
    await page.getByLabel(`${name} (needed)`, { exact: true }).fill(value);
  }
  await page.getByLabel("Unit of inertia").selectOption("kg cm^2");
  await page.getByLabel("Unit of arm").selectOption("cm");
  await page.getByLabel("Unit of mass", { exact: true }).selectOption("g");
  await page.getByLabel("Unit of centre of mass").selectOption("cm");
  await accessible(page, "new campaign");
  await page.getByRole("button", { name: "Make it" }).click();
  await page.waitForURL(/#\/c\/arm/);
  const text = await readFile(join(place.directory, "arm/campaign.toml"), "utf8");
  assert.match(text, /^inertia = "143.5 kg cm\^2"$/m);
  assert.match(text, /^arm = "50.5 cm"$/m);
  await page.getByText("Asked first").waitFor({ state: "detached" });
});

test("nothing went wrong in the page", () => {
  assert.deepEqual(troubles, []);
});
