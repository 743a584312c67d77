/** Numbers, differences and options as the page writes them. */

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { runnerImport } from "vite";

const load = async (path) => (await runnerImport(path, { configFile: false, logLevel: "error" })).module;
const {
  bytes,
  chiSquare,
  estimate,
  integer,
  interval,
  number,
  percent,
  plusMinus,
  probability,
  pValue,
  quantity,
  quantityPlusMinus,
  unitText,
} = await load("./src/lib/format.ts");
const { plainText, values } = await load("./src/lib/spreadsheet.ts");
const { filledIn, namesColumn, placeholders } = await load("./src/lib/placeholders.ts");
const { entryOf, linksOf, whyNot } = await load("./src/lib/kinds.ts");
const { firstGuess } = await load("./src/lib/surface.ts");
const { changes, difference } = await load("./src/lib/diff.ts");
const { listOf, listText, rangeOf, rangeText } = await load("./src/lib/held.ts");
const { rangesOf, rangesText } = await load("./src/lib/table.ts");
const { responseOf, responseText } = await load("./src/lib/surface.ts");
const { changesOf, draftOf, heldParameters } = await load("./src/lib/options.ts");
const { webm } = await load("./src/scene/webm.ts");

/** With plain spaces and minus, so that the expectations can be read. */
const plain = (text) => text.replace(/[\u202f\u00a0]/g, " ").replaceAll("\u2212", "-");

test("numbers, probabilities and units are those of the program", () => {
  const cases = JSON.parse(readFileSync(new URL("../../../files/src/text/number_cases.json", import.meta.url)));
  const writers = {
    number,
    digits: number,
    value_and_sd: plusMinus,
    percent,
    probability,
    p_value: pValue,
    chi_square: chiSquare,
    unit: unitText,
  };
  assert.deepEqual(Object.keys(cases), Object.keys(writers));
  for (const [name, rows] of Object.entries(cases)) {
    for (const row of rows) {
      // The page parts thousands, the program does not.
      const written = plain(writers[name](...row.slice(0, -1)).replace(/(\d)\u202f(?=\d)/g, "$1"));
      assert.equal(written, row.at(-1), `${name} of ${row.slice(0, -1)}`);
    }
  }
});

test("copied cells are numbers for a spreadsheet", () => {
  for (const [shown, copied] of [
    [number(746129.4), "746100"],
    [number(-1.5e-9, 2), "-1.5e-9"],
    [number(null), ""],
    ["12\u202f300\u202fN", "12300 N"],
    ["k (N/m¹˙⁵)", "k (N/m¹˙⁵)"],
  ]) {
    assert.equal(plainText(shown), copied);
  }
  assert.equal(values(0.1 + 0.2, null, "a\tb"), "0.30000000000000004\t\ta b");
});

test("numbers have the digits that were asked for", () => {
  for (const [value, digits, words] of [
    [0, 4, "0"],
    [1234.5678, 4, "1235"],
    [12345.678, 3, "12 300"],
    [0.00123456, 4, "0.001235"],
    [9.99996, 4, "10.00"],
    [-0.5, 2, "-0.50"],
    [1.5e-9, 2, "1.5·10⁻⁹"],
    [3.2e12, 2, "3.2·10¹²"],
    [NaN, 4, "–"],
    [null, 4, "–"],
    [Infinity, 4, "∞"],
  ]) {
    assert.equal(plain(number(value, digits)), words);
  }
  assert.equal(plain(integer(10_000_000)), "10 000 000");
});

test("a deviation has two digits, and its value goes as far", () => {
  for (const [value, sd, words] of [
    [809333.57, 1863.4, "809 300 ± 1900"],
    [1525.6559, 2.587, "1525.7 ± 2.6"],
    [0.38802610, 0.00017742, "0.38803 ± 0.00018"],
    [0.5, 0.0999, "0.50 ± 0.10"],
    [-8.5408e-7, 6.1519e-7, "(-8.5 ± 6.2)·10⁻⁷"],
    [3, null, "3.000"],
    [NaN, 1, "–"],
  ]) {
    assert.equal(plain(plusMinus(value, sd)), words);
  }
  const of = { value: 809333.57, sd: 1863, low: 805677.87, high: 812989.27, unit: "N/m^1.5", held: false };
  assert.equal(plain(interval(of)), "805 680 … 812 990");
  assert.equal(interval({ ...of, held: true }), "–");
  for (const [value, words] of [[0.5, "0.5"], [1.5, "1.5"], [1e-6, "1·10⁻⁶"], [753599, "753 599"]]) {
    assert.equal(plain(estimate({ ...of, value, unit: "1", held: true })), `${words} (held)`);
  }
});

