/** Marks of points: groups differ in shape as well as in colour. */

/** Series that have colours of their own; further ones repeat them with other marks. */
const SERIES = 7;

const SHAPES: ((x: number, y: number, r: number) => string)[] = [
  (x, y, r) => `M${x - r},${y}a${r},${r} 0 1,0 ${2 * r},0a${r},${r} 0 1,0 ${-2 * r},0Z`,
  (x, y, r) => `M${x - r * 0.9},${y - r * 0.9}h${r * 1.8}v${r * 1.8}h${-r * 1.8}Z`,
  (x, y, r) => `M${x},${y - r * 1.2}L${x + r * 1.1},${y + r * 0.8}H${x - r * 1.1}Z`,
  (x, y, r) => `M${x},${y - r * 1.3}L${x + r * 1.1},${y}L${x},${y + r * 1.3}L${x - r * 1.1},${y}Z`,
  (x, y, r) => `M${x},${y + r * 1.2}L${x + r * 1.1},${y - r * 0.8}H${x - r * 1.1}Z`,
  (x, y, r) =>
    `M${x - r * 0.4},${y - r * 1.2}h${r * 0.8}v${r * 0.8}h${r * 0.8}v${r * 0.8}h${-r * 0.8}v${r * 0.8}h${-r * 0.8}v${-r * 0.8}h${-r * 0.8}v${-r * 0.8}h${r * 0.8}Z`,
];

const round = (v: number) => Math.round(v * 10) / 10;

/** Outline of the mark of a group, for the `d` of a path. */
export function mark(group: number, x: number, y: number, size: number): string {
  return SHAPES[group % SHAPES.length]!(round(x), round(y), size);
}

/** Number of the colour of a group, from 1. */
export function seriesOf(group: number): number {
  return (group % SERIES) + 1;
}
