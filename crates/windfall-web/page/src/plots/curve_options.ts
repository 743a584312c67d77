/** How uPlot is set up for curves over one axis. */

import type uPlot from "uplot";
import { colour } from "../lib/theme.svelte";
import type { Range } from "./curves";

/** What a plot asks of the view that it belongs to. */
export interface Hooks {
  /** What is shown. */
  ranges: () => { x: Range; y: Range };
  labels: (of: "x" | "y", splits: number[]) => string[];
  drawClear: (of: uPlot) => void;
  draw: (of: uPlot) => void;
  setCursor: (of: uPlot) => void;
}

interface Given {
  /** Pixels. */
  width: number;
  height: number;
  /** Whether the title of x is left out. */
  bare: boolean;
  /** Plots with the same key share their cursor. */
  sync: string | undefined;
}

/** Options of a plot. They reach the view through `link` alone, so that what becomes of the
 *  plot after the view has gone does not keep the view. */
export function optionsOf(link: { hooks: Hooks | null }, { width, height, bare, sync }: Given): uPlot.Options {
  const grid = { stroke: () => colour("--figure-grid"), width: 1 };
  const font = "12px Helvetica, Arial, 'Liberation Sans', sans-serif";
  const axis = {
    stroke: () => colour("--figure-text"),
    grid,
    ticks: { ...grid, size: 5 },
    font,
    labelFont: font,
  };
  const range = (of: "x" | "y") => (): uPlot.Range.MinMax => {
    const { min, max } = link.hooks?.ranges()[of] ?? { min: 0, max: 1 };
    return [min, max];
  };
  const labels = (of: "x" | "y") => (_: uPlot, splits: number[]) => link.hooks?.labels(of, splits) ?? [];
  // Steps are up to 2.5 times as far apart as asked for; three of them are to fit.
  const apart = (least: number, usual: number) => (_of: uPlot, _axis: number, _min: number, _max: number, size: number) =>
    Math.max(least, Math.min(usual, size / 7.5));
  return {
    width: Math.max(width, 50),
    height,
    legend: { show: false },
    cursor: {
      drag: { x: false, y: false },
      points: { show: false },
      ...(sync === undefined ? {} : { sync: { key: sync, scales: ["x", null] } }),
    },
    scales: { x: { time: false, range: range("x") }, y: { range: range("y") } },
    series: [{}, { paths: () => null, points: { show: false } }],
    axes: [
      { ...axis, size: bare ? 30 : 34, space: apart(38, 50), ...(bare ? {} : { label: "x", labelSize: 18 }), values: labels("x") },
      { ...axis, size: 52, label: "y", labelSize: 18, space: apart(15, 34), values: labels("y") },
    ],
    padding: [8, 14, 0, 0],
    hooks: {
      drawClear: [(of) => link.hooks?.drawClear(of)],
      draw: [(of) => link.hooks?.draw(of)],
      setCursor: [(of) => link.hooks?.setCursor(of)],
    },
  };
}
