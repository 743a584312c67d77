//! `windfall simulate`: one event from a force law.

use serde::Serialize;
use windfall_cards::law_card::CardRange;
use windfall_cards::law_use::{LawUse, findings_of_use};
use windfall_contact::expression::LawExpression;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::Law;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_identify::rig::kind::Rig;
use windfall_identify::rig::simulate::{ImpactSummary, Trajectory, simulate_rig, trajectory};

/// What is kept of the motion before and after contact, as a part of its duration.
const MARGIN: f64 = 0.25;

/// One simulated impact: the keys of the JSON that scripts rely on; SI.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
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
    /// Work of gravity or the driving acceleration over the contact, which the fruit takes up
    /// beside the kinetic energy: ∫ F dx is the sum of both.
    pub driving_work: f64,
    /// Integral of the force over the contact.
    pub impulse: f64,
    /// What a reader must know of the law and its use.
    pub findings: Vec<FindingOutcome>,
}

/// A simulated motion with its summary.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatedMotion {
    /// The impact in numbers.
    pub impact: SimulatedImpact,
    /// The motion at evenly spaced times.
    pub trajectory: Trajectory,
}

/// Simulates one impact of a rig.
///
/// * `range`: in what the law was seen, where that is known
///
/// # Errors
/// The rig or the velocity has no physical value, or the bodies do not part.
pub fn simulate_one(
    law: &Law,
    rig: &Rig,
    velocity: f64,
    end: EndRule,
    range: Option<&CardRange>,
) -> Result<SimulatedImpact, Error> {
    let summary = simulate_rig(law, rig, velocity, end).map_err(|source| failed(law, source))?;
    let mut impact = simulated(law, rig, velocity, end, &summary);
    let used = LawUse {
        impact_velocity: velocity,
        peak_force: impact.peak_force,
        displacement: impact.max_displacement,
        mass: impact.effective_mass,
    };
    impact.findings = findings_of_use(law, range, &[used]);
    Ok(impact)
}

/// Simulates one impact of a rig with its motion, sampled at a rate, from a
/// little before contact to a little after.
///
/// * `rate`: samples per second; Hz
pub fn simulate_motion(
    law: &Law,
    rig: &Rig,
    velocity: f64,
    (rate, end): (f64, EndRule),
    range: Option<&CardRange>,
) -> Result<SimulatedMotion, Error> {
    let impact = simulate_one(law, rig, velocity, end, range)?;
    let margin = (MARGIN * impact.contact_duration * rate).ceil();
    let last = ((1.0 + MARGIN) * impact.contact_duration * rate).ceil();
    let times: Vec<f64> = (0..=(margin + last) as usize)
        .map(|i| (i as f64 - margin) / rate)
        .collect();
    let trajectory = motion_at(law, rig, velocity, end, &times)?;
    Ok(SimulatedMotion { impact, trajectory })
}

/// The motion of one impact of a rig at given times.
///
/// * `times`: from first touch, ascending; s
pub fn motion_at(
    law: &Law,
    rig: &Rig,
    velocity: f64,
    end: EndRule,
    times: &[f64],
) -> Result<Trajectory, Error> {
    trajectory(law, rig, velocity, times, end).map_err(|source| failed(law, source))
}

/// The error of a law that cannot be simulated.
pub(crate) fn failed(law: &Law, source: windfall_identify::error::Error) -> Error {
    Error::identify(LawExpression::from(*law).to_string(), source)
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
        end: windfall_cards::law_use::end_name(end),
        peak_force: summary.peak_force,
        time_of_peak_force: summary.time_of_peak_force,
        max_displacement: summary.max_displacement,
        time_of_max_displacement: summary.time_of_max_displacement,
        contact_duration: summary.contact_duration,
        final_displacement: summary.final_displacement,
        separation_velocity: summary.separation_velocity,
        restitution: summary.restitution,
        nominal_restitution: law.nominal_restitution(),
        absorbed_energy: summary.absorbed_energy,
        driving_work: rig.driving_work(summary.final_displacement),
        impulse: summary.impulse,
        findings: Vec::new(),
    }
}
