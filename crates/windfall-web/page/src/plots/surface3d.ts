/** A surface over a grid, seen from a side: which quadrilaterals to paint, where, and
 *  in which order. Pure; `Surface3d.svelte` paints. */

import type { Grid } from "./grid";

export interface View {
  /** Turn about the upright axis; rad. */
  azimuth: number;
  /** Height of the eye above the base; rad. */
  elevation: number;
}

interface Projected {
  /** To the right; the unit cube fills about -1 to 1. */
  x: number;
  /** Downwards. */
  y: number;
  /** Away from the eye. */
  depth: number;
}

/** A place in the cube with ends -0.5 and 0.5, as the eye sees it. Parallel lines stay
 *  parallel, so that heights can be compared. */
export function project(view: View, [x, y, z]: [number, number, number]): Projected {
  const [s, c] = [Math.sin(view.azimuth), Math.cos(view.azimuth)];
  const right = x * c - y * s;
  const away = x * s + y * c;
  const [up, level] = [Math.sin(view.elevation), Math.cos(view.elevation)];
  return { x: right, y: -(z * level + away * up), depth: away * level - z * up };
}

interface Quad {
  corners: [Projected, Projected, Projected, Projected];
  /** Mean value of the corners. */
  value: number;
  depth: number;
}

/** Quadrilaterals of a surface, those farthest away first.
 *
 *  * `range`: values at the bottom and the top of the cube */
export function quads(grid: Grid, view: View, range: [number, number]): Quad[] {
  const { x: xs, y: ys, values } = grid;
  const width = xs.length;
  const points = values.map((value, at) => {
    const x = along(xs, xs[at % width]!);
    const y = along(ys, ys[Math.floor(at / width)]!);
    return project(view, [x, y, height(value, range)]);
  });
  const found: Quad[] = [];
  for (let j = 0; j + 1 < ys.length; j += 1) {
    for (let i = 0; i + 1 < width; i += 1) {
      const at = j * width + i;
      const around = [at, at + 1, at + width + 1, at + width] as const;
      if (!around.every((place) => Number.isFinite(values[place]))) continue;
      const corners = around.map((place) => points[place]!) as Quad["corners"];
      found.push({
        corners,
        value: around.reduce((sum, place) => sum + values[place]!, 0) / 4,
        depth: corners.reduce((sum, corner) => sum + corner.depth, 0) / 4,
      });
    }
  }
  return found.sort((a, b) => b.depth - a.depth);
}

/** Place of a value between the ends of an axis, -0.5 to 0.5. */
export function along(places: number[], at: number): number {
  const [first, last] = [places[0]!, places[places.length - 1]!];
  return (at - first) / (last - first) - 0.5;
}

/** Height in the cube of a value of the response. */
export function height(value: number, [low, high]: [number, number]): number {
  return high > low ? (value - low) / (high - low) - 0.5 : 0;
}
