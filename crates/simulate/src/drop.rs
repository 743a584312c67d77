//! `windfall simulate drop`: a fruit falls on a plate and bounces.

use crate::request::drop::{DropPlan, one_height};
use serde::Serialize;
use windfall_cards::law_use::end_name;
use windfall_cards::law_use::{LawUse, findings_of_use};
use windfall_contact::expression::LawExpression;
use windfall_contact::laws::kind::Law;
use windfall_drop_rig::rig::Plate;
use windfall_drop_rig::simulate::{DropImpact, DropTrajectory, drop_trajectory, simulate_drop};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::option_value::{positive, unusable};

/// Motion is shown up to this many mean contact durations after the last
/// separation; 1.
const MARGIN: f64 = 1.0;

/// Most samples of a motion.
const MOST_SAMPLES: f64 = 5e6;

/// One impact of a drop; SI, times from the release.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SimulatedBounce {
    /// First touch; s.
    pub onset_time: f64,
    /// Speed of approach of fruit and plate; m/s.
    pub impact_velocity: f64,
    /// Largest force between fruit and plate; N.
    pub peak_contact_force: f64,
    /// When; s.
    pub time_of_peak_contact_force: f64,
    /// Largest force on the plate's support about its static load; N.
    pub peak_support_force: f64,
    /// When; s.
    pub time_of_peak_support_force: f64,
    /// Largest indentation; m.
    pub max_displacement: f64,
    /// When; s.
    pub time_of_max_displacement: f64,
    /// The law's force is back at zero; s.
    pub force_end_time: Option<f64>,
    /// The gap opens; s. None where the fruit stays on the plate.
    pub separation_time: Option<f64>,
    /// Velocity of the fruit then, up positive; m/s.
    pub separation_velocity: Option<f64>,
    /// Speed of the fruit at separation over that at onset; 1.
    pub restitution: Option<f64>,
    /// The same of the point of contact, relative to the plate; 1.
    pub contact_restitution: Option<f64>,
    /// Integral of the contact force; N s.
    pub impulse: f64,
    /// Energy that the fruit loses; J.
    pub absorbed_energy: Option<f64>,
}

/// A plate in results; SI.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PlateOutcome {
    /// Mass; kg.
    pub mass: f64,
    /// Stiffness; N/m.
    pub stiffness: f64,
    /// Damping; N s/m.
    pub damping: f64,
}

/// A simulated drop; SI.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SimulatedDrop {
    /// The law.
    pub law: String,
    /// Mass of the fruit; kg.
    pub mass: f64,
    /// Part of it that the contact feels; 1.
    pub effective_mass_factor: f64,
    /// Drop height; m.
    pub height: f64,
    /// Acceleration of gravity; m/s².
    pub gravity: f64,
    /// The plate; `None` where it is rigid.
    pub plate: Option<PlateOutcome>,
    /// End of contact.
    pub end: &'static str,
    /// Impacts in order of time.
    pub impacts: Vec<SimulatedBounce>,
    /// From onset to onset; s.
    pub intervals: Vec<f64>,
    /// Whether the fruit comes to rest on the plate before the next impact.
    pub at_rest: bool,
    /// What a reader must know of the law and its use.
    pub findings: Vec<FindingOutcome>,
}

/// A simulated drop and its motion.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatedDropMotion {
    /// The drop.
    pub drop: SimulatedDrop,
    /// Its motion.
    pub trajectory: DropTrajectory,
}

