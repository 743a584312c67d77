/** What a plot of curves is made of, and how one is drawn on a canvas. Pure but for the
 *  drawing itself. */

import { prefixOf, unitText } from "../lib/format";

export interface Curve {
  label: string;
  x: ArrayLike<number>;
  /** Of a band its lower edge. */
  y: ArrayLike<number>;
  /** Upper edge of a band. */
  high?: ArrayLike<number>;
  style: "dots" | "line" | "band";
  /** Number of the series' colour. */
  colour: number;
  dash?: number[];
  /** Whether it stays while other curves or shades move: it is then drawn once. */
  still?: boolean;
}

export interface Range {
  min: number;
  max: number;
}

export interface Shade {
  from: number;
  to: number;
  /** Variable of app.css. */
  colour: string;
}

export interface Axis {
  label: string;
  unit: string;
}

/** Smallest and largest of the numbers in `of` whose `at` lies in the range. */
export function extentOf(of: ArrayLike<number>, at?: ArrayLike<number>, range?: Range | null): Range {
  let min = Infinity;
  let max = -Infinity;
  for (let index = 0; index < of.length; index++) {
    if (at && range && (at[index]! < range.min || at[index]! > range.max)) continue;
    const value = of[index]!;
    if (value < min) min = value;
    if (value > max) max = value;
  }
  return { min, max };
}

export const union = (a: Range, b: Range): Range => ({
  min: Math.min(a.min, b.min),
  max: Math.max(a.max, b.max),
});

/** Whether two lists of curves draw the same. */
export function same(a: Curve[], b: Curve[]): boolean {
  return (
    a.length === b.length &&
    a.every((one, index) => {
      const other = b[index]!;
      return (
        one.x === other.x &&
        one.y === other.y &&
        one.high === other.high &&
        one.colour === other.colour &&
        one.style === other.style
      );
    })
  );
}

/** Ends moved outwards to round numbers, so that an axis stays while values move a little. */
export function round(of: Range): Range {
  const step = 10 ** Math.floor(Math.log10(of.max - of.min)) / 10;
  return { min: Math.floor(of.min / step) * step, max: Math.ceil(of.max / step) * step };
}

export const NOTHING: Range = { min: Infinity, max: -Infinity };

/** Factor and unit of an axis: its prefix follows from the largest number, so that labels
 *  are between 10 and 1000. */
export function scaled(axis: Axis, of: Range): [number, string] {
  if (!/^(s|m|N|J|V|m\/s)$/.test(axis.unit)) return [1, axis.unit];
  const [factor, letter] = prefixOf(Math.max(Math.abs(of.min), Math.abs(of.max)) / 1.5);
  return [factor, letter + axis.unit];
}

/** Title of an axis, with its unit. */
export function named(axis: Axis, of: Range): string {
  const unit = scaled(axis, of)[1];
  return unit === "" ? axis.label : `${axis.label} (${unitText(unit)})`;
}

/** Labels of ticks, in units of `factor`. */
export function ticks(splits: number[], factor: number): string[] {
  const step = splits.length > 1 ? Math.abs(splits[1]! - splits[0]!) / factor : 1;
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  // A step such as 2.5 needs one more.
  const exact = Math.abs(step * 10 ** decimals - Math.round(step * 10 ** decimals)) < 1e-6;
  return splits.map((value) => {
    const text = (value / factor).toFixed(Math.min(exact ? decimals : decimals + 1, 12));
    return Number(text) === 0 ? "0" : text.replace("-", "\u2212");
  });
}

/** What is shown on a canvas: ranges of both axes, and the size of the area; px. */
export interface Area {
  x: Range;
  y: Range;
  width: number;
  height: number;
  /** Pixels of the canvas per pixel of the page. */
  ratio: number;
}

/** Draws a curve with the corner of the plot's area at `left`, `top`. */
export function drawCurve(
  ctx: CanvasRenderingContext2D,
  curve: Curve,
  area: Area,
  paint: string,
  left: number,
  top: number,
): void {
  const { width, height, ratio } = area;
  const [x0, x1] = [area.x.min, area.x.max];
  const [y0, y1] = [area.y.min, area.y.max];
  const across = (value: number) => left + ((value - x0) / (x1 - x0)) * width;
  const up = (value: number) => top + ((y1 - value) / (y1 - y0)) * height;
  ctx.strokeStyle = paint;
  ctx.fillStyle = paint;
  if (curve.style === "dots") {
    const size = Math.round((curve.x.length > 1500 ? 2 : 3) * ratio);
    ctx.globalAlpha = curve.x.length > 500 ? 0.5 : 0.85;
    for (let index = 0; index < curve.x.length; index++) {
      const at = curve.x[index]!;
      if (at < x0 || at > x1) continue;
      const corner = [across(at) - size / 2, up(curve.y[index]!) - size / 2] as const;
      ctx.fillRect(Math.round(corner[0]), Math.round(corner[1]), size, size);
    }
    ctx.globalAlpha = 1;
    return;
  }
  ctx.beginPath();
  let pen = false;
  for (let index = 0; index < curve.x.length; index++) {
    const value = curve.y[index]!;
    if (!Number.isFinite(value)) pen = false;
    else if (pen) ctx.lineTo(across(curve.x[index]!), up(value));
    else {
      ctx.moveTo(across(curve.x[index]!), up(value));
      pen = true;
    }
  }
  if (curve.style === "band" && curve.high) {
    for (let index = curve.x.length - 1; index >= 0; index--) {
      ctx.lineTo(across(curve.x[index]!), up(curve.high[index]!));
    }
    ctx.closePath();
    ctx.globalAlpha = 0.75;
    ctx.fill();
    ctx.globalAlpha = 1;
  }
  ctx.lineWidth = (curve.style === "band" ? 1 : 2) * ratio;
  ctx.lineJoin = "round";
  ctx.setLineDash((curve.dash ?? []).map((length) => length * ratio));
  ctx.stroke();
  ctx.setLineDash([]);
}
