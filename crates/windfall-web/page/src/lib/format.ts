/** Numbers, probabilities and units as people read them, by the rule of
 *  `crates/numerics/src/written.rs`; both are held to the cases of
 *  `crates/files/src/text/number_cases.json`. The page differs in its typography alone: thin
 *  spaces between thousands and a true minus sign. */

import type { EstimateOutcome } from "../api/types";

const MINUS = "\u2212";
const THIN = "\u202f";
const SUPERSCRIPTS: Record<string, string> = {
  "-": "⁻",
  "0": "⁰",
  "1": "¹",
  "2": "²",
  "3": "³",
  "4": "⁴",
  "5": "⁵",
  "6": "⁶",
  "7": "⁷",
  "8": "⁸",
  "9": "⁹",
  ".": "˙",
};

/** Digits of a number without deviation, and of a deviation. */
const PLAIN_DIGITS = 4;
const SD_DIGITS = 2;

/** Powers of ten between which a number is written without one. */
const LEAST_POWER = -4;
const MOST_POWER = 6;

/** Most decimals of a number. */
const MOST_DECIMALS = 12;

/** Moves a number by less than its rounding, so that halves round away from zero. */
const HALVES = 1 + 1e-15;

const superscript = (exponent: number) =>
  [...String(exponent)].map((character) => SUPERSCRIPTS[character] ?? character).join("");

/** Power of ten of a number that is rounded to so many digits. */
const powerOf = (value: number, digits: number) => Number((value * HALVES).toExponential(digits - 1).split("e")[1]);

/** So many decimals, with a true minus and thin spaces between thousands; below zero they are
 *  whole digits that are rounded. */
function fixed(value: number, decimals: number): string {
  const unit = 10 ** -decimals;
  const shown =
    decimals >= 0
      ? (Math.abs(value) * HALVES).toFixed(Math.min(decimals, MOST_DECIMALS))
      : (Math.round(Math.abs(value) / unit) * unit).toFixed(0);
  const [whole = "", fraction] = shown.split(".");
  const grouped = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, THIN) : whole;
  const text = fraction === undefined ? grouped : `${grouped}.${fraction}`;
  return value < 0 && /[1-9]/.test(text) ? MINUS + text : text;
}

const isPlain = (power: number) => power >= LEAST_POWER && power <= MOST_POWER;

/** A number with so many significant digits; whole ones have all of theirs. */
export function number(value: number | null | undefined, digits = PLAIN_DIGITS): string {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : `${MINUS}∞`;
  if (value === 0) return "0";
  const power = powerOf(value, digits);
  if (!isPlain(power)) return `${fixed(value / 10 ** power, digits - 1)}·10${superscript(power)}`;
  // Whole numbers are counts, or were typed.
  if (Number.isInteger(value) && power >= digits) return fixed(value, 0);
  return fixed(value, digits - 1 - power);
}

/** A whole number. */
export const integer = (value: number) => fixed(value, 0);

/** `value ± sd`, both to the second digit of the deviation. */
export function plusMinus(value: number | null | undefined, sd: number | null | undefined): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (sd === null || sd === undefined || !Number.isFinite(sd) || sd <= 0) return number(value);
  const decimals = SD_DIGITS - 1 - powerOf(sd, SD_DIGITS);
  const power = powerOf(Math.max(Math.abs(value), sd), PLAIN_DIGITS);
  if (isPlain(power)) return `${fixed(value, decimals)} ± ${fixed(sd, decimals)}`;
  const shown = (size: number) => fixed(size / 10 ** power, decimals + power);
  return `(${shown(value)} ± ${shown(sd)})·10${superscript(power)}`;
}

/** A probability as a number alone: "0.034", "< 0.001". */
export const probability = (p: number | null | undefined): string =>
  p === null || p === undefined || Number.isNaN(p) ? "–" : p < 0.001 ? "< 0.001" : fixed(p, 3);

/** A probability with its symbol: "p = 0.034", "p < 0.001". */
export const pValue = (p: number | null | undefined): string => {
  const text = probability(p);
  return text.startsWith("<") ? `p ${text}` : `p = ${text}`;
};

/** Degrees of freedom: whole ones without decimals. */
export const degrees = (df: number | null | undefined): string =>
  df !== null && df !== undefined && Number.isInteger(df) ? String(df) : number(df);

