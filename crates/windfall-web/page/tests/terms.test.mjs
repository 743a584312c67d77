import assert from "node:assert/strict";
import { test } from "node:test";
import { runnerImport } from "vite";

const load = async (path) => (await runnerImport(path, { configFile: false, logLevel: "error" })).module;
const { hasTerm, product, square, spelled, termsOf, toggledTerm } = await load("./src/lib/terms.ts");
const { latest } = await load("./src/lib/latest.ts");
const { telling } = await load("./src/lib/calibration.ts");

test("a formula is taken apart at its own plus signs only", () => {
  assert.deepEqual(termsOf("V*R + I(a + b) +`x + y`+ t "), ["V*R", "I(a + b)", "`x + y`", "t"]);
  assert.deepEqual(termsOf(" "), []);
});

test("terms are known in either order, and within a*b", () => {
  assert.ok(hasTerm("V*R + t", "R:V"));
  assert.ok(hasTerm("V*R + t", "V"));
  assert.ok(!hasTerm("V*R + t", "t:V"));
  assert.ok(!hasTerm("log(V)", "V"));
});

test("toggling twice brings back what was, and leaves what it does not know", () => {
  assert.equal(toggledTerm("V*R + poly(t, 2)", "V:R"), "V + R + poly(t, 2)");
  assert.equal(toggledTerm("V + R + poly(t, 2)", product("V", "R")), "V + R + poly(t, 2) + V:R");
  assert.equal(toggledTerm("V", "V"), "1");
  assert.equal(toggledTerm("1", square("V")), "V^2");
  assert.equal(spelled("drop height"), "`drop height`");
});

test("of many asks the newest is answered last, and those between are left out", async () => {
  const answers = [];
  const asked = [];
  const asking = latest((answer) => answers.push(answer), assert.fail, false);
  const work = (n) => async () => {
    asked.push(n);
    await new Promise((done) => setTimeout(done, 5));
    return n;
  };
  for (let n = 0; n < 5; n += 1) asking.ask(work(n));
  // As long as it takes on a busy machine.
  for (let n = 0; n < 200 && answers.length < 2; n += 1) await new Promise((done) => setTimeout(done, 10));
  assert.deepEqual(asked, [0, 4]);
  assert.deepEqual(answers, [0, 4]);
});

test("what is broken off for a newer ask is never shown", async () => {
  const answers = [];
  const asking = latest((answer) => answers.push(answer), assert.fail, true);
  for (let n = 0; n < 3; n += 1) {
    asking.ask(async () => {
      await new Promise((done) => setTimeout(done, 5 - n));
      return n;
    });
  }
  await new Promise((done) => setTimeout(done, 30));
  assert.deepEqual(answers, [2]);
});

test("the features that differ most along a family come first", () => {
  const member = (a, b) => ({ parameters: [a], law: "", heights: [{ height: 0.1, features: { peak: a, interval: b } }] });
  const [first, second] = telling([member(1, 10), member(2, 10), member(3, 11)], 5);
  assert.equal(first.feature, "peak");
  assert.deepEqual(first.percent, [-50, 0, 50]);
  assert.ok(Math.abs(second.spread - 10) < 1e-9);
  assert.equal(telling([], 5).length, 0);
});
