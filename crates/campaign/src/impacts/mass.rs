//! The rig of a campaign with its mass, weighed or from the recordings.

use crate::error::CampaignError;
use crate::recording::extract::extract_recording;
use crate::recording::read::recording_path;
use crate::result::outcome::MassOutcome;
use crate::settings::model::{ImpactCampaign, ImpactEntry, MassPlan, RigPlan};
use rayon::prelude::*;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_identify::rig::kind::{Carriage, Rig};
use windfall_signal::impact::Measured;
use windfall_signal::mass::{mass_from_impulse, mass_from_impulses};
use windfall_signal::uncertain::Uncertain;

/// The rig, and what is to be said about its mass.
#[derive(Clone, Debug)]
pub struct RigFound {
    /// The rig.
    pub rig: Rig,
    /// Mass that the contact feels.
    pub mass: MassOutcome,
    /// Impacts that could not take part in finding the mass.
    pub findings: Vec<FindingOutcome>,
}

/// The rig of a campaign as it is told.
///
/// A mass "from impulse" is one mass for the whole campaign: the weighted mean
/// over all impacts that show impulse and velocities.
///
/// # Errors
/// No impact shows the mass.
pub(crate) fn rig_of(campaign: &ImpactCampaign) -> Result<RigFound, Error> {
    match campaign.rig {
        RigPlan::Pendulum(pendulum) => Ok(known(Rig::Pendulum(pendulum), 0.0)),
        RigPlan::Carriage {
            mass: MassPlan::Given { value, sd },
            driving_acceleration,
            ..
        } => {
            let carriage = Carriage {
                mass: value,
                driving_acceleration,
            };
            Ok(known(Rig::Carriage(carriage), sd))
        }
        RigPlan::Carriage {
            mass: MassPlan::FromImpulse,
            driving_acceleration,
            driving_acceleration_sd,
        } => {
            let driving = Uncertain::new(driving_acceleration, driving_acceleration_sd);
            from_impulse(campaign, driving)
        }
    }
}

/// The mass that impulse and momentum of the impacts say that a contact feels, whatever
/// campaign.toml says of it; `None` where no impact shows it. Of a pendulum it is inertia over
/// arm squared; its weight takes part by less than what the impulse is known to.
pub fn mass_by_impulse(campaign: &ImpactCampaign) -> Option<MassOutcome> {
    let driving = match campaign.rig {
        RigPlan::Pendulum(_) => Uncertain::new(0.0, 0.0),
        RigPlan::Carriage {
            driving_acceleration,
            driving_acceleration_sd,
            ..
        } => Uncertain::new(driving_acceleration, driving_acceleration_sd),
    };
    let entries = campaign.shared.entries.par_iter();
    let found = entries.filter_map(|entry| measured(campaign, entry, driving).ok());
    let found: Vec<Measured> = found.collect();
    let mass = mass_from_impulses(&found, driving)?;
    Some(MassOutcome {
        value: mass.value,
        sd: mass.sd,
        impacts: found.len(),
    })
}

fn known(rig: Rig, sd: f64) -> RigFound {
    let mass = MassOutcome {
        value: rig.effective_mass(),
        sd,
        impacts: 0,
    };
    RigFound {
        rig,
        mass,
        findings: Vec::new(),
    }
}

fn from_impulse(campaign: &ImpactCampaign, driving: Uncertain) -> Result<RigFound, Error> {
    let measured: Vec<Result<Measured, String>> = campaign
        .shared
        .entries
        .par_iter()
        .map(|entry| measured(campaign, entry, driving).map_err(|error| error.to_string()))
        .collect();
    let found: Vec<Measured> = measured.iter().flatten().copied().collect();
    let Some(mass) = mass_from_impulses(&found, driving) else {
        let first = measured
            .into_iter()
            .find_map(Result::err)
            .unwrap_or_default();
        return Err(Error::from(CampaignError::MassUnknown {
            path: campaign.shared.directory.clone(),
            impacts: campaign.shared.entries.len(),
            first,
        }));
    };
    let findings = campaign
        .shared
        .entries
        .iter()
        .zip(&measured)
        .filter_map(|(entry, measured)| {
            let problem = measured.as_ref().err()?;
            let message = format!("{} took no part in finding the mass: {problem}", entry.id);
            Some(FindingOutcome::new("no-mass", message))
        })
        .collect();
    let rig = Rig::Carriage(Carriage {
        mass: mass.value,
        driving_acceleration: driving.value,
    });
    let mass = MassOutcome {
        value: mass.value,
        sd: mass.sd,
        impacts: found.len(),
    };
    Ok(RigFound {
        rig,
        mass,
        findings,
    })
}

/// What an impact that shows the mass measured.
fn measured(
    campaign: &ImpactCampaign,
    entry: &ImpactEntry,
    driving: Uncertain,
) -> Result<Measured, Error> {
    let (impact, _) = extract_recording(campaign, entry, None)?;
    mass_from_impulse(&impact.measured, driving)
        .map(|_| impact.measured)
        .map_err(|source| Error::signal(recording_path(&campaign.shared.files, entry), source))
}
