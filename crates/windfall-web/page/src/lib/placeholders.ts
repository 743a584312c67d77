/** Names of columns in campaign.toml that hold columns of impacts.csv: "{run}: Force (N)". Pure. */

const PLACEHOLDER = /\{([^{}]+)\}/;

/** The columns of impacts.csv that a name asks for. */
export function placeholders(name: string): string[] {
  return name.split(PLACEHOLDER).filter((_, place) => place % 2 === 1);
}

/** Whether a name means a column, whatever stands in the place of what impacts.csv fills in. */
export function namesColumn(name: string, column: string): boolean {
  const pattern = name
    .split(PLACEHOLDER)
    .map((part, place) => (place % 2 === 1 ? ".+" : part.replace(/[.*+?^${}()|[\]\\]/g, "\\$&")))
    .join("");
  return new RegExp(`^${pattern}$`, "s").test(column);
}

/** A name as a row fills it in, "{run}: Force" as "3: Force". */
export const filledIn = (name: string, cell: (column: string) => string): string =>
  name.replace(/\{([^{}]+)\}/g, (_, column: string) => cell(column));
