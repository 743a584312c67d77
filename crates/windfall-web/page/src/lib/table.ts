/** The table of all results of a campaign: joined with what specimens.csv and
 *  impacts.csv say, sorted, filtered, described, written as CSV. Pure. */

import type {
  CampaignView,
  EstimateOutcome,
  ImpactOutcome,
  MeasuredItem,
  MeasuredValue,
  StoredResults,
  TableView,
} from "../api/types";
import { plusMinus, unitText } from "./format";
import { words } from "./names";
import { DERIVED } from "./quantities";

type Cell = number | string | null;

export interface Column {
  /** Unique among columns. */
  key: string;
  label: string;
  /** SI; "" where there is none, or where it differs from row to row. */
  unit: string;
  /** Whether it holds numbers. */
  numbers: boolean;
  /** Source: the results, or one of the tables. */
  from: "result" | "specimens.csv" | "impacts.csv";
}

export interface Row {
  /** Unique among rows. */
  key: string;
  /** The impact, or the recording. */
  id: string;
  group: string;
  law: string;
  cells: Map<string, Cell>;
  /** Of the cells that have them. */
  spreads: Map<string, Spread>;
}

export interface Spread {
  /** Standard deviation. */
  sd: number | null;
  /** 95 % interval. */
  interval: [number, number] | null;
}

export interface ResultTable {
  columns: Column[];
  rows: Row[];
  groups: string[];
  laws: string[];
}

/** Value of a result, however its kind of campaign writes it. */
type Value = Partial<EstimateOutcome | MeasuredValue>;

/** Codes of findings, each once: there is one of each channel. */
const codes = (findings: { code: string }[]): string => [...new Set(findings.map((own) => own.code))].join(", ");

/** Joins the results with the tables of the campaign. */
export function resultTable(campaign: CampaignView, results: StoredResults | null): ResultTable {
  const items: (ImpactOutcome | MeasuredItem)[] = results?.outcome?.impacts ?? [];
  const columns = new Map<string, Column>();
  const note = (key: string, label: string, unit: string, from: Column["from"], numbers: boolean) => {
    const known = columns.get(key);
    if (!known) columns.set(key, { key, label, unit, numbers, from });
    else if (known.unit !== unit) known.unit = "";
  };
  for (const [key, label] of [["id", "Id"], ["specimen", "Specimen"], ["group", "Group"], ["law", "Law"]] as const) {
    note(key, label, "", "result", false);
  }
  const specimens = joined(campaign.specimens, "specimens.csv");
  const impacts = joined(campaign.impacts, "impacts.csv");
  const several = new Set(items.map((item) => item.law)).size > 1;
  const seen = new Map<string, number>();
  const rows = items.map((item) => {
    // Rows that come in between leave the keys of the others as they are.
    const name = several ? `${item.id} ${item.law}` : item.id;
    const before = seen.get(name) ?? 0;
    seen.set(name, before + 1);
    const row: Row = {
      key: before === 0 ? name : `${name} ${before + 1}`,
      id: item.id,
      group: item.group ?? "",
      law: item.law,
      cells: new Map<string, Cell>([
        ["id", item.id],
        ["specimen", item.specimen],
        ["group", item.group ?? ""],
        ["law", item.law],
      ]),
      spreads: new Map(),
    };
    for (const set of [item.parameters, item.derived]) {
      for (const [name, given] of Object.entries(set)) {
        const found: Value = given !== null && typeof given === "object" ? given : { value: given ?? undefined };
        const meaning = DERIVED[name];
        const unit = found.unit ?? meaning?.unit ?? "";
        note(name, meaning?.label ?? labelOf(name), unit === "1" ? "" : unit, "result", true);
        row.cells.set(name, finite(found.value));
        const [sd, low, high] = [finite(found.sd), finite(found.low), finite(found.high)];
        const interval: Spread["interval"] = low !== null && high !== null ? [low, high] : null;
        if (sd !== null || interval) row.spreads.set(name, { sd, interval });
      }
    }
    for (const [name, text] of Object.entries("words" in item ? item.words : {})) {
      if (row.cells.has(name)) continue;
      note(name, words(name), "", "result", false);
      row.cells.set(name, text);
    }
    note("findings", "Findings", "", "result", false);
    row.cells.set("findings", codes(item.findings));
    const reasons = "left_out" in item ? (item.left_out ?? []) : [];
    if (reasons.length > 0) {
      note("left_out", "Left out", "", "result", false);
      row.cells.set("left_out", codes(reasons));
    }
    specimens.put(row, item.specimen);
    impacts.put(row, item.id);
    return row;
  });
  for (const column of [...specimens.columns, ...impacts.columns]) columns.set(column.key, column);
  return {
    columns: [...columns.values()],
    rows,
    groups: distinct(rows.map((row) => row.group)),
    laws: distinct(rows.map((row) => row.law)),
  };
}

