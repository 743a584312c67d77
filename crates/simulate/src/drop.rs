//! `windfall simulate drop`: a fruit falls on a plate and bounces.

use crate::impact::failed;
use crate::request::drop::{DropPlan, one_height};
use serde::Serialize;
use windfall_cards::law_use::end_name;
use windfall_cards::law_use::{LawUse, findings_of_use};
use windfall_contact::expression::LawExpression;
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

/// A simulated drop; SI.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
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
    pub plate: Option<Plate>,
    /// End of contact.
    pub end: &'static str,
    /// Impacts in order of time.
    pub impacts: Vec<DropImpact>,
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
/// # Errors
/// There is no impact to follow or more than one height, or it cannot be
/// simulated.
pub fn simulate_one_drop(plan: &DropPlan) -> Result<SimulatedDrop, Error> {
    let height = one_height(plan)?;
    let rig = &plan.rig;
    let summary = simulate_drop(&plan.law, rig, height, plan.impacts, plan.end)
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
        plate: rig.plate,
        end: end_name(plan.end),
        impacts: summary.impacts,
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
    rate: &str,
    duration: Option<&str>,
) -> Result<SimulatedDropMotion, Error> {
    let drop = simulate_one_drop(plan)?;
    let times = motion_times(rate, duration, drop.impacts.last())?;
    let trajectory = drop_trajectory(&plan.law, &plan.rig, drop.height, &times, plan.end)
        .map_err(|source| failed(&plan.law, source))?;
    Ok(SimulatedDropMotion { drop, trajectory })
}

/// Times of a motion: up to `duration`, or to a little after the last impact.
pub(crate) fn motion_times(
    rate: &str,
    duration: Option<&str>,
    last: Option<&DropImpact>,
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
fn last_separation(last: &DropImpact) -> f64 {
    let peak = last.time_of_peak_contact_force;
    let end = match last.separation_time.is_finite() {
        true => last.separation_time,
        false => peak,
    };
    end + MARGIN * (end - last.onset_time)
}
