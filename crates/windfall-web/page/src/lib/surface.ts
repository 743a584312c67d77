/** Response surfaces at settings of their factors, and what is wanted of them. */

import type { DataTable, FactorOutcome, SurfaceModel } from "../api/types";
import { explaining } from "./columns";
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

/** Terms of the models of so many factors, with the constant. */
const TERMS: [string, (factors: number) => number][] = [
  ["quadratic", (n) => ((n + 1) * (n + 2)) / 2],
  ["2fi", (n) => 1 + (n * (n + 1)) / 2],
  ["linear", (n) => 1 + n],
];

/** Different values of a column in some rows, up to the noise of arithmetic. */
const levelsIn = (rows: string[][], place: number) =>
  new Set(rows.map((row) => Number(Number(row[place]).toPrecision(9)))).size;

/** A first guess of factors, response and model, which the rows of the table can tell: runs
 *  of a design have few levels of each factor, and responses behind the factors. */
export function firstGuess(table: DataTable): { factors: string[]; response: string | null; model: string } {
  const most = Math.max(7, table.rows.length / 3);
  const candidates = explaining(table).filter((column) => column.numbers);
  // What differs in nearly every row was not set to levels.
  const few = candidates
    .slice(0, -1)
    .filter(({ levels }) => levels <= most && 2 * levels <= table.rows.length);
  const response = candidates.find((column) => !few.includes(column));
  for (let n = Math.min(few.length, 4); response && n > 0; n -= 1) {
    const factors = few.slice(0, n).map(({ name }) => name);
    const places = [...factors, response.name].map((name) => table.columns.findIndex((column) => column.name === name));
    const whole = table.rows.filter((row) => places.every((place) => (row[place] ?? "") !== ""));
    const levels = places.slice(0, -1).map((place) => levelsIn(whole, place));
    if (levels.some((of) => of < 2)) continue;
    const bent = levels.every((of) => of > 2);
    const model = TERMS.find(([name, terms]) => whole.length > terms(n) && (bent || name !== "quadratic"));
    if (model) return { factors, response: response.name, model: model[0] };
  }
  return { factors: [], response: null, model: "quadratic" };
}

/** What is wanted of a response, as it is asked for. */
export interface Goal {
  wanted: "" | "target" | "maximum" | "minimum" | "range";
  target: string;
  low: string;
  high: string;
}

export const noGoal = (): Goal => ({ wanted: "", target: "", low: "", high: "" });

/** A response of a surface, as it is asked for. */
export interface Response {
  name: string;
  /** "linear", "quadratic", …, or "" for `terms`. */
  model: string;
  terms: string;
  goal: Goal;
}

/** "k~quadratic", or "k~quadratic~target~11~~" with what is wanted of it. */
export function responseText({ name, model, terms, goal }: Response): string {
  const wish = goal.wanted === "" ? [] : [goal.wanted, goal.target, goal.low, goal.high];
  return [name, model === "" ? terms : model, ...wish].join("~");
}

/** The response of such a text. */
export function responseOf(text: string, models: string[]): Response {
  const [name = "", model = "", wanted = "", target = "", low = "", high = ""] = text.split("~");
  const known = models.includes(model);
  const wishes: Goal["wanted"][] = ["target", "maximum", "minimum", "range"];
  const goal = { wanted: wishes.find((each) => each === wanted) ?? ("" as const), target, low, high };
  return { name, model: known ? model : "", terms: known ? "" : model, goal };
}

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