/// Simulates one drop.
///
/// * `impacts`: how many are followed
///
/// # Errors
/// There is no impact to follow or more than one height, or it cannot be
/// simulated.
pub fn simulate_one_drop(plan: &DropPlan, impacts: usize) -> Result<SimulatedDrop, Error> {
    let height = one_height(plan)?;
    if impacts == 0 {
        return Err(unusable("--impacts", "expected 1 or more"));
    }
    let rig = &plan.rig;
    let summary = simulate_drop(&plan.law, rig, height, impacts, plan.end)
        .map_err(|source| failed(&plan.law, source))?;
    let used: Vec<LawUse> = summary
        .impacts
        .iter()
        .map(|impact| LawUse {
            impact_velocity: impact.impact_velocity,
            peak_force: impact.peak_contact_force,
            displacement: impact.max_displacement,
            mass: rig.mass,
        })
        .collect();
    Ok(SimulatedDrop {
        findings: findings_of_use(&plan.law, plan.range.as_ref(), &used),
        law: LawExpression::from(plan.law).to_string(),
        mass: rig.mass,
        effective_mass_factor: rig.effective_mass_factor,
        height,
        gravity: rig.gravity,
        plate: rig.plate.map(plate_outcome),
        end: end_name(plan.end),
        impacts: summary.impacts.iter().map(bounce).collect(),
        intervals: summary.intervals,
        at_rest: summary.at_rest,
    })
}

/// Simulates one drop with its motion, from the release to a little after the
/// last of its impacts.
///
/// * `rate`: samples per second, with unit
/// * `duration`: how long otherwise, with unit
///
/// # Errors
/// As [`simulate_one_drop`]; an option cannot be read.
pub fn simulate_drop_motion(
    plan: &DropPlan,
    impacts: usize,
    rate: &str,
    duration: Option<&str>,
) -> Result<SimulatedDropMotion, Error> {
    let drop = simulate_one_drop(plan, impacts)?;
    let times = motion_times(rate, duration, drop.impacts.last())?;
    let trajectory = drop_trajectory(&plan.law, &plan.rig, drop.height, &times, plan.end)
        .map_err(|source| failed(&plan.law, source))?;
    Ok(SimulatedDropMotion { drop, trajectory })
}

/// Times of a motion: up to `duration`, or to a little after the last impact.
pub(crate) fn motion_times(
    rate: &str,
    duration: Option<&str>,
    last: Option<&SimulatedBounce>,
) -> Result<Vec<f64>, Error> {
    let rate = positive("--sampling-rate", rate, "Hz")?;
    let duration = match duration {
        Some(text) => positive("--duration", text, "s")?,
        None => last.map_or(0.0, last_separation),
    };
    let samples = (duration * rate).ceil();
    if samples > MOST_SAMPLES {
        let problem = format!("{samples} samples; expected a motion of up to {MOST_SAMPLES}");
        return Err(unusable("--sampling-rate, --duration", problem));
    }
    Ok((0..=samples as usize).map(|i| i as f64 / rate).collect())
}

/// A little after the last separation, or after the last peak of a fruit that
/// stays; s.
fn last_separation(last: &SimulatedBounce) -> f64 {
    let peak = last.time_of_peak_contact_force;
    let end = last.separation_time.unwrap_or(peak);
    end + MARGIN * (end - last.onset_time)
}

pub(crate) fn failed(law: &Law, source: windfall_identify::error::Error) -> Error {
    Error::Identify {
        subject: LawExpression::from(*law).to_string(),
        source: Box::new(source),
    }
}

pub(crate) fn plate_outcome(plate: Plate) -> PlateOutcome {
    PlateOutcome {
        mass: plate.mass,
        stiffness: plate.stiffness,
        damping: plate.damping,
    }
}

pub(crate) fn bounce(impact: &DropImpact) -> SimulatedBounce {
    let known = |value: f64| value.is_finite().then_some(value);
    SimulatedBounce {
        onset_time: impact.onset_time,
        impact_velocity: impact.impact_velocity,
        peak_contact_force: impact.peak_contact_force,
        time_of_peak_contact_force: impact.time_of_peak_contact_force,
        peak_support_force: impact.peak_support_force,
        time_of_peak_support_force: impact.time_of_peak_support_force,
        max_displacement: impact.max_displacement,
        time_of_max_displacement: impact.time_of_max_displacement,
        force_end_time: known(impact.force_end_time),
        separation_time: known(impact.separation_time),
        separation_velocity: known(impact.separation_velocity),
        restitution: known(impact.restitution),
        contact_restitution: known(impact.contact_restitution),
        impulse: impact.impulse,
        absorbed_energy: known(impact.absorbed_energy),
    }
}
