//! What an impact gives besides the parameters of a law. Each quantity is declared once,
//! in [`QUANTITIES`]: JSON, CSV, store, reports, tables and the page follow from there.

use windfall_files::text::number::unit_text;
use windfall_identify::rig::simulate::ImpactSummary;
use windfall_signal::impact::Measured;

/// A quantity of an impact.
#[derive(Clone, Copy, Debug)]
pub struct Quantity {
    /// Key in JSON and in the store.
    pub name: &'static str,
    /// What it is, for people.
    pub label: &'static str,
    /// Symbol in formulas.
    pub symbol: &'static str,
    /// SI unit; "" for a number.
    pub unit: &'static str,
    /// Heading of tables, without the unit.
    pub heading: &'static str,
    /// Unit in tables and figures for people; "" for a number.
    pub shown_unit: &'static str,
    /// That unit per SI unit.
    pub factor: f64,
    /// Where its values come from.
    pub source: Source,
}

/// Where the values of a quantity come from.
#[derive(Clone, Copy, Debug)]
pub enum Source {
    /// The signals where they show it, else the motion under the fitted law.
    SignalOrLaw {
        /// Value read off the signals.
        measured: fn(&Measured) -> Option<f64>,
        /// Its standard uncertainty.
        sd: fn(&Measured) -> Option<f64>,
        /// Value of the fitted motion.
        fitted: fn(&FittedMotion) -> f64,
    },
    /// The signals alone.
    Signal {
        /// Value read off the signals.
        measured: fn(&Measured) -> Option<f64>,
        /// Its standard uncertainty.
        sd: fn(&Measured) -> Option<f64>,
    },
    /// The angles of a pendulum in impacts.csv.
    Angles,
}

/// The motion under a fitted law.
#[derive(Clone, Copy, Debug)]
pub struct FittedMotion<'a> {
    /// Peaks, duration, restitution.
    pub summary: &'a ImpactSummary,
    /// Impact velocity; m/s.
    pub velocity: f64,
    /// Effective mass; kg.
    pub mass: f64,
}

impl FittedMotion<'_> {
    fn energy(&self, speed: f64) -> f64 {
        0.5 * self.mass * speed * speed
    }
}

const fn no_sd(_: &Measured) -> Option<f64> {
    None
}

/// Root of a sum of squares, of deviations that are all known.
fn together(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    Some(a?.hypot(b?))
}

/// Standard uncertainty relative to the value.
fn relative(sd: Option<f64>, value: Option<f64>) -> Option<f64> {
    let (sd, value) = (sd?, value?);
    (value != 0.0).then(|| sd / value.abs())
}

/// Of a velocity at touch or separation, from that of the motion beside the contact.
fn velocity_sd(s: &Measured, of_motion: Option<f64>) -> Option<f64> {
    Some(of_motion?.hypot(s.touch_velocity_sd.unwrap_or(0.0)))
}

fn impact_velocity_sd(s: &Measured) -> Option<f64> {
    velocity_sd(s, s.impact_velocity_sd)
}

fn rebound_velocity_sd(s: &Measured) -> Option<f64> {
    velocity_sd(s, s.rebound_velocity_sd)
}

/// e = v₂/v₁, of velocities whose errors are independent.
fn restitution_sd(s: &Measured) -> Option<f64> {
    let (v1, s1) = (s.impact_velocity?, impact_velocity_sd(s)?);
    let (v2, s2) = (s.rebound_velocity?, rebound_velocity_sd(s)?);
    (v1 != 0.0).then(|| (s2 / v1).hypot(v2 * s1 / (v1 * v1)))
}

/// E = ½ m v² at a mass that is known: σ(E) = 2 E σ(v)/v.
fn impact_energy_sd(s: &Measured) -> Option<f64> {
    Some(2.0 * s.impact_energy? * relative(impact_velocity_sd(s), s.impact_velocity)?)
}

fn elastic_energy_sd(s: &Measured) -> Option<f64> {
    Some(2.0 * s.elastic_energy? * relative(rebound_velocity_sd(s), s.rebound_velocity)?)
}

fn absorbed_energy_sd(s: &Measured) -> Option<f64> {
    together(impact_energy_sd(s), elastic_energy_sd(s))
}

