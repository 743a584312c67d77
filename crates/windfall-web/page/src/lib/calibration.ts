/** What the views of a calibration share. */

import type { FamilyMember } from "../api/types";

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