const finite = (value: number | null | undefined) =>
  value === null || value === undefined || !Number.isFinite(value) ? null : value;

/** Symbols stay as they are; longer names become words. */
const labelOf = (name: string) => (name.length <= 3 ? name : words(name));

const distinct = (values: string[]) => [...new Set(values)].filter((value) => value !== "");

/** Columns of a table of the campaign beside its ids. */
function joined(table: TableView, from: "specimens.csv" | "impacts.csv") {
  const id = table.columns.indexOf("id");
  const rows = new Map(table.rows.map((row) => [row[id] ?? "", row]));
  const columns = table.columns.flatMap((name, place): (Column & { place: number })[] => {
    if (["id", "specimen", "file"].includes(name)) return [];
    const cells = table.rows.map((row) => row[place] ?? "").filter((cell) => cell !== "");
    const numbers = cells.length > 0 && cells.every((cell) => numberOf(cell) !== null);
    return [{ key: `${from} ${name}`, label: name, unit: "", numbers, from, place }];
  });
  return {
    columns: columns.map(({ place: _, ...column }) => column),
    put(row: Row, key: string): void {
      const found = rows.get(key);
      for (const column of columns) {
        const cell = found?.[column.place] ?? "";
        row.cells.set(column.key, cell === "" ? null : column.numbers ? numberOf(cell) : cell);
      }
    },
  };
}

/** Whether a cell of the column `exclude` leaves an impact out. */
export const excludes = (cell: string): boolean => !["", "0", "no", "false", "n"].includes(cell.trim().toLowerCase());

/** Label of a column with its unit. */
export const heading = (of: Column) => (of.unit === "" ? of.label : `${of.label} (${unitText(of.unit)})`);

/** A cell in words, with its standard deviation. */
export function shown(row: Row, of: Column): string {
  const cell = row.cells.get(of.key);
  const sd = row.spreads.get(of.key)?.sd;
  if (typeof cell === "number") return Number.isInteger(cell) && !sd ? String(cell) : plusMinus(cell, sd);
  return cell === null || cell === undefined || cell === "" ? "–" : cell;
}

/** The number that a cell is, all of it. */
export function numberOf(cell: string): number | null {
  const text = cell.trim();
  return /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(text) ? Number(text) : null;
}

/** What rows are sorted by. */
export interface Order {
  /** Key of a column; "" for none. */
  key: string;
  descending: boolean;
}

export interface Filter {
  /** Every word must occur in some cell of the row. */
  text: string;
  /** Chosen groups; empty: all. */
  groups: string[];
  laws: string[];
  /** Ends of numeric columns; `null`: open. */
  ranges: Record<string, { low: number | null; high: number | null }>;
}

export const noFilter = (): Filter => ({ text: "", groups: [], laws: [], ranges: {} });

/** "key:0.1..0.5" for each range; ends that are open are left out. */
export const rangesText = (ranges: Filter["ranges"]): string[] =>
  Object.entries(ranges).map(([key, { low, high }]) => `${key}:${low ?? ""}..${high ?? ""}`);

export function rangesOf(texts: string[]): Filter["ranges"] {
  const parts = texts.flatMap((text) => {
    const [, key, low, high] = /^(.*):([^:]*?)\.\.([^:]*)$/s.exec(text) ?? [];
    return key === undefined ? [] : [[key, { low: numberOf(low ?? ""), high: numberOf(high ?? "") }] as const];
  });
  return Object.fromEntries(parts);
}

/** Rows that a filter lets through, in their order. */
export function filtered(rows: Row[], filter: Filter): Row[] {
  const wanted = filter.text.toLowerCase().split(/\s+/).filter(Boolean);
  const ranges = Object.entries(filter.ranges).filter(([, { low, high }]) => low !== null || high !== null);
  return rows.filter((row) => {
    if (filter.groups.length > 0 && !filter.groups.includes(row.group)) return false;
    if (filter.laws.length > 0 && !filter.laws.includes(row.law)) return false;
    for (const [key, { low, high }] of ranges) {
      const cell = row.cells.get(key);
      if (typeof cell !== "number") return false;
      if ((low !== null && cell < low) || (high !== null && cell > high)) return false;
    }
    if (wanted.length === 0) return true;
    const text = [...row.cells.values()].filter((cell) => typeof cell === "string").join("\n").toLowerCase();
    return wanted.every((word) => text.includes(word));
  });
}

