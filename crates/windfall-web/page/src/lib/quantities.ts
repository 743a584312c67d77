/** Names, symbols and units of what an impact gives.
 *  Generated from crates/campaign/src/result/quantity.rs: do not edit. */

export interface Meaning {
  label: string;
  symbol: string;
  unit: string;
}

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
  force_gain: { label: "Gain of the force", symbol: "F/mẍ", unit: "" },
  force_delay: { label: "Delay of the force", symbol: "τ", unit: "s" },
  motion_misfit: { label: "Misfit of the motion", symbol: "Δx F", unit: "m" },
  motion_noise: { label: "Noise of the motion", symbol: "σ Δx", unit: "m" },
  resolution: { label: "Resolution", symbol: "Δt/T", unit: "" },
  acceleration_impulse_ratio: { label: "Impulse of force over that of acceleration", symbol: "J/mΔv", unit: "" },
  acceleration_peak_ratio: { label: "Peak of force over that of acceleration", symbol: "F/ma", unit: "" },
  integrated_displacement_error: { label: "Integrated less measured displacement, largest", symbol: "Δx", unit: "m" },
  integrated_displacement_rms: { label: "Integrated less measured displacement, RMS", symbol: "Δx rms", unit: "m" },
  integrated_displacement_drift: { label: "Integrated less measured displacement, at the end", symbol: "Δx end", unit: "m" },
  impact_energy_from_angle: { label: "Impact energy from the angle of release", symbol: "E₁ angle", unit: "J" },
  impact_velocity_from_angle: { label: "Impact velocity from the angle of release", symbol: "v₁ angle", unit: "m/s" },
  elastic_energy_from_angle: { label: "Elastic energy from the angle of rebound", symbol: "E₂ angle", unit: "J" },
  rebound_velocity_from_angle: { label: "Rebound velocity from the angle of rebound", symbol: "v₂ angle", unit: "m/s" },
  absorbed_energy_from_angles: { label: "Absorbed energy from both angles", symbol: "Eₐ angle", unit: "J" },
};
