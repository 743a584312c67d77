//! `windfall simulate`: one event from a force law.

use crate::error::Error;
use crate::named::Named;
use crate::write_csv::csv_text;
use crate::write_table::table_text;
use serde::Serialize;
use windfall_contact::expression::LawExpression;
use windfall_contact::expression::parse_law;
use windfall_contact::law::EndRule;
use windfall_contact::law_kind::Law;
use windfall_contact::restitution::nominal_restitution;
use windfall_identify::rig::Rig;
use windfall_identify::simulate::{ImpactSummary, Trajectory, simulate_rig, trajectory};

/// What is kept of the motion before and after contact, as a part of its duration.
const MARGIN: f64 = 0.25;

/// One simulated impact: the keys of the JSON that scripts rely on; SI.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SimulatedImpact {
    /// The law with all its parameters.
    pub law: String,
    /// Mass that the contact feels.
    pub effective_mass: f64,
    /// Velocity at first touch.
    pub impact_velocity: f64,
    /// End of contact: "force-zero" or "gap-zero".
    pub end: &'static str,
    /// Largest contact force.
    pub peak_force: f64,
    /// Time of the largest force, from first touch.
    pub time_of_peak_force: f64,
    /// Largest displacement.
    pub max_displacement: f64,
    /// Time of the largest displacement.
    pub time_of_max_displacement: f64,
    /// From first touch to the end of contact.
    pub contact_duration: f64,
    /// Displacement left at the end of contact.
    pub final_displacement: f64,
    /// Speed at the end of contact, away from the fruit.
    pub separation_velocity: f64,
    /// Separation over impact velocity, as delivered.
    pub restitution: f64,
    /// The restitution that the law is given as a parameter, which is not
    /// always the one that it delivers; `None` for other laws.
    pub nominal_restitution: Option<f64>,
    /// Kinetic energy lost.
    pub absorbed_energy: f64,
    /// Integral of the force over the contact.
    pub impulse: f64,
}

/// A simulated motion with its summary.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatedMotion {
    /// The impact in numbers.
    pub impact: SimulatedImpact,
    /// The motion at evenly spaced times.
    pub trajectory: Trajectory,
}

/// A force law with all its parameters from an expression.
///
/// # Errors
/// The expression cannot be read or lacks a parameter.
pub fn complete_law(text: &str) -> Result<Law, Error> {
    let law = parse_law(text).and_then(|expression| expression.complete());
    law.map_err(|error| Error::OptionInvalid {
        option: format!("--law {text}"),
        problem: error.to_string(),
    })
}

/// Simulates one impact of a rig.
///
/// # Errors
/// The rig or the velocity has no physical value, or the bodies do not part.
pub fn simulate_one(
    law: &Law,
    rig: &Rig,
    velocity: f64,
    end: EndRule,
) -> Result<SimulatedImpact, Error> {
    let summary = simulate_rig(law, rig, velocity, end).map_err(|source| failed(law, source))?;
    Ok(simulated(law, rig, velocity, end, &summary))
}

/// Simulates one impact of a rig with its motion, sampled at a rate, from a
/// little before contact to a little after.
///
/// * `rate`: samples per second; Hz
///
/// # Errors
/// As [`simulate_one`].
pub fn simulate_motion(
    law: &Law,
    rig: &Rig,
    velocity: f64,
    rate: f64,
    end: EndRule,
) -> Result<SimulatedMotion, Error> {
    let impact = simulate_one(law, rig, velocity, end)?;
    let margin = (MARGIN * impact.contact_duration * rate).ceil();
    let last = ((1.0 + MARGIN) * impact.contact_duration * rate).ceil();
    let times: Vec<f64> = (0..=(margin + last) as usize)
        .map(|i| (i as f64 - margin) / rate)
        .collect();
    let trajectory =
        trajectory(law, rig, velocity, &times, end).map_err(|source| failed(law, source))?;
    Ok(SimulatedMotion { impact, trajectory })
}

fn failed(law: &Law, source: windfall_identify::error::Error) -> Error {
    Error::Identify {
        subject: LawExpression::from(*law).to_string(),
        source: Box::new(source),
    }
}

fn simulated(
    law: &Law,
    rig: &Rig,
    velocity: f64,
    end: EndRule,
    summary: &ImpactSummary,
) -> SimulatedImpact {
    SimulatedImpact {
        law: LawExpression::from(*law).to_string(),
        effective_mass: rig.effective_mass(),
        impact_velocity: velocity,
        end: end_name(end),
        peak_force: summary.peak_force,
        time_of_peak_force: summary.time_of_peak_force,
        max_displacement: summary.max_displacement,
        time_of_max_displacement: summary.time_of_max_displacement,
        contact_duration: summary.contact_duration,
        final_displacement: summary.final_displacement,
        separation_velocity: summary.separation_velocity,
        restitution: summary.restitution,
        nominal_restitution: nominal_restitution(law),
        absorbed_energy: summary.absorbed_energy,
        impulse: summary.impulse,
    }
}

