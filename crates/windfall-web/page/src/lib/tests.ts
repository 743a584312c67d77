/** Numbers of statistical tests as people read them. */

import { number } from "./format";

/** Smaller probabilities are only said to be small. */
const SMALLEST = 1e-4;

export const probability = (p: number | null | undefined): string =>
  p === null || p === undefined || Number.isNaN(p) ? "–" : p < SMALLEST ? "< 0.0001" : number(p, 2);

/** Degrees of freedom: whole ones without decimals. */
export const degrees = (df: number | null | undefined): string =>
  df !== null && df !== undefined && Number.isInteger(df) ? String(df) : number(df, 3);
