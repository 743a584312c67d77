import assert from "node:assert/strict";
import { test } from "node:test";
import { runnerImport } from "vite";

const table = (await runnerImport("./src/lib/table.ts", { configFile: false, logLevel: "error" })).module;

const campaign = {
  specimens: { columns: ["id", "variety", "mass_g"], rows: [["s1", "Fuji", "201.5"], ["s2", "Gala", ""]] },
  impacts: { columns: ["id", "specimen", "file", "level"], rows: [["i2", "s1", "a.csv", "low"], ["i10", "s2", "b.csv", "high"]] },
};
const outcome = (id, specimen, group, k) => ({
  id, specimen, group, law: "hertz",
  parameters: { k: { value: k, low: k - 1, high: k + 1, unit: "N/m^1.5", sd: 0.5, held: false } },
  derived: { restitution: 0.4, rebound_velocity: null },
  findings: [{ code: "clipped", message: "" }],
});
const results = { outcome: { impacts: [outcome("i10", "s2", "Gala", 5), outcome("i2", "s1", "Fuji", 7)] } };
const made = table.resultTable(campaign, results);

test("results are joined with what the tables say of impact and specimen", () => {
  const [first, second] = made.rows;
  assert.equal(first.cells.get("specimens.csv variety"), "Gala");
  assert.equal(first.cells.get("specimens.csv mass_g"), null);
  assert.equal(second.cells.get("specimens.csv mass_g"), 201.5);
  assert.equal(second.cells.get("impacts.csv level"), "low");
  assert.deepEqual(first.spreads.get("k"), { sd: 0.5, interval: [4, 6] });
  assert.equal(first.cells.get("rebound_velocity"), null);
  const units = Object.fromEntries(made.columns.map((c) => [c.key, c.unit]));
  assert.equal(units["k"], "N/m^1.5");
  assert.equal(units["rebound_velocity"], "m/s");
  assert.deepEqual(made.groups, ["Gala", "Fuji"]);
});

test("documents of other kinds have their values, units and words", () => {
  const documents = { outcome: { impacts: [{
    id: "d1", specimen: "s1", group: null, law: "drop", words: { bounces: "7", reason: "end" }, parameters: {},
    derived: { bounces: { value: 7, sd: null, low: null, high: null, unit: "1" }, mass: { value: 0.005, sd: 1e-5, low: 0.004, high: 0.006, unit: "kg" } },
    findings: [],
  }] } };
  const { rows, columns } = table.resultTable(campaign, documents);
  assert.equal(rows[0].cells.get("bounces"), 7);
  assert.equal(rows[0].cells.get("reason"), "end");
  assert.equal(columns.find((c) => c.key === "mass").unit, "kg");
  assert.equal(columns.find((c) => c.key === "bounces").unit, "");
});

test("no results: no rows, and no failure", () => {
  assert.equal(table.resultTable(campaign, null).rows.length, 0);
  assert.equal(table.resultTable(campaign, { outcome: null }).rows.length, 0);
});

test("sorting is by number or by name with its numbers, empty cells last both ways", () => {
  const ids = (rows) => rows.map((row) => row.id);
  assert.deepEqual(ids(table.sorted(made.rows, "id", false)), ["i2", "i10"]);
  assert.deepEqual(ids(table.sorted(made.rows, "k", true)), ["i2", "i10"]);
  assert.deepEqual(ids(table.sorted(made.rows, "specimens.csv mass_g", false)), ["i2", "i10"]);
  assert.deepEqual(ids(table.sorted(made.rows, "specimens.csv mass_g", true)), ["i2", "i10"]);
});

test("filters by words, groups and ranges", () => {
  const some = (change) => table.filtered(made.rows, { ...table.noFilter(), ...change }).map((r) => r.id);
  assert.deepEqual(some({}), ["i10", "i2"]);
  assert.deepEqual(some({ text: "fuji  CLIP" }), ["i2"]);
  assert.deepEqual(some({ text: "fuji gala" }), []);
  assert.deepEqual(some({ groups: ["Gala"] }), ["i10"]);
  assert.deepEqual(some({ laws: ["tsuji"] }), []);
  assert.deepEqual(some({ ranges: { k: { low: 6, high: null } } }), ["i2"]);
  assert.deepEqual(some({ ranges: { "specimens.csv mass_g": { low: null, high: 900 } } }), ["i2"]);
});

test("mean and standard deviation with n − 1; none of nothing", () => {
  assert.deepEqual(table.described(made.rows, "k"), { n: 2, mean: 6, sd: Math.SQRT2 });
  assert.deepEqual(table.described(made.rows, "rebound_velocity"), { n: 0, mean: null, sd: null });
  assert.deepEqual(table.described(made.rows.slice(1), "k"), { n: 1, mean: 7, sd: null });
});

test("CSV has units, intervals, quotes, and no formulas for spreadsheets", () => {
  const columns = ["id", "k", "note"].map((key) => made.columns.find((c) => c.key === key) ?? { key, label: key, unit: "", numbers: false, from: "result" });
  const row = { ...made.rows[1], cells: new Map(made.rows[1].cells).set("note", '=1+"a", b') };
  assert.equal(table.csvOf(columns, [row]), 'id,k (N/m^1.5),k sd,k low,k high,note\r\ni2,7,0.5,6,8,"\'=1+""a"", b"\r\n');
});

test("formulas in CSV get an apostrophe, numbers none", () => {
  const column = made.columns.find((c) => c.key === "id");
  for (const [cell, written] of [
    ["=1+1", "'=1+1"], ["@SUM(A1)", "'@SUM(A1)"], ["-2+3", "'-2+3"], ["＝1", "'＝1"], [" =1", "' =1"],
    ["\t=1", "\"'\t=1\""], ["'=1", "''=1"], ["-", "'-"], ["-1.5", "-1.5"], ["+3", "+3"], ["1e-3", "1e-3"],
    ["-inf", "-inf"], ["'tis", "'tis"], ["'-1.5", "'-1.5"], ["a=b", "a=b"], ["a;b", '"a;b"'],
  ]) {
    const row = { ...made.rows[0], cells: new Map([["id", cell]]), spreads: new Map() };
    assert.equal(table.csvOf([column], [row]), `${column.key}\r\n${written}\r\n`);
  }
});

test("only whole numbers of text are numbers", () => {
  assert.equal(table.numberOf(" -1.5e-3 "), -0.0015);
  for (const text of ["", "1,5", "0x10", "Infinity", "1 2", "12a"]) assert.equal(table.numberOf(text), null);
});

test("5000 rows are sorted and filtered within a frame or two", () => {
  const many = Array.from({ length: 5000 }, (_, i) => ({ ...made.rows[i % 2], key: String(i) }));
  const start = performance.now();
  table.sorted(table.filtered(many, { ...table.noFilter(), text: "clip" }), "id", true);
  assert.ok(performance.now() - start < 250);
});
