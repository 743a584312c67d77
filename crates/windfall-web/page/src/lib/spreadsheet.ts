/** Words and numbers of the page as a spreadsheet reads them. Pure. */

/** What a cell or a heading gives to a spreadsheet; more than one value fills more columns, and
 *  the heading says how many. */
export const values = (...of: (number | string | null | undefined)[]): string => of.map(written).join("\t");

const written = (value: number | string | null | undefined): string => {
  if (value === null || value === undefined || Number.isNaN(value)) return "";
  // A tab or a new line would begin another cell.
  return String(value).replace(/\s+/g, " ").trim();
};

const RAISED = "⁰¹²³⁴⁵⁶⁷⁸⁹⁻";

/** Words of the page as a spreadsheet reads them: without thin spaces, with the minus of a
 *  keyboard, `1.2·10⁻⁵` as `1.2e-5`, and nothing for a dash. */
export function plainText(text: string): string {
  const bare = text
    .replace(/(\d)[\u202f\u2009](?=\d)/g, "$1")
    .replace(/[\u202f\u2009\u00a0]/g, " ")
    .replace(/\u2212/g, "-")
    .replace(/(\d)·10([⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+)/g, (_, digit: string, power: string) => {
      const digits = [...power].map((c) => "0123456789-"[RAISED.indexOf(c)]).join("");
      return `${digit}e${digits}`;
    })
    .replace(/\s+/g, " ")
    .trim();
  return bare === "–" ? "" : bare;
}
