/** Names, symbols and units of what windfall computes. */

import { DERIVED, type Meaning } from "./quantities";

export const QUANTITIES: Record<string, Meaning> = {
  force: { label: "Force", symbol: "F", unit: "N" },
  displacement: { label: "Displacement", symbol: "x", unit: "m" },
  rate: { label: "Displacement rate", symbol: "v", unit: "m/s" },
  acceleration: { label: "Acceleration", symbol: "a", unit: "m/s^2" },
};

/** Meaning of a derived value; a name that is not known is shown as it is. */
export const derivedMeaning = (name: string): Meaning =>
  DERIVED[name] ?? { label: words(name), symbol: name, unit: "" };

/** `displacement_offset` as words. */
export const words = (name: string) => {
  const spaced = name.replaceAll("_", " ");
  return spaced.charAt(0).toUpperCase() + spaced.slice(1);
};

export const KINDS: Record<string, string> = {
  impacts: "Impacts",
  pendulum: "Impacts on a pendulum",
  carriage: "Impacts on a carriage",
  compression: "Slow compression",
  relaxation: "Stress relaxation",
  acoustic: "Taps",
  repeats: "Repeated impacts",
  drop: "Drops on a force plate",
};
