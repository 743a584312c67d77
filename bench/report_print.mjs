// The report of 500 impacts in print: WINDFALL=PROGRAM node bench/report_print.mjs [PDF FOLDER]

import { execFileSync } from "node:child_process";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { carriage, launch, scratch, windfall } from "../crates/windfall-web/page/tests/helpers.mjs";

const place = await scratch();
const many = await carriage(place.directory, "many", 500);
await windfall("fit", many);
const start = performance.now();
await windfall("report", many);
const took = (performance.now() - start) / 1000;
let missed = 0;
function tell(what, value, limit, right) {
  console.log(`${what}: ${value} (limit ${limit})`);
  if (!right) missed += 1;
}
tell("report of 500 impacts", `${took.toFixed(1)} s`, "10 s", took < 10);

const browser = await launch();
for (const format of ["A4", "Letter"]) {
  const page = await browser.newPage();
  await page.goto(pathToFileURL(join(many, "report/report.html")).href);
  const pdf = join(process.argv[2] ?? place.directory, `report-${format}.pdf`);
  await page.pdf({ path: pdf, format, preferCSSPageSize: false });
  await page.close();
  const pages = Number(/^Pages:\s+(\d+)/m.exec(execFileSync("pdfinfo", [pdf], { encoding: "utf8" }))[1]);
  tell(`${format}, pages`, pages, 20, pages < 20);
  // In thirds of a point.
  const told = execFileSync("pdftohtml", ["-xml", "-i", "-stdout", "-zoom", "3", pdf], { encoding: "utf8", maxBuffer: 1 << 28 });
  const sizes = new Map([...told.matchAll(/<fontspec id="(\d+)" size="(\d+)"/g)].map(([, id, size]) => [id, Number(size) / 3]));
  const letters = new Map();
  for (const [, font, text] of told.matchAll(/<text [^>]*font="(\d+)"[^>]*>(.*?)<\/text>/g)) {
    const size = sizes.get(font);
    letters.set(size, (letters.get(size) ?? "") + text.replace(/<[^>]*>/g, "") + " ");
  }
  for (const [size, text] of [...letters].sort(([one], [other]) => one - other)) {
    console.log(`  ${size.toFixed(1)} pt: ${text.slice(0, 60).trim()} …`);
  }
  // Exponents, which are nothing but numbers.
  const words = [...letters].filter(([, text]) => /[^\d.\s−-]/.test(text)).map(([size]) => size);
  tell(`${format}, smallest letters`, `${Math.min(...words).toFixed(1)} pt`, "7 pt", Math.min(...words) >= 7);
}
await browser.close();
await place.remove();
process.exit(missed > 0 ? 1 : 0);
