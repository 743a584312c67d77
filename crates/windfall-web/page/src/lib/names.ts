/** Names, symbols and units of what windfall computes. */

interface Meaning {
  label: string;
  symbol: string;
  unit: string;
}

export const QUANTITIES: Record<string, Meaning> = {
  force: { label: "Force", symbol: "F", unit: "N" },
  displacement: { label: "Displacement", symbol: "x", unit: "m" },
  rate: { label: "Displacement rate", symbol: "v", unit: "m/s" },
  acceleration: { label: "Acceleration", symbol: "a", unit: "m/s^2" },
};

export const DERIVED: Record<string, Meaning> = {
  impact_velocity: { label: "Impact velocity", symbol: "v₁", unit: "m/s" },
  rebound_velocity: { label: "Rebound velocity", symbol: "v₂", unit: "m/s" },
  restitution: { label: "Coefficient of restitution", symbol: "e", unit: "" },
  contact_duration: { label: "Contact duration", symbol: "T", unit: "s" },
  peak_force: { label: "Peak force", symbol: "F max", unit: "N" },
  max_displacement: { label: "Largest displacement", symbol: "x max", unit: "m" },
  impact_energy: { label: "Impact energy", symbol: "E₁", unit: "J" },
  elastic_energy: { label: "Elastic energy", symbol: "E₂", unit: "J" },
  absorbed_energy: { label: "Absorbed energy", symbol: "Eₐ", unit: "J" },
  impulse: { label: "Impulse", symbol: "J", unit: "N s" },
  loading_energy: { label: "Loading energy", symbol: "Eₗ", unit: "J" },
  hysteresis_energy: { label: "Hysteresis energy", symbol: "Eₕ", unit: "J" },
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
  acoustic: "Taps",
  repeats: "Repeated impacts",
  drop: "Drops on a force plate",
};
