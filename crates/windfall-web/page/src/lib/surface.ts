/** What `windfall surface --format json` gives (crates/windfall/src/surface_outcome.rs). */

import type { Finding } from "../api";
import { evaluate, type ActualTerm } from "../plots/polynomial";

export interface Factor {
  letter: string;
  name: string;
  /** Actual value of coded 0. */
  centre: number;
  /** Actual step of coded 1. */
  half_range: number;
  lowest: number;
  highest: number;
}

export interface SurfaceTerm {
  term: string;
  name: string;
  coded: number;
  se: number;
  low: number;
  high: number;
  actual: number;
  ss: number | null;
  df: number | null;
  f: number | null;
  p: number | null;
  vif: number | null;
}

export interface SumOfSquares {
  ss: number;
  df: number;
  f?: number;
  p?: number;
}

export interface SurfaceModel {
  response: string;
  terms: SurfaceTerm[];
  actual_terms: ActualTerm[];
  model: SumOfSquares;
  residual: SumOfSquares;
  total: SumOfSquares;
  r2: number;
  r2_adjusted: number;
  r2_predicted: number;
  adequate_precision: number;
  sigma: number;
  cv_percent: number;
  anova_type: string;
  lack_of_fit: { lack: SumOfSquares; pure_error: SumOfSquares } | null;
  canonical: {
    shape: string;
    actual: number[];
    distance: number;
    inside: boolean;
    value: number;
    eigenvalues: number[];
  } | null;
}

export interface Setting {
  actual: number[];
  responses: { response: string; predicted: number; low: number; high: number; desirability: number | null }[];
  desirability: number;
}

export interface Family {
  dimension: number;
  along: string;
  from: number;
  to: number;
  members: Setting[];
}

export interface SurfaceOutcome {
  factors: Factor[];
  coding: string;
  responses: SurfaceModel[];
  optimum: Setting | null;
  family: Family | null;
  findings: Finding[];
  grid: { columns: string[]; rows: (number | null)[][] } | null;
  command: string;
}

/** Value of a fitted response at settings of the factors. */
export const valueOf = (model: SurfaceModel, factors: Factor[], settings: number[]): number | null =>
  evaluate(model.actual_terms, factors.map((factor) => factor.name), settings);

/** What happens to a response when one factor moves and the others stay.
 *
 *  Deviations are in coded units from the settings, within the range of the runs. */
export function perturbation(model: SurfaceModel, factors: Factor[], settings: number[], of: number): [number, number][] {
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
