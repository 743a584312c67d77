/** Response surfaces at settings of their factors, and what is wanted of them. */

import type { FactorOutcome, SurfaceModel } from "../api/types";
import { evaluate } from "./polynomial";

/** Value of a fitted response at settings of the factors. */
export const valueOf = (model: SurfaceModel, factors: FactorOutcome[], settings: number[]): number | null =>
  evaluate(model.actual_terms, factors.map((factor) => factor.name), settings);

/** What happens to a response when one factor moves and the others stay.
 *
 *  Deviations are in coded units from the settings, within the range of the runs. */
export function perturbation(model: SurfaceModel, factors: FactorOutcome[], settings: number[], of: number): [number, number][] {
  const STEPS = 40;
  const { lowest, highest, half_range: half } = factors[of]!;
  const points: [number, number][] = [];
  for (let i = 0; i <= STEPS; i += 1) {
    const at = lowest + ((highest - lowest) * i) / STEPS;
    const found = valueOf(model, factors, settings.with(of, at));
    if (found !== null) points.push([(at - settings[of]!) / half, found]);
  }
  return points;
}

/** What is wanted of a response, as it is asked for. */
export interface Goal {
  wanted: "" | "target" | "maximum" | "minimum" | "range";
  target: string;
  low: string;
  high: string;
}

export const noGoal = (): Goal => ({ wanted: "", target: "", low: "", high: "" });

/** "force_N = target 11.3, low 9"; `null` where nothing is wanted, or not yet said. */
export function goalText(response: string, { wanted, target, low, high }: Goal): string | null {
  if (wanted === "" || (wanted === "target" && target.trim() === "")) return null;
  const ends = [
    ...(low.trim() === "" ? [] : [`low ${low.trim()}`]),
    ...(high.trim() === "" ? [] : [`high ${high.trim()}`]),
  ];
  const wish = wanted === "target" ? `target ${target.trim()}` : wanted;
  return `${response} = ${[wish, ...ends].join(", ")}`;
}
