/** The polynomial that a fitted surface is, in actual units. */

import type { ActualTerm } from "../api/types";

/** Value of a polynomial; `null` where a term is none of powers of the factors.
 *
 *  * `terms`: named "(Intercept)", "k", "k:e", "k^2:e", with the names of the factors */
export function evaluate(
  terms: ActualTerm[],
  factors: string[],
  settings: number[],
): number | null {
  let sum = 0;
  for (const { name, coefficient } of terms) {
    const product = name === "(Intercept)" ? 1 : productOf(name, factors, settings);
    if (product === null) return null;
    sum += coefficient * product;
  }
  return sum;
}

function productOf(name: string, factors: string[], settings: number[]): number | null {
  let product = 1;
  for (const piece of name.split(":")) {
    const caret = piece.lastIndexOf("^");
    const [base, power] =
      caret > 0 ? [piece.slice(0, caret), Number(piece.slice(caret + 1))] : [piece, 1];
    const place = factors.indexOf(base.replace(/^`(.*)`$/, "$1"));
    if (place < 0 || !Number.isInteger(power)) return null;
    product *= settings[place]! ** power;
  }
  return product;
}
