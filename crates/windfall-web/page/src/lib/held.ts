/** State of views as words of an address, and back. Pure. */

import type { Range } from "../plots/curves";

/** Digits of a time in an address: one sample in ten million. */
const DIGITS = 9;

const brief = (value: number) => String(Number(value.toPrecision(DIGITS)));

/** "0.01..0.02"; `null` for the whole. */
export const rangeText = (range: Range | null): string | null =>
  range === null ? null : `${brief(range.min)}..${brief(range.max)}`;

/** The range of such a text; `null` where it is none. */
export function rangeOf(text: string | undefined): Range | null {
  const [min, max, ...rest] = (text ?? "").split("..").map(numberOf);
  return rest.length === 0 && min != null && max != null && min < max ? { min, max } : null;
}

/** A number of an address; `null` where it is none. */
export function numberOf(text: string | undefined): number | null {
  const value = Number(text);
  return text === undefined || text.trim() === "" || !Number.isFinite(value) ? null : value;
}

export const numberText = (value: number | null): string | null => (value === null ? null : brief(value));

/** Entries with semicolons between them: commas are in laws (`power-law(n=1, k=2)`). */
export const listText = (list: readonly string[]): string | null =>
  list.length === 0 ? null : list.map((entry) => entry.replace(/[%;]/g, encodeURIComponent)).join(";");
export function listOf(text: string | undefined): string[] {
  return text ? text.split(";").map((entry) => entry.replace(/%(25|3B)/g, decodeURIComponent)) : [];
}

export const yes = (on: boolean): string | null => (on ? "yes" : null);

/** What a link named and is not there any more, in a sentence for the user. */
export const gone = (things: string[]): string =>
  `The address names what is not there any more, which was left out: ${things.join(", ")}.`;
