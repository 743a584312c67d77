import { number } from "../lib/format";
import { tickLabels, type Scale } from "../plots/scale";

/** Labels of ticks that stand without a title of their own: whole numbers, not parts of a
 *  power of ten. */
export function wholeLabels(scale: Scale, ticks: number[]): string[] {
  const { labels, power } = tickLabels(scale, ticks);
  return power === 0 ? labels : ticks.map((tick) => number(tick, 3));
}
