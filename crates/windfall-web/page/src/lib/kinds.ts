/** Kinds of campaigns: which views each has, and what its recordings are called. */

import type { Part } from "./route.svelte";

interface Link {
  part: Part;
  label: string;
  /** What is done there. */
  words: string;
}

/** What a recording of a kind that fits no impacts shows. */
const ITEMS: Record<string, { one: string; many: string; words: string }> = {
  drop: { one: "Drop", many: "Drops one by one", words: "bounces, restitution, ringing of the plate" },
  acoustic: { one: "Tap", many: "Taps one by one", words: "spectrum, resonances" },
  compression: { one: "Compression", many: "Compressions one by one", words: "loading curve, fitted laws" },
  relaxation: { one: "Relaxation", many: "Relaxations one by one", words: "force during the hold, fitted models" },
  repeats: { one: "Impact", many: "Impacts one by one", words: "values, recording" },
};

/** What one recording of a kind is called. */
export const itemName = (kind: string) => ITEMS[kind]?.one ?? "Impact";

/** The view of one recording. */
export const itemPart = (kind: string): Part => (kind === "impacts" ? "impact" : "item");

/** Links of the navigation of a campaign of a kind. */
export function linksOf(kind: string): Link[] {
  const impacts = kind === "impacts";
  const item: Link = impacts
    ? { part: "impact", label: "Impact", words: "window, law, residuals" }
    : { part: "item", label: itemName(kind), words: ITEMS[kind]?.words ?? "values, figure" };
  const all: (Link | null)[] = [
    { part: "overview", label: "Overview", words: "state, findings, results" },
    { part: "recordings", label: "Recordings", words: "look at raw signals, import more" },
    item,
    { part: "table", label: "Table", words: "sort, filter, brush" },
    impacts ? { part: "laws", label: "Laws", words: "which law fits best" } : null,
    { part: "regress", label: "Regression", words: "results against what varied" },
    { part: "surface", label: "Surface", words: "factors, optimum and its family" },
    kind === "drop" ? { part: "calibrate", label: "Calibration", words: "the law of a drop rig" } : null,
    { part: "report", label: "Report", words: "figures, methods, tables" },
  ];
  return all.filter((link) => link !== null);
}

/** Why campaigns of a kind do not have a view; `null` where they have it. */
export function whyNot(kind: string, part: Part): string | null {
  if (part === "import" || linksOf(kind).some((link) => link.part === part)) return null;
  switch (part) {
    case "impact":
      return "Single impacts are fitted live where a campaign has impacts of a pendulum or a carriage.";
    case "item":
      return "Impacts have a view of their own, with window, laws and residuals.";
    case "laws":
      return kind === "compression"
        ? "The laws of a slow compression stand side by side in its overview and with each compression; laws are ranked where impacts are fitted."
        : "Laws are compared where a law is fitted to each impact.";
    case "calibrate":
      return "A calibration needs drops on a force plate.";
    default:
      return "It has no meaning for them.";
  }
}

/** The row of impacts.csv that a result comes from: a tap is "ID tap 1", a bounce "ID, bounce 1". */
export function entryOf(ids: ReadonlySet<string>, result: string): string {
  if (ids.has(result)) return result;
  const entry = result.replace(/( tap|, bounce) \d+$/, "");
  return ids.has(entry) ? entry : result;
}
