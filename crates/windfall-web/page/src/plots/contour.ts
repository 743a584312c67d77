/** Lines of equal value on a rectangular grid, by marching squares. */

export interface Grid {
  /** Places of the columns, ascending. */
  xs: number[];
  /** Places of the rows, ascending. */
  ys: number[];
  /** Values, the first factor varying fastest. */
  values: number[];
}

export type Point = [number, number];

/** Grid of a table with one row for each point, in any order of rows.
 *
 *  * `x`, `y`, `of`: places of the columns
 *
 *  `null` where the rows do not fill a grid. */
export function gridOf(rows: (number | null)[][], x: number, y: number, of: number): Grid | null {
  const distinct = (column: number) =>
    [...new Set(rows.map((row) => row[column] as number))].sort((a, b) => a - b);
  const xs = distinct(x);
  const ys = distinct(y);
  if (xs.length < 2 || ys.length < 2 || xs.length * ys.length !== rows.length) return null;
  const columns = new Map(xs.map((v, i) => [v, i]));
  const lines = new Map(ys.map((v, i) => [v, i]));
  const values = new Array<number>(rows.length).fill(NaN);
  for (const row of rows) {
    const at = lines.get(row[y] as number)! * xs.length + columns.get(row[x] as number)!;
    values[at] = row[of] ?? NaN;
  }
  return { xs, ys, values };
}

/** Value between the points of a grid, bilinear; NaN outside. */
export function valueAt({ xs, ys, values }: Grid, x: number, y: number): number {
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

/** Lines on which the grid has a value; each a chain of points, closed ones with the
 *  first point again at their end. */
export function contourLines(grid: Grid, level: number): Point[][] {
  return chains(segments(grid, level));
}

/** Edges of cells are numbered, so that segments of neighbours meet exactly. */
interface Segment {
  from: number;
  to: number;
  start: Point;
  stop: Point;
}

function segments({ xs, ys, values }: Grid, level: number): Segment[] {
  const width = xs.length;
  const across = (i: number, j: number) => 2 * (j * width + i);
  const upward = (i: number, j: number) => 2 * (j * width + i) + 1;
  const between = (a: number, b: number) => (level - a) / (b - a);
  const found: Segment[] = [];
  for (let j = 0; j + 1 < ys.length; j += 1) {
    for (let i = 0; i + 1 < width; i += 1) {
      const at = j * width + i;
      const [a, b, c, d] = [values[at]!, values[at + 1]!, values[at + width + 1]!, values[at + width]!];
      if (![a, b, c, d].every(Number.isFinite)) continue;
      const [x0, x1, y0, y1] = [xs[i]!, xs[i + 1]!, ys[j]!, ys[j + 1]!];
      // Sides of the cell in turn: below, right, above, left.
      const side = [
        { key: across(i, j), cut: a >= level !== b >= level, at: (): Point => [x0 + between(a, b) * (x1 - x0), y0] },
        { key: upward(i + 1, j), cut: b >= level !== c >= level, at: (): Point => [x1, y0 + between(b, c) * (y1 - y0)] },
        { key: across(i, j + 1), cut: d >= level !== c >= level, at: (): Point => [x0 + between(d, c) * (x1 - x0), y1] },
        { key: upward(i, j), cut: a >= level !== d >= level, at: (): Point => [x0, y0 + between(a, d) * (y1 - y0)] },
      ].filter((s) => s.cut);
      const join = (one: number, other: number) => {
        const [s, t] = [side[one]!, side[other]!];
        found.push({ from: s.key, to: t.key, start: s.at(), stop: t.at() });
      };
      if (side.length === 2) join(0, 1);
      else if (side.length === 4) {
        // A saddle: the mean tells which corners belong together.
        const together = (a + b + c + d) / 4 >= level === a >= level;
        if (together) {
          join(0, 1);
          join(2, 3);
        } else {
          join(0, 3);
          join(1, 2);
        }
      }
    }
  }
  return found;
}

function chains(all: Segment[]): Point[][] {
  const meeting = new Map<number, number[]>();
  const note = (key: number, place: number) => {
    const known = meeting.get(key);
    if (known) known.push(place);
    else meeting.set(key, [place]);
  };
  all.forEach((segment, place) => {
    note(segment.from, place);
    note(segment.to, place);
  });
  const used = new Array<boolean>(all.length).fill(false);
  const walk = (key: number, points: Point[]) => {
    for (;;) {
      const next = meeting.get(key)!.find((place) => !used[place]);
      if (next === undefined) return;
      used[next] = true;
      const segment = all[next]!;
      const ahead = segment.from === key;
      points.push(ahead ? segment.stop : segment.start);
      key = ahead ? segment.to : segment.from;
    }
  };
  const lines: Point[][] = [];
  const start = (place: number) => {
    const segment = all[place]!;
    used[place] = true;
    const ahead: Point[] = [segment.start, segment.stop];
    walk(segment.to, ahead);
    const behind: Point[] = [];
    walk(segment.from, behind);
    lines.push([...behind.reverse(), ...ahead]);
  };
  all.forEach((_, place) => {
    if (!used[place]) start(place);
  });
  return lines;
}