/// A quantity as it stands in tables under its own name, in its SI unit.
const fn quantity(
    name: &'static str,
    (label, symbol, unit): (&'static str, &'static str, &'static str),
    source: Source,
) -> Quantity {
    Quantity {
        name,
        label,
        symbol,
        unit,
        heading: label,
        shown_unit: unit,
        factor: 1.0,
        source,
    }
}

impl Quantity {
    const fn headed(mut self, heading: &'static str) -> Self {
        self.heading = heading;
        self
    }

    const fn shown_in(mut self, unit: &'static str, factor: f64) -> Self {
        self.shown_unit = unit;
        self.factor = factor;
        self
    }

    /// Name of its column in CSV, with the unit: `peak_force_N`.
    pub fn column(&self) -> String {
        self.column_of("")
    }

    /// Name of the column of its standard uncertainty: `impulse_sd_N_s`.
    pub fn sd_column(&self) -> String {
        self.column_of("_sd")
    }

    fn column_of(&self, end: &str) -> String {
        let unit = self.unit.replace(['/', ' '], "_");
        let between = if unit.is_empty() { "" } else { "_" };
        format!("{}{end}{between}{unit}", self.name)
    }

    /// "peak force (N)".
    pub fn title(&self) -> String {
        match self.shown_unit {
            "" => self.heading.to_owned(),
            unit => format!("{} ({})", self.heading, unit_text(unit)),
        }
    }

    /// As [`Self::title`], for tables with a row for each impact: "absorbed (mJ)".
    pub fn narrow_title(&self) -> String {
        self.title().replace("absorbed energy", "absorbed")
    }

    /// Value read off the signals and its standard uncertainty, where they are finite.
    pub fn measured(&self, signals: &Measured) -> (Option<f64>, Option<f64>) {
        match self.source {
            Source::SignalOrLaw { measured, sd, .. } | Source::Signal { measured, sd } => {
                let finite = |value: Option<f64>| value.filter(|value| value.is_finite());
                (finite(measured(signals)), finite(sd(signals)))
            }
            Source::Angles => (None, None),
        }
    }

    /// Value in the motion under the fitted law, where it has one.
    pub fn fitted(&self, motion: &FittedMotion) -> Option<f64> {
        match self.source {
            Source::SignalOrLaw { fitted, .. } => Some(fitted(motion)),
            Source::Signal { .. } | Source::Angles => None,
        }
    }
}

/// Read off the signals or the fitted motion, under the same name in both.
macro_rules! both {
    ($measured:ident, $sd:expr, $fitted:expr) => {
        Source::SignalOrLaw {
            measured: |signals| signals.$measured,
            sd: $sd,
            fitted: $fitted,
        }
    };
}

/// Read off the signals alone.
macro_rules! signal {
    ($measured:ident, $sd:expr) => {
        Source::Signal {
            measured: |signals| signals.$measured,
            sd: $sd,
        }
    };
}

/// Every quantity, in the order of JSON and CSV.
pub const QUANTITIES: [Quantity; 27] = [
    quantity(
        "impact_velocity",
        ("Impact velocity", "v₁", "m/s"),
        both!(impact_velocity, impact_velocity_sd, |m| m.velocity),
    )
    .headed("velocity"),
    quantity(
        "rebound_velocity",
        ("Rebound velocity", "v₂", "m/s"),
        both!(rebound_velocity, rebound_velocity_sd, |m| {
            m.summary.separation_velocity
        }),
    )
    .headed("rebound velocity"),
    quantity(
        "restitution",
        ("Coefficient of restitution", "e", ""),
        both!(restitution, restitution_sd, |m| m.summary.restitution),
    )
    .headed("restitution"),
    quantity(
        "contact_duration",
        ("Contact duration", "T", "s"),
        both!(contact_duration, |s| s.contact_duration_sd, |m| m
            .summary
            .contact_duration),
    )
    .headed("duration")
    .shown_in("ms", 1e3),
    quantity(
        "peak_force",
        ("Peak force", "F max", "N"),
        both!(peak_force, |s| s.peak_force_sd, |m| m.summary.peak_force),
    )
    .headed("peak force"),
    quantity(
        "max_displacement",
        ("Largest displacement", "x max", "m"),
        both!(max_displacement, |s| s.max_displacement_sd, |m| m
            .summary
            .max_displacement),
    )
    .headed("displacement")
    .shown_in("mm", 1e3),
    quantity(
        "impact_energy",
        ("Impact energy", "E₁", "J"),
        both!(impact_energy, impact_energy_sd, |m| m.energy(m.velocity)),
    )
    .headed("impact energy")
    .shown_in("mJ", 1e3),
    quantity(
        "elastic_energy",
        ("Elastic energy", "E₂", "J"),
        both!(elastic_energy, elastic_energy_sd, |m| m
            .energy(m.summary.separation_velocity)),
    )
    .headed("elastic energy")
    .shown_in("mJ", 1e3),
    quantity(
        "absorbed_energy",
        ("Absorbed energy", "Eₐ", "J"),
        both!(absorbed_energy, absorbed_energy_sd, |m| m
            .summary
            .absorbed_energy),
    )
    .headed("absorbed energy")
    .shown_in("mJ", 1e3),
    quantity(
        "impulse",
        ("Impulse", "J", "N s"),
        both!(impulse, |s| s.impulse_sd, |m| m.summary.impulse),
    ),
    quantity(
        "loading_energy",
        ("Loading energy", "Eₗ", "J"),
        signal!(loading_energy, no_sd),
    ),
    quantity(
        "hysteresis_energy",
        ("Hysteresis energy", "Eₕ", "J"),
        signal!(hysteresis_energy, no_sd),
    ),
    quantity(
        "force_gain",
        ("Gain of the force", "F/mẍ", ""),
        signal!(force_gain, |s| s.force_gain_sd),
    ),
    quantity(
        "force_delay",
        ("Delay of the force", "τ", "s"),
        signal!(force_delay, |s| s.force_delay_sd),
    )
    .shown_in("µs", 1e6),
    quantity(
        "motion_misfit",
        ("Misfit of the motion", "Δx F", "m"),
        signal!(motion_misfit, no_sd),
    ),
    quantity(
        "motion_noise",
        ("Noise of the motion", "σ Δx", "m"),
        signal!(motion_noise, no_sd),
    ),
    quantity(
        "resolution",
        ("Resolution", "Δt/T", ""),
        signal!(resolution, no_sd),
    ),
    quantity(
        "acceleration_impulse_ratio",
        ("Impulse of force over that of acceleration", "J/mΔv", ""),
        signal!(acceleration_impulse_ratio, |s| s
            .acceleration_impulse_ratio_sd),
    ),
    quantity(
        "acceleration_peak_ratio",
        ("Peak of force over that of acceleration", "F/ma", ""),
        signal!(acceleration_peak_ratio, |s| s.acceleration_peak_ratio_sd),
    ),
    quantity(
        "integrated_displacement_error",
        ("Integrated less measured displacement, largest", "Δx", "m"),
        signal!(integrated_displacement_error, no_sd),
    ),
    quantity(
        "integrated_displacement_rms",
        ("Integrated less measured displacement, RMS", "Δx rms", "m"),
        signal!(integrated_displacement_rms, no_sd),
    ),
    quantity(
        "integrated_displacement_drift",
        (
            "Integrated less measured displacement, at the end",
            "Δx end",
            "m",
        ),
        signal!(integrated_displacement_drift, no_sd),
    ),
    quantity(
        "impact_energy_from_angle",
        ("Impact energy from the angle of release", "E₁ angle", "J"),
        Source::Angles,
    ),
    quantity(
        "impact_velocity_from_angle",
        (
            "Impact velocity from the angle of release",
            "v₁ angle",
            "m/s",
        ),
        Source::Angles,
    ),
    quantity(
        "elastic_energy_from_angle",
        ("Elastic energy from the angle of rebound", "E₂ angle", "J"),
        Source::Angles,
    ),
    quantity(
        "rebound_velocity_from_angle",
        (
            "Rebound velocity from the angle of rebound",
            "v₂ angle",
            "m/s",
        ),
        Source::Angles,
    ),
    quantity(
        "absorbed_energy_from_angles",
        ("Absorbed energy from both angles", "Eₐ angle", "J"),
        Source::Angles,
    ),
];

/// A quantity by its name.
pub fn quantity_named(name: &str) -> Option<&'static Quantity> {
    const ALL: &[Quantity] = &QUANTITIES;
    ALL.iter().find(|quantity| quantity.name == name)
}

/// Those named, in the order given; a name that is none is left out.
pub fn quantities_named(names: &[&str]) -> Vec<&'static Quantity> {
    names
        .iter()
        .filter_map(|name| quantity_named(name))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_columns_carry_the_unit() {
        let column = |name| quantity_named(name).map(Quantity::column);
        assert_eq!(column("impulse").as_deref(), Some("impulse_N_s"));
        assert_eq!(
            column("rebound_velocity").as_deref(),
            Some("rebound_velocity_m_s")
        );
        assert_eq!(column("restitution").as_deref(), Some("restitution"));
        let impulse = quantity_named("impulse").map(Quantity::sd_column);
        assert_eq!(impulse.as_deref(), Some("impulse_sd_N_s"));
    }

    #[test]
    fn closed_form_names_are_unique() {
        for (i, one) in QUANTITIES.iter().enumerate() {
            assert!(QUANTITIES[..i].iter().all(|other| other.name != one.name));
        }
    }
}
