/**
 * Campaigns of every kind in every state, made with the program itself.
 */

import { cp, mkdir, readFile, readdir, rm, truncate, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { PROGRAM, windfall } from "./helpers.mjs";
import { execFile } from "node:child_process";

/** Kinds: the template, how recordings are simulated, and how many rows "many" are. */
export const KINDS = {
  impacts: {
    template: "pendulum",
    many: 500,
    words: (directory) => [
      ...["pendulum", "--law", "kuwabara-kono(k=753599, c=1524)", "--recordings", directory],
      ...["--specimens", "6", "--spread", "k=133165", "--spread", "c=263", "--seed", "7"],
    ],
  },
  compression: {
    template: "compression",
    many: 60,
    words: (directory) => [
      ...["compression", directory, "--law", "kuwabara-kono(k=300000, c=20000)"],
      ...["--rate", "1 mm/s", "--rate", "20 mm/s", "--yield-force", "30 N"],
    ],
  },
  relaxation: { template: "relaxation", many: 60, words: null },
  acoustic: {
    template: "acoustic",
    many: 200,
    words: (directory) => ["tap", directory, "--frequency", "800 Hz", "--quality", "20"],
  },
  repeats: {
    template: "repeats",
    many: 498,
    words: (directory) => ["repeats", directory, "--fruit", "6", "--seed", "1"],
    // Rows that are no pairs on one spot would be no such campaign.
    wordsOfMany: (directory) => ["repeats", directory, "--fruit", "34", "--seed", "1"],
  },
  drop: {
    template: "drop",
    many: 150,
    words: (directory) => [
      ...["drop", directory, "--law", 'adams-impact(k="0.868 N/mm^1.91", e=1.91, c="5.56e-4 N s/mm", d="0.001 mm")'],
      ...["--mass", "4.8 g", "--height", "100 mm", "--height", "500 mm", "--drops", "3"],
      ...["--plate-mass", "0.2 kg", "--plate-stiffness", "645.8 N/mm", "--plate-damping", "0.05247 N s/mm"],
    ],
  },
};

/** States in which a campaign can be found. */
export const STATES = ["new", "half", "page", "failed", "stale", "command", "many"];

/** A ramp of 0.4 s and a hold of 60 s of a fruit with two relaxation times; there is no
 *  simulation of it. Every number is a closed form with a small regular noise. */
function hold(fruit) {
  const lines = ["time_s,force_N,position_mm"];
  for (let i = 0; i < 1230; i++) {
    const t = 0.05 * i - 0.5;
    const ramp = Math.min(Math.max(t, 0), 0.4) / 0.4;
    const since = Math.max(t - 0.4, 0);
    const left = 0.5 + 0.3 * Math.exp(-since / (2 + 0.2 * fruit)) + 0.2 * Math.exp(-since / 25);
    const force = (18 + fruit) * ramp ** 1.5 * left + 0.004 * Math.sin(2.3 * i * i);
    lines.push(`${(t + 0.5).toFixed(3)},${force.toFixed(5)},${(5 * (t < 0 ? t : 0.4 * ramp)).toFixed(5)}`);
  }
  return lines.join("\n") + "\n";
}

async function simulated(kind, directory, words = KINDS[kind].words) {
  if (words !== null) return windfall("simulate", ...words(directory));
  await windfall("new", kind, directory);
  await writeFile(join(directory, "specimens.csv"), "id,variety,mass_g\nf1,Golden,180\nf2,Golden,190\nf3,Gala,150\n");
  const rows = [];
  for (let fruit = 1; fruit <= 6; fruit++) {
    await writeFile(join(directory, "raw", `hold-${fruit}.csv`), hold(fruit));
    rows.push(`hold-${fruit},f${Math.ceil(fruit / 2)},hold-${fruit}.csv`);
  }
  await writeFile(join(directory, "impacts.csv"), `id,specimen,file\n${rows.join("\n")}\n`);
}

/** `windfall fit`; a campaign of which some recordings fail is fitted, too. */
const fit = (directory) =>
  new Promise((done) => execFile(PROGRAM, ["fit", directory, "--quiet"], { maxBuffer: 1 << 28 }, () => done()));

const table = (directory) => join(directory, "impacts.csv");

async function linesOf(directory) {
  const [header, ...rows] = (await readFile(table(directory), "utf8")).trim().split("\n");
  return { header, rows };
}

/** A campaign of a kind in a state, "KIND-STATE" in a folder; that of the state "page" is
 *  fitted by who opens it. */
async function campaign(folder, kind, state) {
  const directory = join(folder, `${kind}-${state}`);
  if (state === "new") return windfall("new", KINDS[kind].template, directory);
  const whole = join(folder, `${kind}-command`);
  if (state === "command") {
    await simulated(kind, directory);
    await fit(directory);
    return windfall("report", directory, "--quiet");
  }
  if (state === "many" && KINDS[kind].wordsOfMany) {
    await simulated(kind, directory, KINDS[kind].wordsOfMany);
    return fit(directory);
  }
  await cp(whole, directory, { recursive: true });
  const { header, rows } = await linesOf(directory);
  const raw = join(directory, "raw");
  const files = (await readdir(raw)).sort();
  switch (state) {
    case "half":
    case "page":
    case "many":
      await rm(join(directory, "results.sqlite"), { force: true });
      await rm(join(directory, "report"), { recursive: true, force: true });
  }
  switch (state) {
    case "half":
      await writeFile(table(directory), [header, ...rows.slice(0, rows.length / 2)].join("\n") + "\n");
      await fit(directory);
      return writeFile(table(directory), [header, ...rows].join("\n") + "\n");
    case "failed":
      // One recording breaks off, another is gone.
      await truncate(join(raw, files[0]), 60);
      await rm(join(raw, files.at(-1)));
      return fit(directory);
    case "stale":
      // One recording is another one now.
      return cp(join(raw, files[1]), join(raw, files[0]));
    case "many": {
      const all = Array.from({ length: KINDS[kind].many }, (_, place) =>
        rows[place % rows.length].replace(/^[^,]*/, `item-${String(place + 1).padStart(3, "0")}`),
      );
      await writeFile(table(directory), [header, ...all].join("\n") + "\n");
      return fit(directory);
    }
  }
}

/** All of them in a folder. */
export async function everyCampaign(folder) {
  await mkdir(folder, { recursive: true });
  for (const kind of Object.keys(KINDS)) {
    // Others are made from it.
    await campaign(folder, kind, "command");
    await Promise.all(STATES.filter((state) => state !== "command").map((state) => campaign(folder, kind, state)));
  }
}
