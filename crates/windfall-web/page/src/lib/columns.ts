/** Which columns of a table could explain others. Pure. */

import type { DataTable } from "../api/types";

/** Columns that number the rows, or say in which order they were made. */
const COUNTERS = /^(id|run|no|nr|line|order|std|standard_order|block)$/i;

interface Explaining {
  name: string;
  numbers: boolean;
  /** Different cells. */
  levels: number;
}

/** Columns that differ from row to row: neither counters, nor names of the rows, nor
 *  uncertainties or coded levels of another column. */
export function explaining(table: DataTable): Explaining[] {
  /** Words of more kinds than this name rows. */
  const MOST_WORDS = 12;
  const names = new Set(table.columns.map((column) => column.name));
  return table.columns.flatMap(({ name, numbers }, place) => {
    const beside = /^(.+)_(sd|low|high|unit|coded)$/.exec(name);
    if (COUNTERS.test(name) || (beside && names.has(beside[1]!))) return [];
    const levels = new Set(table.rows.map((row) => row[place])).size;
    return levels > 1 && (numbers || levels <= MOST_WORDS) ? [{ name, numbers, levels }] : [];
  });
}
