/** Values on a rectangular grid. */

export interface Grid {
  /** First coordinates, rising. */
  x: number[];
  /** Second coordinates, rising. */
  y: number[];
  /** Values, the first coordinate varying fastest. */
  values: number[];
}

export type Point = [number, number];

/** Value between the points of a grid, bilinear; NaN outside. */
export function valueAt({ x: xs, y: ys, values }: Grid, x: number, y: number): number {
  const i = cell(xs, x);
  const j = cell(ys, y);
  if (i < 0 || j < 0) return NaN;
  const u = (x - xs[i]!) / (xs[i + 1]! - xs[i]!);
  const v = (y - ys[j]!) / (ys[j + 1]! - ys[j]!);
  const at = j * xs.length + i;
  const below = values[at]! * (1 - u) + values[at + 1]! * u;
  const above = values[at + xs.length]! * (1 - u) + values[at + xs.length + 1]! * u;
  return below * (1 - v) + above * v;
}

function cell(places: number[], at: number): number {
  const last = places.length - 1;
  if (!(at >= places[0]! && at <= places[last]!)) return -1;
  let low = 0;
  let high = last;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (places[middle]! <= at) low = middle;
    else high = middle;
  }
  return low;
}