const collator = new Intl.Collator("en", { numeric: true, sensitivity: "base" });

/** Rows by a column; those without a value last, equal ones in their order. */
export function sorted(rows: Row[], key: string, descending: boolean): Row[] {
  const sign = descending ? -1 : 1;
  const empty = (cell: Cell | undefined) => cell === null || cell === undefined || cell === "";
  return [...rows].sort((one, other) => {
    const [a, b] = [one.cells.get(key), other.cells.get(key)];
    if (empty(a) || empty(b)) return Number(empty(a)) - Number(empty(b));
    if (typeof a === "number" && typeof b === "number") return sign * (a - b);
    return sign * collator.compare(String(a), String(b));
  });
}

interface Described {
  n: number;
  mean: number | null;
  /** Standard deviation, n − 1; of one value there is none. */
  sd: number | null;
}

/** Count, mean and standard deviation of a column. */
export function described(rows: Row[], key: string): Described {
  const values = rows.map((row) => row.cells.get(key)).filter((cell) => typeof cell === "number");
  const n = values.length;
  if (n === 0) return { n, mean: null, sd: null };
  const mean = values.reduce((sum, value) => sum + value, 0) / n;
  if (n === 1) return { n, mean, sd: null };
  const squares = values.reduce((sum, value) => sum + (value - mean) ** 2, 0);
  return { n, mean, sd: Math.sqrt(squares / (n - 1)) };
}

/** Rows as CSV with all digits; units stand in the header, uncertainties beside values. */
export const csvOf = (columns: Column[], rows: Row[]): string =>
  linesOf(columns, rows).map((line) => line.map(quoted).join(",")).join("\r\n") + "\r\n";

/** The same with tabs between cells, for the clipboard. */
export const tabbed = (columns: Column[], rows: Row[]): string => {
  const cell = (of: Cell) => {
    const text = String(of ?? "").replace(/\s+/g, " ");
    return typeof of !== "number" && isFormula(text) ? `'${text}` : text;
  };
  return linesOf(columns, rows).map((line) => line.map(cell).join("\t")).join("\n");
};

function linesOf(columns: Column[], rows: Row[]): Cell[][] {
  const parts = columns.map((column) => ({
    column,
    spread: rows.some((row) => row.spreads.has(column.key)),
  }));
  const header = parts.flatMap(({ column, spread }) => {
    const name = column.from === "result" ? column.key : column.label;
    const heading = column.unit === "" ? name : `${name} (${column.unit})`;
    return spread ? [heading, `${name} sd`, `${name} low`, `${name} high`] : [heading];
  });
  const lines = rows.map((row) =>
    parts.flatMap(({ column, spread }) => {
      const cell = row.cells.get(column.key) ?? "";
      const own = row.spreads.get(column.key);
      return spread ? [cell, own?.sd ?? "", ...(own?.interval ?? ["", ""])] : [cell];
    }),
  );
  return [header, ...lines];
}

/** A cell as the program writes it: with an apostrophe before what a spreadsheet would
 *  take for a formula. */
function quoted(cell: Cell): string {
  if (cell === null) return "";
  if (typeof cell === "number") return String(cell);
  const text = isFormula(cell) ? `'${cell}` : cell;
  return /[",;#\t\r\n\uFEFF]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

/** Whether a cell is a formula for a spreadsheet, or a formula behind apostrophes. The
 *  program has the same in formats/src/text/spreadsheet.rs. */
export function isFormula(cell: string): boolean {
  const end = cell.replace(/\p{White_Space}+$/u, "");
  const rest = end.replace(/^['\p{White_Space}]+/u, "");
  const before = end.slice(0, end.length - rest.length);
  const begins = /^[=+\-@＝＋－＠]/.test(rest) || /[\t\r\n]/.test(before);
  const number = /^[+-]?((\d+\.?\d*|\.\d+)(e[+-]?\d+)?|inf|infinity|nan)$/i.test(rest.replace(",", "."));
  return begins && rest !== "" && !number;
}
