import assert from "node:assert/strict";
import { test } from "node:test";
import { runnerImport } from "vite";

const load = async (path) => (await runnerImport(path, { configFile: false, logLevel: "error" })).module;
const scale = await load("./src/plots/scale.ts");
const contour = await load("./src/plots/contour.ts");
const surface = await load("./src/plots/surface3d.ts");
const { evaluate } = await load("./src/plots/polynomial.ts");
const { colourOf } = await load("./src/plots/colour.ts");

const range = (from, to, count) =>
  Array.from({ length: count }, (_, i) => from + ((to - from) * i) / (count - 1));

function gridOf(of, xs, ys) {
  return { xs, ys, values: ys.flatMap((y) => xs.map((x) => of(x, y))) };
}

test("the contour of x² + y² at r² is one closed circle", () => {
  const grid = gridOf((x, y) => x * x + y * y, range(-1, 1, 41), range(-1, 1, 41));
  for (const r of [0.3, 0.55, 0.9]) {
    const lines = contour.contourLines(grid, r * r);
    assert.equal(lines.length, 1);
    const [line] = lines;
    assert.deepEqual(line[0], line.at(-1));
    // A secant of a cell of width h is off by h²/(8 r) at most.
    const tolerance = 0.05 ** 2 / (8 * r) + 1e-12;
    for (const [x, y] of line) {
      assert.ok(Math.abs(Math.hypot(x, y) - r) < tolerance, `${Math.hypot(x, y)} is not ${r}`);
    }
    // Once around: the area of the polygon is that of the circle.
    let area = 0;
    for (let i = 1; i < line.length; i += 1) {
      area += (line[i - 1][0] * line[i][1] - line[i][0] * line[i - 1][1]) / 2;
    }
    assert.ok(Math.abs(Math.abs(area) / (Math.PI * r * r) - 1) < 0.01);
  }
});

test("the contour of a plane is a line from edge to edge, and a saddle has two branches", () => {
  const plane = gridOf((x, y) => x + 2 * y, range(0, 1, 9), range(0, 1, 9));
  const [line, ...others] = contour.contourLines(plane, 1.03);
  assert.equal(others.length, 0);
  for (const [x, y] of line) assert.ok(Math.abs(x + 2 * y - 1.03) < 1e-12);
  const saddle = gridOf((x, y) => x * y, range(-1, 1, 20), range(-1, 1, 20));
  assert.equal(contour.contourLines(saddle, 0.1).length, 2);
  assert.equal(contour.contourLines(saddle, 5).length, 0);
});

test("cells without values break a contour and spoil nothing", () => {
  const holed = gridOf((x, y) => (x > 0.4 && x < 0.6 ? NaN : y), range(0, 1, 11), range(0, 1, 11));
  const lines = contour.contourLines(holed, 0.55);
  assert.equal(lines.length, 2);
  assert.ok(lines.flat(2).every(Number.isFinite));
});

test("a table of points becomes a grid whatever its order; a gap is refused", () => {
  const rows = [];
  for (const y of [1, 2, 3]) for (const x of [10, 20]) rows.push([x, 7, y, x * y]);
  const shuffled = [3, 0, 5, 1, 4, 2].map((i) => rows[i]);
  const grid = contour.gridOf(shuffled, 0, 2, 3);
  assert.deepEqual(grid, { xs: [10, 20], ys: [1, 2, 3], values: [10, 20, 20, 40, 30, 60] });
  assert.equal(contour.gridOf(rows.slice(1), 0, 2, 3), null);
  assert.equal(contour.valueAt(grid, 15, 2.5), 37.5);
  assert.ok(Number.isNaN(contour.valueAt(grid, 25, 2)));
});

