/** Tables as text for a spreadsheet: cells parted by tabs, numbers as numbers. */

import { plainText } from "./spreadsheet";
import { notices } from "./state.svelte";
import { isFormula } from "./table";

/** Cells of a row that were asked for, each with what it gives. */
function cellsOf(row: HTMLTableRowElement): { given: string[]; span: number }[] {
  return [...row.cells].map((cell) => {
    const own = cell.dataset["copy"];
    const copy = cell.cloneNode(true) as HTMLElement;
    for (const line of copy.querySelectorAll("br")) line.replaceWith(" ");
    return { given: own === undefined ? [plainText(copy.textContent ?? "")] : own.split("\t"), span: cell.colSpan };
  });
}

/** A table, or some rows of it, as lines of cells parted by tabs; cells with a deviation that
 *  have no values of their own fill two columns. */
export function tableText(table: HTMLTableElement, rows: HTMLTableRowElement[] = [...table.rows]): string {
  const heads = new Set(table.tHead?.rows ?? []);
  const lines = rows.filter((row) => row.getAttribute("aria-hidden") !== "true").map((row) => ({ head: heads.has(row), cells: cellsOf(row) }));
  const columns = Math.max(0, ...lines.map((line) => line.cells.length));
  const parted = Array.from({ length: columns }, (_, place) => {
    const body = lines.filter((line) => !line.head).map((line) => line.cells[place]?.given ?? []);
    const single = body.every((given) => given.length < 2);
    return single && body.some(([text]) => /^-?[\d.]+(e-?\d+)? ± [\d.]/.test(text ?? ""));
  });
  const width = Array.from({ length: columns }, (_, place) =>
    parted[place] ? 2 : Math.max(1, ...lines.map((line) => (line.cells[place]?.span === 1 ? line.cells[place].given.length : 1))),
  );
  const safe = (cell: string) => (isFormula(cell) && !/^-[\d.]+ %$/.test(cell) ? `'${cell}` : cell);
  const filled = (given: string[], place: number, head: boolean): string[] => {
    let own = given;
    if (parted[place] && head) own = [(given[0] ?? "").replace(/\s*±.*$/, ""), "±"];
    else if (parted[place]) own = (given[0] ?? "").split(" ± ");
    return Array.from({ length: width[place] ?? 1 }, (_, i) => safe(own[i] ?? ""));
  };
  return lines
    .map(({ head, cells }) => cells.flatMap(({ given }, place) => filled(given, place, head)).join("\t"))
    .join("\n");
}

/** Puts a text on the clipboard; whether it is there. */
export async function copyText(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    // Without permission, or not on a secure origin.
    notices.error(new Error("the browser did not allow copying; select the table and copy it"));
    return false;
  }
}

/** A button at the end of a table that copies it whole, with all digits where its cells say them. */
export function copyable(node: HTMLElement) {
  const button = document.createElement("button");
  button.type = "button";
  button.className = "copy small";
  button.textContent = "Copy table";
  button.title = "For a spreadsheet: numbers as numbers";
  button.addEventListener("click", async () => {
    const tables = [...node.querySelectorAll("table")];
    const done = await copyText(tables.map((table) => tableText(table)).join("\n\n"));
    if (!done) return;
    button.textContent = "Copied";
    setTimeout(() => (button.textContent = "Copy table"), 2000);
  });
  node.append(button);
  return { destroy: () => button.remove() };
}

/** Rows of tables that are selected on the page, as a spreadsheet takes them; without tables, the
 *  selected words with plain numbers; `null` where nothing of it needs a change. */
function selectedText(selection: Selection): string | null {
  const range = selection.rangeCount > 0 ? selection.getRangeAt(0) : null;
  if (range === null || selection.isCollapsed) return null;
  const around = range.commonAncestorContainer;
  const element = around instanceof Element ? around : around.parentElement;
  const cell = element?.closest("td, th");
  const table = element?.closest("table") ?? null;
  if (cell) return plainText(selection.toString());
  if (table === null) return null;
  const rows = [...table.rows].filter((row) => selection.containsNode(row, true));
  return rows.length > 0 ? tableText(table, rows) : null;
}

/** Copies of selected tables paste as numbers. */
export function copySelected(event: ClipboardEvent) {
  const selection = document.getSelection();
  const text = selection && !(event.target instanceof HTMLInputElement) ? selectedText(selection) : null;
  if (text === null || event.clipboardData === null) return;
  event.clipboardData.setData("text/plain", text);
  const rows = text.split("\n").map((line) => line.split("\t"));
  if (rows.length > 1 || rows[0]!.length > 1) {
    const escaped = (cell: string) => cell.replaceAll("&", "&amp;").replaceAll("<", "&lt;");
    const html = rows.map((row) => `<tr>${row.map((cell) => `<td>${escaped(cell)}</td>`).join("")}</tr>`);
    event.clipboardData.setData("text/html", `<table>${html.join("")}</table>`);
  }
  event.preventDefault();
}
