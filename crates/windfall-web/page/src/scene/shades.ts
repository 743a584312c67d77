/** What fruit of a scene can be coloured by. */

import type { FruitTotals, SceneView } from "../api/types";
import { PEAK, VELOCITY } from "./frames";

export interface Shade {
  key: "peak" | "speed" | "energy" | "bruise";
  /** In the list of choices. */
  name: string;
  /** What the colours mean, with its unit. */
  title: string;
  /** Unit as it is spoken. */
  unit: string;
  /** Value of the last colour, in that unit. */
  most: number;
  /** Value of a fruit, whose record begins at a place of the frame. */
  of: (fruit: number, frame: Float32Array, at: number) => number;
}

/** What a scene can be coloured by. Energies and bruises are those of the whole run. */
export function shades(view: SceneView, totals: FruitTotals | null): Shade[] {
  const found: Shade[] = [
    {
      key: "peak",
      name: "peak force",
      title: "Largest peak force of a contact so far (N)",
      unit: "newton",
      most: view.most,
      of: (_, frame, at) => frame[at + PEAK]!,
    },
    {
      key: "speed",
      name: "speed",
      title: "Speed (m/s)",
      unit: "metres per second",
      most: view.fastest,
      of: (_, frame, at) => Math.hypot(frame[at + VELOCITY]!, frame[at + VELOCITY + 1]!, frame[at + VELOCITY + 2]!),
    },
  ];
  const whole = (key: "energy" | "bruise", of: number[] | null | undefined, factor: number) => {
    if (!of) return null;
    const most = factor * of.reduce((a, b) => Math.max(a, b), 0);
    return { key, most: most > 0 ? most : 1, of: (fruit: number) => factor * (of[fruit - 1] ?? 0) };
  };
  const energy = whole("energy", totals?.absorbed_energy, 1e3);
  const bruise = whole("bruise", totals?.largest_bruise, 1e9);
  if (energy) {
    const title = "Energy absorbed by all contacts of the run (mJ)";
    found.push({ ...energy, name: "absorbed energy", title, unit: "millijoule" });
  }
  if (bruise) {
    const title = "Largest bruise at the end of the run (mm³)";
    found.push({ ...bruise, name: "bruise", title, unit: "cubic millimetres" });
  }
  return found;
}