test("quantities have prefix and unit", () => {
  assert.equal(plain(quantity(0.004160883, "s")), "4.161 ms");
  assert.equal(plain(quantity(0.38802, "m/s")), "0.3880 m/s");
  assert.equal(plain(quantity(200_000, "Hz", 3)), "200 kHz");
  assert.equal(plain(quantityPlusMinus(0.0030035, 1.7e-6, "s")), "3.0035 ± 0.0017 ms");
  assert.equal(plain(percent(0.356)), "36 %");
  assert.equal(plain(bytes(34_000)), "34.0 kB");
  assert.equal(unitText("m/s^2"), "m/s²");
  assert.equal(unitText("N/m^1.5"), "N/m¹˙⁵");
  assert.equal(unitText("N/m^1.508292561"), "N/m¹˙⁵⁰⁸");
});

test("a difference turns one text into the other, with no more changes than needed", () => {
  const before = "a\nb\nc\nd";
  const after = "a\nc\nx\nd";
  const lines = difference(before, after);
  const side = (without) => lines.filter((line) => line.sign !== without).map((line) => line.text).join("\n");
  assert.equal(side("+"), before);
  assert.equal(side("-"), after);
  assert.equal(lines.filter((line) => line.sign !== " ").length, 2);
  const long = difference(Array.from({ length: 40 }, (_, n) => n).join("\n"), "new\n" + Array.from({ length: 40 }, (_, n) => n).join("\n"));
  assert.deepEqual(changes(long).map((line) => line?.text ?? null), ["new", "0", "1", null]);
});

test("only options that differ from the campaign are asked for", () => {
  const view = {
    laws: ["kuwabara-kono"],
    options: {
      quantities: ["displacement", "force"],
      weights: "inverse-variance",
      noise: "automatic",
      intervals: "asymptotic",
      onset: "auto",
      initial_velocity: "auto",
      displacement_offset: "auto",
      end: "force-zero",
      free: [],
    },
  };
  const draft = draftOf(view);
  assert.deepEqual(changesOf(draft, view), {});
  draft.laws.push("hertz");
  draft.weights = "inverse-mean";
  assert.deepEqual(changesOf(draft, view), { laws: ["kuwabara-kono", "hertz"], weights: "inverse-mean" });
  assert.deepEqual(view.laws, ["kuwabara-kono"]);
});

test("parameters with a value are those that can be freed", () => {
  const laws = [
    { name: "power-law", parameters: [{ name: "k", default: null }, { name: "n", default: 1.5 }] },
    { name: "hertz", parameters: [{ name: "k", default: null }] },
  ];
  assert.deepEqual(heldParameters(["power-law"], laws), ["n"]);
  assert.deepEqual(heldParameters(["hertz(k=3)"], laws), ["k"]);
  assert.deepEqual(heldParameters(["hertz"], laws), []);
});

test("names of columns may hold what impacts.csv fills in", () => {
  assert.deepEqual(placeholders("{run}: Force (N) {level}"), ["run", "level"]);
  assert.deepEqual(placeholders("Force (N)"), []);
  assert.ok(namesColumn("{run}: Force (N)", "Run 1: Force (N)"));
  assert.ok(!namesColumn("{run}: Force (N)", ": Force (N)"));
  assert.ok(!namesColumn("{run}: Force (N)", "Run 1: Force _N_"));
  assert.ok(namesColumn("a[1].b\\{x}", "a[1].b\\7"));
  assert.ok(!namesColumn("", "Force"));
});

test("names of channels are filled in from the row", () => {
  const cells = { run: "3", side: "left" };
  assert.equal(filledIn("{run}: Force ({side})", (name) => cells[name] ?? ""), "3: Force (left)");
  assert.equal(filledIn("force_N", () => "?"), "force_N");
});

test("a tap and a bounce belong to the recording that they come from", () => {
  const ids = new Set(["a", "a tap 1", "b"]);
  for (const [result, entry] of [
    ["b tap 12", "b"],
    ["b, bounce 3", "b"],
    // The table may have such an id itself.
    ["a tap 1", "a tap 1"],
    ["c tap 1", "c tap 1"],
  ]) {
    assert.equal(entryOf(ids, result), entry);
  }
});

