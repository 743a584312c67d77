/** Colours of values on a surface. */

/** Dark to light, even in lightness, so that the order is seen without hue.
 *
 *  Source: S. van der Walt, N. Smith (2015), map "viridis" (public domain), at
 *  ninths. */
const ANCHORS = [
  [68, 1, 84],
  [71, 45, 123],
  [59, 82, 139],
  [44, 114, 142],
  [33, 144, 141],
  [39, 173, 129],
  [92, 200, 99],
  [170, 220, 50],
  [253, 231, 37],
] as const;

export type Rgb = [number, number, number];

/** Colour of a part between 0 and 1. */
export function colourOf(part: number): Rgb {
  const last = ANCHORS.length - 1;
  const at = Math.min(Math.max(part, 0), 1) * last;
  const below = Math.min(Math.floor(at), last - 1);
  const [a, b] = [ANCHORS[below]!, ANCHORS[below + 1]!];
  return a.map((value, i) => Math.round(value + (at - below) * (b[i]! - value))) as Rgb;
}

export function css([r, g, b]: Rgb): string {
  return `rgb(${r} ${g} ${b})`;
}

/** Series that have colours of their own; further ones start again with other marks. */
export const SERIES = 7;