/** A chi-square with its degrees of freedom and, where it is known, its probability. */
export const chiSquare = (statistic: number, df: number, p: number | null = null): string =>
  `χ²(${degrees(df)}) = ${number(statistic)}${p === null ? "" : `, ${pValue(p)}`}`;

/** `value ± sd unit` of an estimate; a held one says so. */
export function estimate(of: EstimateOutcome): string {
  // A held value was typed, with no more digits than it needs.
  const words = of.held ? `${held(of.value)} (held)` : plusMinus(of.value, of.sd);
  return withUnit(words, of.unit);
}

const held = (value: number) => {
  const same = (digits: number) => Number(value.toPrecision(digits)) === Number(value.toPrecision(6));
  return number(value, [1, 2, 3, 4, 5].find(same) ?? 6);
};

/** The 95 % interval of an estimate. */
export function interval(of: EstimateOutcome): string {
  if (of.held || of.low === null || of.high === null) return "–";
  // Enough digits to show its width.
  const width = Math.abs(of.high - of.low);
  const size = Math.max(Math.abs(of.low), Math.abs(of.high));
  const digits = width > 0 ? powerOf(size, PLAIN_DIGITS) - powerOf(width, SD_DIGITS) + 3 : 5;
  const shown = Math.min(Math.max(digits, 3), 10);
  return `${number(of.low, shown)} … ${number(of.high, shown)}`;
}

export const percent = (part: number | null | undefined, digits = 2) =>
  part === null || part === undefined || !Number.isFinite(part)
    ? "–"
    : `${number(100 * part, digits)}${THIN}%`;

export const withUnit = (words: string, unit: string) =>
  words === "–" || unit === "" || unit === "1" ? words : `${words}${THIN}${unitText(unit)}`;

/** A unit with raised exponents, of four digits at the most: "N/m¹˙⁵", "m/s²". */
export const unitText = (unit: string): string =>
  unit.replace(/\^(-?\d+(?:\.\d+)?)/g, (_, exponent: string) => superscript(Number(Number(exponent).toFixed(3))));

const PREFIXES: [number, string][] = [
  [1e9, "G"],
  [1e6, "M"],
  [1e3, "k"],
  [1, ""],
  [1e-3, "m"],
  [1e-6, "µ"],
  [1e-9, "n"],
];

/** Prefix that brings a size into 1 … 1000: its factor and letter. */
export function prefixOf(size: number): [number, string] {
  const magnitude = Math.abs(size);
  if (!Number.isFinite(magnitude) || magnitude === 0) return [1, ""];
  return PREFIXES.find(([factor]) => magnitude >= factor * 0.9995) ?? [1e-9, "n"];
}

/** A value with prefix and unit, such as "4.161 ms". Only for plain units. */
export function quantity(value: number | null | undefined, unit: string, digits = 4): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (!/^(s|m|m\/s|N|J|Hz|V|Pa|N s|m\/s\^2)$/.test(unit)) return withUnit(number(value, digits), unit);
  const [factor, letter] = unit === "m/s^2" || unit === "m/s" ? [1, ""] : prefixOf(value);
  return `${number(value / factor, digits)}${THIN}${letter}${unitText(unit)}`;
}

/** `value ± sd` with the prefix of the value. */
export function quantityPlusMinus(
  value: number | null | undefined,
  sd: number | null | undefined,
  unit: string,
): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (sd === null || sd === undefined || !(sd > 0)) return quantity(value, unit);
  const [factor, letter] = /^(s|m|N|J|N s)$/.test(unit) ? prefixOf(value) : [1, ""];
  return withUnit(plusMinus(value / factor, sd / factor), letter + unit);
}

/** Bytes, in the steps that file managers use. */
export function bytes(count: number): string {
  if (count < 1000) return `${count}${THIN}bytes`;
  const [factor, letter] = prefixOf(count);
  return `${number(count / factor, 3)}${THIN}${letter}B`;
}

/** A time as the store writes it (RFC 3339), for people. */
export function moment(time: string): string {
  const date = new Date(time);
  return Number.isNaN(date.getTime())
    ? time
    : date.toLocaleString(undefined, { dateStyle: "medium", timeStyle: "short" });
}

export const count = (n: number, one: string, many = `${one}s`) => `${integer(n)} ${n === 1 ? one : many}`;
