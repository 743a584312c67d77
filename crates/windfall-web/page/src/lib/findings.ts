/** Findings of several sources as one list. */

import type { FindingKind, FindingOutcome } from "../api/types";

/** Severities, the gravest first. */
export const GRAVITY: readonly FindingOutcome["severity"][] = ["wrong", "doubtful", "note"];

/** What the signals say, and what the fits of laws say: each once, with the laws that say it
 *  where others do not. */
export function findingsOfLaws(
  signal: readonly FindingOutcome[],
  laws: readonly { law: string; findings: readonly FindingOutcome[] }[],
): (FindingOutcome & Pick<FindingKind, "laws">)[] {
  const same = (finding: FindingOutcome) => `${finding.code} ${finding.message}`;
  const found = new Map(signal.map((each) => [same(each), { ...each, laws: [] as string[] }]));
  for (const { law, findings } of laws) {
    for (const finding of findings) {
      const known = found.get(same(finding)) ?? { ...finding, laws: [] };
      known.laws.push(law);
      found.set(same(finding), known);
    }
  }
  const all = laws.length;
  return [...found.values()].map((each) => ({ ...each, laws: each.laws.length < all ? each.laws : [] }));
}
