import assert from "node:assert/strict";
import { test } from "node:test";
import { runnerImport } from "vite";

const load = async (path) => (await runnerImport(path, { configFile: false, logLevel: "error" })).module;
const scale = await load("./src/plots/scale.ts");
const { valueAt } = await load("./src/plots/grid.ts");
const surface = await load("./src/plots/surface3d.ts");
const { evaluate } = await load("./src/lib/polynomial.ts");

const range = (from, to, count) =>
  Array.from({ length: count }, (_, i) => from + ((to - from) * i) / (count - 1));

function gridOf(of, xs, ys) {
  return { x: xs, y: ys, values: ys.flatMap((y) => xs.map((x) => of(x, y))) };
}

test("values between points of a grid are bilinear, and there are none outside", () => {
  const grid = gridOf((x, y) => x * y, [10, 20], [1, 2, 3]);
  assert.equal(valueAt(grid, 15, 2.5), 37.5);
  assert.ok(Number.isNaN(valueAt(grid, 25, 2)));
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
  // Never fewer than three, wherever the ends lie and however few are asked for.
  for (let at = 0; at < 400; at += 1) {
    const low = (at - 200) * 0.37;
    for (const width of [0.013, 0.7, 1.01, 2.9, 49, 777]) {
      for (const kind of low > 0 ? ["linear", "log"] : ["linear"]) {
        for (const count of [3, 4, 6]) {
          const found = scale.ticks({ kind, domain: [low, low + width], range: [0, 100] }, count);
          assert.ok(found.length >= 3 && found.length <= 4 * count, `${kind} ${low} ${width}: ${found}`);
          assert.ok(found.every((t) => t >= low - 1e-9 * width && t <= low + width * (1 + 1e-9)));
        }
      }
    }
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

test("an item is picked by its part of a list, ends beyond the ends", () => {
  const list = ["a", "b", "c"];
  assert.deepEqual([-3, 0, 0.3, 0.6, 1, 2].map((part) => scale.pick(list, part)), ["a", "a", "b", "b", "c", "c"]);
});
