/** Numbers, units and names as people read them. */

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
};

const superscript = (exponent: number) =>
  [...String(exponent)].map((character) => SUPERSCRIPTS[character] ?? character).join("");

const exponentOf = (value: number) =>
  value === 0 ? 0 : Math.floor(Math.log10(Math.abs(value)) + 1e-12);

/** Decimals as written, with a real minus and thin spaces between thousands. */
function plain(value: number, decimals: number): string {
  const [whole = "", fraction] = Math.abs(value).toFixed(Math.min(Math.max(decimals, 0), 20)).split(".");
  const grouped = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, THIN) : whole;
  const text = fraction === undefined ? grouped : `${grouped}.${fraction}`;
  return value < 0 && /[1-9]/.test(text) ? MINUS + text : text;
}

/** A number with so many significant digits. */
export function number(value: number | null | undefined, digits = 4): string {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : `${MINUS}∞`;
  if (value === 0) return "0";
  const exponent = exponentOf(Number(value.toPrecision(digits)));
  if (exponent < -4 || exponent > 7) {
    const mantissa = value / 10 ** exponent;
    return `${plain(mantissa, digits - 1)}·10${superscript(exponent)}`;
  }
  return plain(rounded(value, digits - 1 - exponent), digits - 1 - exponent);
}

/** A whole number. */
export const integer = (value: number) => plain(value, 0);

const rounded = (value: number, decimals: number) =>
  decimals >= 0 ? value : Math.round(value / 10 ** -decimals) * 10 ** -decimals;

/** `value ± sd`, both to the second digit of the deviation. */
export function plusMinus(value: number | null | undefined, sd: number | null | undefined): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (sd === null || sd === undefined || !Number.isFinite(sd) || sd <= 0) return number(value, 5);
  const decimals = 1 - exponentOf(Number(sd.toPrecision(2)));
  const exponent = exponentOf(Math.max(Math.abs(value), sd));
  if (exponent < -4 || exponent > 7) {
    const scale = 10 ** exponent;
    const shown = Math.min(decimals + exponent, 15);
    return `(${plain(value / scale, shown)} ± ${plain(sd / scale, shown)})·10${superscript(exponent)}`;
  }
  return `${plain(rounded(value, decimals), decimals)} ± ${plain(rounded(sd, decimals), decimals)}`;
}

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
  const digits = width > 0 ? exponentOf(size) - exponentOf(width) + 3 : 5;
  const shown = Math.min(Math.max(digits, 3), 10);
  return `${number(of.low, shown)} … ${number(of.high, shown)}`;
}

export const percent = (part: number | null | undefined, digits = 2) =>
  part === null || part === undefined || !Number.isFinite(part)
    ? "–"
    : `${number(100 * part, digits)}${THIN}%`;

export const withUnit = (words: string, unit: string) =>
  words === "–" || unit === "" || unit === "1" ? words : `${words}${THIN}${unitText(unit)}`;

/** Units with raised whole exponents; others stay as they are typed, `m^1.5`, and an
 *  estimated one has as many digits as one reads. */
export function unitText(unit: string): string {
  const short = unit.replace(/\^(-?\d+\.\d{4,})/g, (_, exponent: string) => `^${Number(Number(exponent).toPrecision(4))}`);
  return short.replace(/\^(-?\d+)(?![\d.])/g, (_, exponent: string) => superscript(Number(exponent)));
}

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

export const count = (n: number, one: string, many = `${one}s`) => `${plain(n, 0)} ${n === 1 ? one : many}`;
