/** What `windfall calibrate --format json` gives (crates/windfall/src/calibrate_outcome.rs
 *  and calibrate_waveform_outcome.rs). */

import type { Failure, Finding } from "../api";

export interface Measured {
  value: number;
  sd: number | null;
  low: number | null;
  high: number | null;
  unit: string;
}

export type Features = Record<string, number>;

export interface Verified {
  response: string;
  unit: string;
  measured: number | null;
  predicted: number | null;
  simulated: number | null;
  difference: number | null;
}

export interface Waveform {
  law: string;
  parameters: { name: string; value: Measured; sd_of_noise: number; per_millimetre: Measured | null }[];
  correlations: number[][];
  weakest: { sd: number; shares: Record<string, number> } | null;
  by_scatter: boolean;
  misfit: number;
  samples: number;
  impacts: number;
  drops: { id: string; specimen: string; height: number; velocity: Measured; mass: Measured; misfit: number; samples: number }[];
  converged: boolean;
}

export interface FeaturesWay {
  law: string;
  parameters: {
    name: string;
    value: number;
    sd: number | null;
    unit: string;
    written: { value: number; sd: number | null; low: number | null; high: number | null; unit: string };
    at_limit: boolean;
  }[];
  rank: number;
  directions: { sd: number | null; words: string }[];
  chi_square: number;
  freedom: number;
  p: number | null;
  widened: number;
  fitted: { drop: string; feature: string; measured: Measured; fitted: number; standardised: number }[];
  converged: boolean;
}

export interface FamilyMember {
  parameters: number[];
  law: string;
  heights: { height: number; features: Features }[];
}

export interface DesignWay {
  kind: string;
  factors: { letter: string; name: string; unit: string; low: number; high: number; centre: number; half: number }[];
  runs: { levels: number[]; responses: (number | null)[] }[];
  surfaces: {
    response: string;
    unit: string;
    model: string;
    terms: { term: string; coded: number; actual: number }[];
    r2: number;
    r2_adjusted: number;
    r2_predicted: number;
    sigma: number;
  }[];
  optimum: { levels: number[]; law: string; desirability: number; responses: Verified[] };
  family: { levels: number[]; desirability: number }[];
  heights: { height: number; drops: number; responses: Verified[] }[];
}

export interface Candidate {
  height: number;
  mass: number;
  fruit: string;
  impacts: number;
  drops: number;
  sds: (number | null)[];
  gain: number | null;
  rank: number;
  gain_of_interest: number | null;
}

export interface Calibration {
  law: string;
  free: string[];
  plate: Record<string, Measured>;
  drops: { id: string; specimen: string; height: Measured }[];
  target: { of: string; drops: number; mass: number; height: number; features: Record<string, Measured> };
  start: { law: string; rule: string };
  waveform: Waveform | null;
  features: FeaturesWay | null;
  family: { dimension: number; words: string; members: FamilyMember[] } | null;
  closing: { with: string; rank: number; sds: (number | null)[] }[];
  design: DesignWay | null;
  next: { interest: string; now: (number | null)[]; candidates: Candidate[] } | null;
  failed: Failure[];
  findings: Finding[];
}

const FEATURES: Record<string, { label: string; unit: string }> = {
  peak_support_force: { label: "peak of impact", unit: "N" },
  peak_force: { label: "peak of impact", unit: "N" },
  interval: { label: "interval", unit: "s" },
  contact_duration: { label: "contact of impact", unit: "s" },
};

/** "peak_support_force_2" in words, with its unit. */
export function featureOf(name: string): { label: string; unit: string } {
  const [, base = name, place] = /^(.*?)(?:_(\d+))?$/.exec(name) ?? [];
  const known = FEATURES[base];
  const label = known?.label ?? base.replaceAll("_", " ");
  return { label: place === undefined ? label : `${label} ${place}`, unit: known?.unit ?? "" };
}

/** Features that tell the members of a family apart, the most telling first: each as the
 *  deviation from the middle member, in percent. */
export function telling(members: FamilyMember[], most: number): { height: number; feature: string; percent: number[]; spread: number }[] {
  const middle = members[Math.floor(members.length / 2)];
  if (!middle) return [];
  const found = middle.heights.flatMap(({ height, features }, h) =>
    Object.entries(features).flatMap(([feature, reference]) => {
      const values = members.map((member) => member.heights[h]?.features[feature]);
      if (reference === 0 || values.some((value) => value === undefined)) return [];
      const percent = values.map((value) => 100 * (value! / reference - 1));
      return [{ height, feature, percent, spread: Math.max(...percent) - Math.min(...percent) }];
    }),
  );
  return found.sort((a, b) => b.spread - a.spread).slice(0, most);
}

/** The name of a law in an expression. */
export const lawName = (expression: string): string => /^[^(]*/.exec(expression)![0].trim();
