/** The types of the page are those of the interface. */

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";
import { FILE, types } from "../types.mjs";

test("src/api/types.ts is what the program describes", async () => {
  const same = (await readFile(FILE, "utf8")) === (await types());
  assert.ok(same, "src/api/types.ts is stale: run scripts/test-page --update, and commit it");
});
