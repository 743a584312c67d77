/** Scales between values and places on the screen, and ticks that people read. */

export type ScaleKind = "linear" | "log";

export interface Scale {
  kind: ScaleKind;
  /** Values at the ends. */
  domain: [number, number];
  /** Places at the ends; px. */
  range: [number, number];
}

/** Smallest and largest finite value; `null` where there is none. */
export function extent(values: Iterable<number | null | undefined>): [number, number] | null {
  let low = Infinity;
  let high = -Infinity;
  for (const value of values) {
    if (value === null || value === undefined || !Number.isFinite(value)) continue;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return low <= high ? [low, high] : null;
}

/** A domain with room at both ends; of one value, a domain around it. */
export function padded(
  [low, high]: [number, number],
  part = 0.05,
  kind: ScaleKind = "linear",
): [number, number] {
  if (kind === "log" && low > 0) {
    const [a, b] = padded([Math.log10(low), Math.log10(high)], part);
    return [10 ** a, 10 ** b];
  }
  const width = high - low;
  // Values equal but for rounding have no width.
  if (width <= 1e-12 * Math.max(Math.abs(low), Math.abs(high))) {
    const room = Math.abs(low) * 0.05 || 1;
    return [low - room, high + room];
  }
  return [low - part * width, high + part * width];
}

/** The item of an evenly spaced list at a part between 0 and 1. */
export function pick<T>(list: T[], part: number): T {
  const last = list.length - 1;
  return list[Math.round(Math.min(Math.max(part, 0), 1) * last)]!;
}

/** Place of a value; px. Values without a logarithm lie at the low end. */
export function place(scale: Scale, value: number): number {
  const [from, to] = scale.range;
  return from + part(scale, value) * (to - from);
}

function part({ kind, domain: [low, high] }: Scale, value: number): number {
  if (kind === "linear") return (value - low) / (high - low);
  if (!(value > 0)) return 0;
  return Math.log(value / low) / Math.log(high / low);
}

/** Value at a place. */
export function value(scale: Scale, at: number): number {
  const [from, to] = scale.range;
  const [low, high] = scale.domain;
  const along = (at - from) / (to - from);
  return scale.kind === "linear" ? low + along * (high - low) : low * (high / low) ** along;
}

/** Round step near `width / count`: 1, 2 or 5 times a power of ten. */
function roundStep(width: number, count: number): number {
  const raw = width / Math.max(count, 1);
  const power = 10 ** Math.floor(Math.log10(raw));
  const lead = raw / power;
  return power * (lead < 1.5 ? 1 : lead < 3.5 ? 2 : lead < 7.5 ? 5 : 10);
}

/** Fewest ticks of an axis: two could not be told from those of a logarithm. */
const FEWEST = 3;

/** Values for ticks within a domain, about `count` of them and at least three. */
export function ticks(scale: Scale, count: number): number[] {
  const [low, high] = scale.domain;
  if (!(high > low) || !Number.isFinite(high - low)) return [];
  // A part of a decade has too few round powers.
  const isLog = scale.kind === "log" && logTicks(low, high, count + 8).length >= FEWEST;
  const of = isLog ? logTicks : linearTicks;
  // More are asked for until there are enough; steps grow finer by half at the most.
  let found = of(low, high, count);
  for (let more = count + 1; found.length < FEWEST && more <= count + 8; more += 1) found = of(low, high, more);
  return found;
}

function linearTicks(low: number, high: number, count: number): number[] {
  const step = roundStep(high - low, count);
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  // Multiples of a step like 0.1 carry rounding, which labels would show.
  const digits = Math.max(0, Math.ceil(-Math.log10(step)) + 1);
  const found = [];
  for (let i = first; i <= last; i += 1) found.push(digits > 15 ? i * step : Number((i * step).toFixed(digits)));
  return found;
}

function logTicks(low: number, high: number, count: number): number[] {
  const decades = Math.log10(high / low);
  if (decades < 0.7) return linearTicks(low, high, count);
  const leads = decades > 3 ? [1] : decades > 1.5 ? [1, 3] : [1, 2, 5];
  const stride = Math.max(1, Math.ceil(decades / count));
  const found = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); power += 1) {
    if (power % stride !== 0) continue;
    for (const lead of leads) {
      const tick = Number(`${lead}e${power}`);
      if (tick >= low * (1 - 1e-9) && tick <= high * (1 + 1e-9)) found.push(tick);
    }
  }
  return found;
}

const SUPERSCRIPTS = "⁰¹²³⁴⁵⁶⁷⁸⁹";

/** "−4", as in 10⁻⁴, for the shared power of an axis. */
export function superscript(power: number): string {
  const digits = [...String(Math.abs(power))].map((digit) => SUPERSCRIPTS[Number(digit)]);
  return (power < 0 ? "⁻" : "") + digits.join("");
}

interface TickLabels {
  labels: string[];
  /** Power of ten by which all labels are to be multiplied; 0: none. */
  power: number;
}

/** Labels with as many digits as tell the ticks apart, and a common power of ten
 *  where plain numbers would be long. */
export function tickLabels(scale: Scale, values: number[]): TickLabels {
  if (scale.kind === "log") return { labels: values.map(shortNumber), power: 0 };
  const largest = Math.max(...values.map(Math.abs), 0);
  const order = largest > 0 ? Math.floor(Math.log10(largest)) : 0;
  const power = order >= 4 || order <= -3 ? order - (((order % 3) + 3) % 3) : 0;
  const step = values.length > 1 ? Math.abs(values[1]! - values[0]!) : largest || 1;
  const unit = 10 ** power;
  const digits = Math.min(12, Math.max(0, -Math.floor(Math.log10(step / unit) + 1e-9)));
  const labels = values.map((v) => (v / unit).toFixed(digits).replace(/^-(?=0(\.0*)?$)/, "").replace("-", "−"));
  return { labels, power };
}

/** A tick of a logarithmic axis: plain near one, else a power of ten. */
function shortNumber(tick: number): string {
  if (tick === 0) return "0";
  const power = Math.floor(Math.log10(Math.abs(tick)) + 1e-9);
  if (power >= -3 && power <= 4) return String(Number(tick.toPrecision(3))).replace("-", "−");
  const lead = Number((tick / 10 ** power).toPrecision(2));
  return `${lead === 1 ? "" : `${lead}·`}10${superscript(power)}`;
}
