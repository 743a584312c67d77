/** Formulas of regressions as chips: which main effects, products and squares a
 *  formula holds, and the formula with one more or fewer. Pure. */

/** A name as it stands in a formula: others than plain words in backticks. */
export const spelled = (name: string): string => (/^[A-Za-z_][A-Za-z0-9_.]*$/.test(name) ? name : `\`${name}\``);

/** Parts of a formula between its plus signs, outside brackets and backticks. */
export function termsOf(formula: string): string[] {
  const parts: string[] = [];
  let [depth, quoted, current] = [0, false, ""];
  for (const letter of formula) {
    if (letter === "`") quoted = !quoted;
    if (!quoted) depth += letter === "(" ? 1 : letter === ")" ? -1 : 0;
    if (letter === "+" && depth === 0 && !quoted) {
      parts.push(current);
      current = "";
    } else current += letter;
  }
  return [...parts, current].map((part) => part.trim()).filter((part) => part !== "");
}

/** `a:b` and `b:a` are one term. */
const same = (one: string, other: string) => key(one) === key(other);
const key = (term: string) => term.replace(/\s+/g, "").split(":").sort().join(":");

/** `a*b` as what it stands for; other terms as they are. */
function opened(term: string): string[] {
  const factors = term.split("*").map((factor) => factor.trim());
  const simple = factors.length > 1 && factors.every((factor) => /^(`[^`]+`|[A-Za-z_][A-Za-z0-9_.]*)$/.test(factor));
  if (!simple) return [term];
  return subsets(factors).map((subset) => subset.join(":"));
}

function subsets(factors: string[]): string[][] {
  const all = factors.reduce<string[][]>((sets, factor) => [...sets, ...sets.map((set) => [...set, factor])], [[]]);
  return all.filter((set) => set.length > 0).sort((a, b) => a.length - b.length);
}

export const hasTerm = (formula: string, term: string): boolean =>
  termsOf(formula).some((part) => opened(part).some((each) => same(each, term)));

/** The formula with the term put in, or taken out. */
export function toggledTerm(formula: string, term: string): string {
  const parts = termsOf(formula);
  if (!hasTerm(formula, term)) return [...parts, term].filter((part) => part !== "1").join(" + ");
  const left = parts.flatMap((part) => {
    const own = opened(part);
    return own.some((each) => same(each, term)) ? own.filter((each) => !same(each, term)) : [part];
  });
  // A model of nothing else is that of the mean.
  return left.length === 0 ? "1" : left.join(" + ");
}

export const product = (one: string, other: string): string => `${spelled(one)}:${spelled(other)}`;
export const square = (name: string): string => `${spelled(name)}^2`;
