// Time from the start of `windfall serve` in an empty directory to its first answer:
// node bench/page_start.mjs PROGRAM

import { spawn } from "node:child_process";
import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";

const STARTS = 20;
const directory = await mkdtemp(join(tmpdir(), "windfall-start-"));
const times = [];
for (let start = 0; start < STARTS; start++) {
  const begin = performance.now();
  const server = spawn(process.argv[2], ["serve", directory, "--no-open", "--port", "0"]);
  const address = await new Promise((tell) => server.stdout.once("data", (line) => tell(`${line}`.trim())));
  const { origin, searchParams } = new URL(address);
  const headers = { Authorization: `Bearer ${searchParams.get("token")}` };
  const answer = await fetch(origin, { headers });
  if (!answer.ok) throw new Error(`the page: ${answer.status}`);
  await answer.text();
  times.push(performance.now() - begin);
  server.kill();
  await new Promise((ended) => server.once("exit", ended));
}
await rm(directory, { recursive: true });
times.sort((a, b) => a - b);
console.log(
  `start to first answer, ${STARTS} times: median ${times[STARTS / 2].toFixed(0)} ms, ` +
    `slowest ${times[STARTS - 1].toFixed(0)} ms`,
);
if (times[STARTS / 2] > 100) process.exit(1);