/// Name of an end rule in files and results.
#[must_use]
pub fn end_name(end: EndRule) -> &'static str {
    match end {
        EndRule::ForceZero => "force-zero",
        EndRule::GapZero => "gap-zero",
    }
}

/// Rows of a summary: name, value, unit.
fn rows(impact: &SimulatedImpact) -> Vec<(&'static str, f64, &'static str)> {
    let mut rows = vec![
        ("effective_mass", impact.effective_mass, "kg"),
        ("impact_velocity", impact.impact_velocity, "m/s"),
        ("peak_force", impact.peak_force, "N"),
        ("time_of_peak_force", impact.time_of_peak_force, "s"),
        ("max_displacement", impact.max_displacement, "m"),
        (
            "time_of_max_displacement",
            impact.time_of_max_displacement,
            "s",
        ),
        ("contact_duration", impact.contact_duration, "s"),
        ("final_displacement", impact.final_displacement, "m"),
        ("separation_velocity", impact.separation_velocity, "m/s"),
        ("restitution", impact.restitution, "1"),
    ];
    if let Some(nominal) = impact.nominal_restitution {
        rows.push(("nominal_restitution", nominal, "1"));
    }
    rows.push(("absorbed_energy", impact.absorbed_energy, "J"));
    rows.push(("impulse", impact.impulse, "N s"));
    rows
}

/// A simulated impact as text.
#[must_use]
pub fn text_of_simulation(impact: &SimulatedImpact) -> String {
    let header = ["quantity", "value", "unit"].map(str::to_owned);
    let lines = rows(impact).into_iter().map(|(name, value, unit)| {
        vec![name.replace('_', " "), six_digits(value), unit.to_owned()]
    });
    format!(
        "simulated: {}, contact ends at {}\n\n{}\n",
        impact.law,
        impact.end,
        table_text(&header, lines, &[0, 2])
    )
}

/// Below this a number of a table is rounding of zero; SI.
const ROUNDING: f64 = 1e-15;

/// Six significant digits.
fn six_digits(value: f64) -> String {
    let size = value.abs();
    if size < ROUNDING {
        return "0".to_owned();
    }
    if !(1e-4..1e6).contains(&size) {
        return format!("{value:.5e}");
    }
    let decimals = (5 - size.log10().floor() as i32).clamp(0, 12) as usize;
    format!("{value:.decimals$}")
}

/// A simulated impact as CSV, one row, units in the header.
///
/// # Errors
/// None in practice: the text is written to memory.
pub fn csv_of_simulation(impact: &SimulatedImpact) -> Result<String, Error> {
    let rows = rows(impact);
    let header: Vec<String> = rows
        .iter()
        .map(|(name, _, unit)| column(name, unit))
        .collect();
    csv_text(
        &header,
        [rows.iter().map(|(_, value, _)| value.to_string()).collect()],
    )
}

/// "peak_force_N"; no unit for a pure number.
fn column(name: &str, unit: &str) -> String {
    match unit {
        "1" => name.to_owned(),
        unit => format!("{name}_{}", unit.replace(['/', ' '], "_")),
    }
}

/// A simulated motion as CSV.
///
/// # Errors
/// None in practice: the text is written to memory.
pub fn csv_of_motion(motion: &SimulatedMotion) -> Result<String, Error> {
    let header = [
        "time_s",
        "displacement_m",
        "rate_m_s",
        "force_N",
        "acceleration_m_s2",
    ];
    let t = &motion.trajectory;
    let rows = (0..t.times.len()).map(|i| {
        [
            t.times[i],
            t.displacement[i],
            t.rate[i],
            t.force[i],
            t.acceleration[i],
        ]
        .map(|value| value.to_string())
        .to_vec()
    });
    csv_text(&header.map(str::to_owned), rows)
}

/// A simulated motion with its summary as JSON.
#[must_use]
pub fn json_of_motion(motion: &SimulatedMotion) -> serde_json::Value {
    let t = &motion.trajectory;
    let columns = [
        ("time", &t.times),
        ("displacement", &t.displacement),
        ("rate", &t.rate),
        ("force", &t.force),
        ("acceleration", &t.acceleration),
    ];
    let columns = Named(
        columns
            .map(|(name, values)| (name.to_owned(), values))
            .to_vec(),
    );
    serde_json::json!({ "simulated": true, "impact": motion.impact, "motion": columns })
}