test("painting goes from far to near, and a turn brings the back to the front", () => {
  const grid = gridOf((x, y) => x + y, range(0, 1, 5), range(0, 1, 5));
  for (const azimuth of [0, 1, 2.5, 4]) {
    const painted = surface.quads(grid, { azimuth, elevation: 0.5 }, [0, 2]);
    assert.equal(painted.length, 16);
    for (let i = 1; i < painted.length; i += 1) assert.ok(painted[i - 1].depth >= painted[i].depth);
  }
  const front = surface.project({ azimuth: 0, elevation: 0 }, [0, 0.5, 0]).depth;
  const turned = surface.project({ azimuth: Math.PI, elevation: 0 }, [0, 0.5, 0]).depth;
  assert.ok(Math.abs(front + turned) < 1e-12 && front > 0);
  // From above the height does not show, and from the side it is upright.
  const above = surface.project({ azimuth: 0.3, elevation: Math.PI / 2 }, [0.1, 0.2, 0.4]);
  assert.ok(Math.abs(above.y - surface.project({ azimuth: 0.3, elevation: Math.PI / 2 }, [0.1, 0.2, 0]).y) < 1e-12);
  assert.ok(Math.abs(surface.project({ azimuth: 0.3, elevation: 0 }, [0, 0, 0.5]).y + 0.5) < 1e-12);
});

test("ticks are round, lie within, and their labels tell them apart", () => {
  const linear = (low, high) => ({ kind: "linear", domain: [low, high], range: [0, 100] });
  assert.deepEqual(scale.ticks(linear(0, 1), 5), [0, 0.2, 0.4, 0.6, 0.8, 1]);
  assert.deepEqual(scale.ticks(linear(-0.31, 0.29), 3), [-0.2, 0, 0.2]);
  for (const [low, high] of [[0, 1e-7], [394000, 395000], [-3e9, 5e8], [0.9999, 1.0001], [1e-3, 1e6]]) {
    const at = scale.ticks(linear(low, high), 5);
    assert.ok(at.length >= 2 && at.length <= 12, `${at}`);
    assert.ok(at.every((t) => t >= low - 1e-9 * (high - low) && t <= high + 1e-9 * (high - low)));
    const { labels } = scale.tickLabels(linear(low, high), at);
    assert.equal(new Set(labels).size, labels.length, labels.join(" "));
    assert.ok(labels.every((label) => label.length <= 9), labels.join(" "));
  }
  const log = { kind: "log", domain: [0.05, 3e6], range: [0, 100] };
  assert.deepEqual(scale.ticks(log, 10), [0.1, 1, 10, 100, 1e3, 1e4, 1e5, 1e6]);
  assert.equal(scale.place(log, 0), 0);
  assert.deepEqual(scale.ticks(linear(3, 3), 5), []);
});

test("a scale and its inverse agree", () => {
  for (const kind of ["linear", "log"]) {
    const of = { kind, domain: [2, 5000], range: [310, 12] };
    for (const v of [2, 7, 444, 5000]) {
      assert.ok(Math.abs(scale.value(of, scale.place(of, v)) / v - 1) < 1e-12);
    }
  }
  assert.deepEqual(scale.extent([NaN, 3, null, -1, Infinity]), [-1, 3]);
  assert.equal(scale.extent([null, NaN]), null);
  const [low, high] = scale.padded([5, 5]);
  assert.ok(low < 5 && high > 5);
});

test("a polynomial in actual units is the fitted one, and other terms are refused", () => {
  const terms = [
    { name: "(Intercept)", coefficient: 2 },
    { name: "k", coefficient: 3 },
    { name: "k:e", coefficient: -1 },
    { name: "e^2", coefficient: 0.5 },
    { name: "k^2:`drop height`", coefficient: 4 },
  ];
  assert.equal(evaluate(terms, ["k", "e", "drop height"], [2, 3, 0.1]), 2 + 6 - 6 + 4.5 + 1.6);
  assert.equal(evaluate([{ name: "log(k)", coefficient: 1 }], ["k"], [2]), null);
});

test("colours grow lighter from end to end", () => {
  const lightness = ([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b;
  const all = range(0, 1, 50).map((part) => lightness(colourOf(part)));
  for (let i = 1; i < all.length; i += 1) assert.ok(all[i] > all[i - 1]);
  assert.deepEqual(colourOf(-3), colourOf(0));
});
