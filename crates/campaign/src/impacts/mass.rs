//! The rig of a campaign with its mass, weighed or from the recordings.

use crate::error::CampaignError;
use crate::recording::extract::extract_recording;
use crate::recording::read::recording_path;
use crate::result::counted::{FAR, FEWEST, NEAR, excluded};
use crate::result::outcome::MassOutcome;
use crate::settings::model::{ImpactCampaign, ImpactEntry, MassPlan, RigPlan};
use rayon::prelude::*;
use windfall_files::error::Error;
use windfall_files::found::{FindingOutcome, robust_spread};
use windfall_files::severity::Severity;
use windfall_files::text::number::plain;
use windfall_identify::rig::kind::{Carriage, Rig};
use windfall_signal::Finding;
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
/// over all impacts that count and show impulse and velocities.
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
    let found: Vec<Measured> = all_measured(campaign, driving)
        .into_iter()
        .flatten()
        .collect();
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
    let measured = all_measured(campaign, driving);
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

/// What each impact measured that shows the mass, or why it takes no part: an impact that does not
/// count does not weigh, nor does one that is far from the others.
fn all_measured(campaign: &ImpactCampaign, driving: Uncertain) -> Vec<Result<Measured, String>> {
    let entries = campaign.shared.entries.par_iter();
    let all = entries.map(|entry| measured(campaign, entry, driving));
    let mut all: Vec<Result<Measured, String>> = all.collect();
    let mass = |own: &Measured| mass_from_impulse(own, driving).map(|mass| mass.value.ln());
    let masses: Vec<f64> = all
        .iter()
        .flatten()
        .filter_map(|own| mass(own).ok())
        .collect();
    let Some((middle, deviation)) = robust_spread(&masses).filter(|_| masses.len() >= FEWEST)
    else {
        return all;
    };
    let far = (FAR * deviation).max(NEAR);
    for own in &mut all {
        let away = own.as_ref().ok().and_then(|own| mass(own).ok());
        let away = away.map_or(0.0, |mass| mass - middle);
        if away.abs() > far {
            *own = Err(format!(
                "it gives {} times the median mass of all impacts: look at its signals",
                plain(away.exp())
            ));
        }
    }
    all
}

/// What an impact that shows the mass measured, or why it takes no part.
fn measured(
    campaign: &ImpactCampaign,
    entry: &ImpactEntry,
    driving: Uncertain,
) -> Result<Measured, String> {
    if let Some(reason) = excluded(entry) {
        return Err(reason.message);
    }
    let extracted = extract_recording(campaign, entry, None);
    let (impact, findings) = extracted.map_err(|error| error.to_string())?;
    let wrong = |own: &&Finding| Severity::of(own.code()) == Severity::Wrong;
    if let Some(finding) = findings.iter().find(wrong) {
        return Err(finding.to_string());
    }
    match mass_from_impulse(&impact.measured, driving) {
        Ok(_) => Ok(impact.measured),
        Err(source) => {
            let path = recording_path(&campaign.shared.files, entry);
            Err(Error::signal(path, source).to_string())
        }
    }
}
