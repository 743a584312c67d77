/** Options of a fit, as they are being changed in a form. */

import type { CampaignView, FitOptionsView, LawAbout, OptionsGiven } from "../api/types";

export interface Draft extends FitOptionsView {
  laws: string[];
}

/** Words that each option may have; those of the command line. */
export const CHOICES = {
  weights: [
    ["inverse-variance", "by each channel's noise"],
    ["inverse-mean", "1/mean, as in the 2003 study"],
  ],
  noise: [
    ["automatic", "estimated from the recording"],
    ["white", "white, sample by sample"],
  ],
  intervals: [
    ["asymptotic", "estimate ± t × deviation"],
    ["profile", "profile of the likelihood"],
    ["bootstrap", "resampled recordings"],
    ["posterior", "posterior"],
  ],
  onset: [
    ["auto", "as far as the data determine it"],
    ["free", "estimated"],
    ["fixed", "where the force passes its threshold"],
  ],
  displacement_offset: [
    ["auto", "as far as the data determine it"],
    ["free", "estimated"],
    ["fixed", "as measured"],
  ],
  end: [
    ["force-zero", "force is back at zero"],
    ["gap-zero", "displacement is back at zero"],
  ],
} as const satisfies Record<string, readonly (readonly [string, string])[]>;

export const COST_QUANTITIES = ["displacement", "rate", "force", "acceleration"] as const;

export const draftOf = (view: CampaignView): Draft => ({
  laws: [...view.laws],
  quantities: [...(view.options?.quantities ?? [])],
  weights: view.options?.weights ?? "inverse-variance",
  noise: view.options?.noise ?? "automatic",
  intervals: view.options?.intervals ?? "asymptotic",
  onset: view.options?.onset ?? "auto",
  initial_velocity: view.options?.initial_velocity ?? "auto",
  displacement_offset: view.options?.displacement_offset ?? "auto",
  end: view.options?.end ?? "force-zero",
  free: [...(view.options?.free ?? [])],
});

/** Differences between a draft and the campaign. */
export function changesOf(draft: Draft, view: CampaignView): OptionsGiven {
  const present = draftOf(view);
  const entries = (Object.keys(present) as (keyof Draft)[]).filter(
    (key) => JSON.stringify(draft[key]) !== JSON.stringify(present[key]),
  );
  return Object.fromEntries(entries.map((key) => [key, copy(draft[key])])) as OptionsGiven;
}

const copy = (value: string | string[]) => (Array.isArray(value) ? [...value] : value);

/** Name of a law expression: `power-law(n=1.5)` is a power-law. */
export const lawName = (expression: string) => expression.split("(")[0]!.trim();

/** Parameters that these laws have with a value of their own, which `free` can name. */
export function heldParameters(expressions: string[], laws: LawAbout[]): string[] {
  const names = new Set<string>();
  for (const expression of expressions) {
    const law = laws.find((each) => each.name === lawName(expression));
    for (const parameter of law?.parameters ?? []) {
      const given = new RegExp(`[(,]\\s*${parameter.name}\\s*=`).test(expression);
      if (parameter.default !== null || given) names.add(parameter.name);
    }
  }
  return [...names];
}