test("every kind says which views it has, or why not", () => {
  const all = ["overview", "recordings", "import", "impact", "item", "table", "laws", "regress", "surface", "calibrate", "report"];
  for (const kind of ["impacts", "compression", "relaxation", "acoustic", "repeats", "drop"]) {
    const parts = linksOf(kind).map((link) => link.part);
    assert.equal(parts.includes("impact"), kind === "impacts");
    assert.equal(parts.includes("item"), kind !== "impacts");
    for (const part of all) assert.equal(whyNot(kind, part) === null, part === "import" || parts.includes(part));
  }
});

test("a surface begins with what its rows can tell", () => {
  const table = (names, rows) => ({
    file: "t.csv",
    columns: names.map((name) => ({ name, numbers: true })),
    rows: rows.map((row) => row.map(String)),
  });
  const levels = [-1, 0, 1];
  const squares = levels.flatMap((a) => levels.map((b) => [a, b, a + b * b + 0.1 * a * b]));
  assert.deepEqual(firstGuess(table(["a", "b", "y"], squares)), { factors: ["a", "b"], response: "y", model: "quadratic" });
  // Two levels bend nowhere.
  const corners = [-1, 1].flatMap((a) => [-1, 1].flatMap((b) => [0, 1].map((n) => [a, b, a + b + 0.1 * n + 0.01 * a])));
  assert.deepEqual(firstGuess(table(["a", "b", "y"], corners)), { factors: ["a", "b"], response: "y", model: "2fi" });
  // What differs in every row is no factor, and noise of arithmetic no level.
  const measured = [1, 2, 3, 4, 5, 6].map((i) => [i, i * i, i % 2 ? 0.02 : 0.0199999999999998]);
  assert.equal(firstGuess(table(["k", "c", "rate"], measured)).factors.length, 0);
  // Rows with empty cells tell nothing.
  const gaps = squares.map(([a, b, y], row) => [a, b, row < 2 ? y : ""]);
  assert.equal(firstGuess(table(["a", "b", "y"], gaps)).factors.length, 0);
});

test("what an address holds is what was put into it", () => {
  for (const list of [[], ["hertz"], ["power-law(n=1, k=2)", "a;b", "100 %", "%3B"]]) {
    assert.deepEqual(listOf(listText(list) ?? undefined), list);
  }
  assert.deepEqual(rangeOf(rangeText({ min: -0.0123, max: 4e-7 })), { min: -0.0123, max: 4e-7 });
  for (const text of [undefined, "", "1", "2..1", "1..1", "a..b", "1..2..3", "..2", "1..Infinity"]) {
    assert.equal(rangeOf(text), null, text);
  }
  const ranges = { k: { low: 1, high: null }, "impacts.csv a:b": { low: null, high: -2.5 } };
  assert.deepEqual(rangesOf(rangesText(ranges)), ranges);
  const models = ["linear", "quadratic"];
  for (const goal of [{ wanted: "", target: "", low: "", high: "" }, { wanted: "target", target: "11", low: "", high: "12" }]) {
    for (const [model, terms] of [["linear", ""], ["", "A + B^2"]]) {
      const response = { name: "force_N", model, terms, goal };
      assert.deepEqual(responseOf(responseText(response), models), response);
    }
  }
});

test("differences of long texts are found between their common ends", () => {
  const lines = Array.from({ length: 200_000 }, (_, i) => `row ${i}`);
  const other = lines.with(100_000, "another");
  const found = difference(lines.join("\n"), other.join("\n"));
  assert.equal(found.length, 200_001);
  assert.deepEqual(
    found.filter(({ sign }) => sign !== " "),
    [{ sign: "-", text: "row 100000" }, { sign: "+", text: "another" }],
  );
  assert.deepEqual(difference("a\na", "a"), [{ sign: " ", text: "a" }, { sign: "-", text: "a" }]);
});

test("a film of half an hour is written", () => {
  const pictures = Array.from({ length: 54_000 }, (_, k) => {
    return { time: Math.round((k * 1000) / 30), whole: k % 30 === 0, data: new Uint8Array(10) };
  });
  assert.ok(webm(pictures, [1280, 1000], 1.8e6).size > 54_000 * 10);
});
