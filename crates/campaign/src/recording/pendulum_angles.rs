//! Energies and velocities of a pendulum from the angles of release and rebound
//! in impacts.csv.

use crate::result::outcome::ImpactOutcome;
use crate::settings::model::{ImpactCampaign, ImpactEntry, RigPlan};
use windfall_files::error::{Error, Place};
use windfall_files::found::FindingOutcome;
use windfall_files::text::cell_quantity::cell_quantity;
use windfall_signal::energy_angles::{pendulum_energy, speed_of_energy};

/// Relative difference of velocities from which they disagree; 1.
const DISAGREES: f64 = 0.05;

/// Angles of release and rebound from the vertical, where impacts.csv has them; rad.
///
/// # Errors
/// A cell is no positive number.
pub fn angles_of_entry(
    campaign: &ImpactCampaign,
    entry: &ImpactEntry,
) -> Result<[Option<f64>; 2], Error> {
    let file = campaign.shared.directory.join("impacts.csv");
    let place = Place::at(&file, entry.line);
    let angle = |name| cell_quantity(&entry.cells, name, "rad", &place);
    Ok([angle("release_angle")?, angle("rebound_angle")?])
}

/// Adds what the angles tell to a result; nothing for another rig.
///
/// # Errors
/// A cell is no positive number.
pub fn add_angles(
    campaign: &ImpactCampaign,
    entry: &ImpactEntry,
    outcome: &mut ImpactOutcome,
) -> Result<(), Error> {
    let [release, rebound] = angles_of_entry(campaign, entry)?;
    let RigPlan::Pendulum(rig) = campaign.rig else {
        return Ok(());
    };
    let mass = rig.inertia / (rig.arm * rig.arm);
    let energy = |angle| pendulum_energy(rig.mass, rig.gravity, rig.centre_of_mass, angle);
    let speed = |angle| speed_of_energy(energy(angle), mass);
    let mut push = |name: &str, value: f64| {
        outcome.derived.push(name, Some(value));
        outcome.derived_from.push(name, "angles".into());
    };
    if let Some(angle) = release {
        push("impact_energy_from_angle", energy(angle));
        push("impact_velocity_from_angle", speed(angle));
    }
    if let Some(angle) = rebound {
        push("elastic_energy_from_angle", energy(angle));
        push("rebound_velocity_from_angle", speed(angle));
    }
    if let (Some(release), Some(rebound)) = (release, rebound) {
        let absorbed = energy(release) - energy(rebound);
        push("absorbed_energy_from_angles", absorbed);
    }
    for (velocity, angle) in [("impact_velocity", release), ("rebound_velocity", rebound)] {
        let (Some(read), Some(angle)) = (outcome.derived(velocity), angle) else {
            continue;
        };
        let expected = speed(angle);
        if (read / expected - 1.0).abs() > DISAGREES {
            let message = format!(
                "the {} of {read:.4} m/s and the angle of {:.2}°, which gives {expected:.4} m/s, \
                     disagree; check angle, mass, centre of mass and inertia, and friction of the pivot",
                velocity.replace('_', " "),
                angle.to_degrees()
            );
            outcome
                .findings
                .push(FindingOutcome::new("angle-disagrees", message));
        }
    }
    Ok(())
}
