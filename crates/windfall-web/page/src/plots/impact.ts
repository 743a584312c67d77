/** Curves of a fitted impact, and what they show in words. */

import type { LiveOutcome } from "../api/types";
import { quantity } from "../lib/format";
import { QUANTITIES } from "../lib/names";
import type { Curve } from "./curves";

/** Dashes of the line of a law, so that laws differ in more than colour. */
export const dash = (law: number) => DASHES[law % DASHES.length]!;
const DASHES = [[], [9, 4], [3, 3], [12, 3, 3, 3], [1, 3], [16, 5]];

/** Number of the colour of what was measured. */
const MEASURED = 6;

export const PLOTTED = ["force", "displacement", "rate"] as const;
type Plotted = (typeof PLOTTED)[number];

export const unitOf = (name: string) => QUANTITIES[name]?.unit ?? "";
export const labelOf = (name: string) => QUANTITIES[name]?.label ?? name;
export const symbolOf = (name: string) => QUANTITIES[name]?.symbol ?? name;

const dots = (label: string, x: number[], y: number[], colour: number): Curve =>
  ({ label, x, y, style: "dots", colour, still: true });

/** A line for each law that has a motion. */
function lines(of: LiveOutcome, points: (motion: Motion) => { x: number[]; y: number[] }): Curve[] {
  return of.laws.flatMap((law, number): Curve[] =>
    law.motion
      ? [{ label: law.law, ...points(law.motion), style: "line", colour: number, dash: dash(number) }]
      : [],
  );
}

type Motion = NonNullable<LiveOutcome["laws"][number]["motion"]>;

/** A quantity over time, measured and under each law. */
export function curvesOf(of: LiveOutcome, name: Plotted): Curve[] {
  const measured = of.measured[name];
  return [
    ...(measured ? [dots("measured", measured.time, measured.value, MEASURED)] : []),
    ...lines(of, (motion) => ({ x: motion.time, y: motion[name] })),
  ];
}

/** Force over displacement, measured and under each law. */
export function loop(of: LiveOutcome): Curve[] {
  const measured = measuredLoop(of);
  return [...(measured ? [dots("measured", measured.x, measured.y, MEASURED)] : []), ...lines(of, contactOf)];
}

interface Loop {
  onset: number;
  end: number;
  x: number[];
  y: number[];
}

/** Measured loops, which stay while the fit changes. */
const loops = new WeakMap<LiveOutcome["measured"], Loop>();

/** Measured force over measured displacement, at the times of the one with fewer samples. */
function measuredLoop({ measured, onset, end }: LiveOutcome): Loop | null {
  const known = loops.get(measured);
  if (known?.onset === onset && known.end === end) return known;
  const [force, displacement] = [measured["force"], measured["displacement"]];
  if (!force || !displacement) return null;
  const [few, many, forceIsFew] =
    force.time.length < displacement.time.length
      ? ([force, displacement, true] as const)
      : ([displacement, force, false] as const);
  const other = interpolate(many.time, many.value, few.time);
  const within = few.time.map((time) => time >= onset && time <= end);
  const pick = (values: number[]) => values.filter((_, at) => within[at]);
  const found = { onset, end, x: pick(forceIsFew ? other : few.value), y: pick(forceIsFew ? few.value : other) };
  loops.set(measured, found);
  return found;
}

/** The loop of a motion: from the last moment without force before its peak to the
 *  first after it. */
function contactOf({ displacement, force }: Motion) {
  const peak = force.reduce((best, value, at) => (value > force[best]! ? at : best), 0);
  let [first, last] = [peak, peak];
  while (first > 0 && force[first]! > 0) first--;
  while (last < force.length - 1 && force[last]! > 0) last++;
  return { x: displacement.slice(first, last + 1), y: force.slice(first, last + 1) };
}

function interpolate(times: number[], values: number[], at: number[]): number[] {
  let low = 0;
  return at.map((time) => {
    while (low < times.length - 2 && times[low + 1]! < time) low++;
    const [t0, t1] = [times[low]!, times[low + 1] ?? times[low]!];
    const part = t1 > t0 ? (time - t0) / (t1 - t0) : 0;
    return values[low]! + part * ((values[low + 1] ?? values[low]!) - values[low]!);
  });
}

/** Residuals of one law, by its number, or of all for −1. */
export function residuals(of: LiveOutcome, name: string, shown: number): Curve[] {
  return of.laws.flatMap((law, number): Curve[] => {
    const left = law.residuals[name];
    return left && (number === shown || shown === -1 || of.laws.length === 1)
      ? [dots(law.law, left.time, left.value, number)]
      : [];
  });
}

/** What the curves of a quantity show. */
export function summary(of: LiveOutcome, name: Plotted): string {
  const parts = curvesOf(of, name)
    .filter((curve) => curve.y.length > 0)
    .map((curve) => {
      let peak = 0;
      for (let at = 1; at < curve.y.length; at++) if (curve.y[at]! > curve.y[peak]!) peak = at;
      return `${curve.label}: largest ${quantity(curve.y[peak], unitOf(name))} at ${quantity(curve.x[peak], "s")}`;
    });
  return `${labelOf(name)} over time. ${parts.join("; ")}. Contact from ${quantity(of.onset, "s")} to ${quantity(of.end, "s")}.`;
}

/** What the residuals of a quantity show. */
export function residualSummary(of: LiveOutcome, name: string): string {
  const parts = of.laws.flatMap((law) => {
    const left = law.outcome?.residuals[name];
    return left
      ? [`${law.law}: root mean square ${quantity(left.rms, unitOf(name))}, noise ${quantity(left.noise, unitOf(name))}`]
      : [];
  });
  return `Residuals of the ${labelOf(name).toLowerCase()}. ${parts.join("; ")}.`;
}
