//! The rig of a campaign with its mass, weighed or from the recordings.

use crate::campaign::{Campaign, ImpactEntry, MassPlan, RigPlan};
use crate::error::Error;
use crate::extract_recording::extract_recording;
use crate::outcome::{FindingOutcome, MassOutcome};
use rayon::prelude::*;
use windfall_identify::rig::{Carriage, Rig};
use windfall_signal::impact::Measured;
use windfall_signal::mass::{Uncertain, mass_from_impulse, mean_mass};

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

/// The rig of a campaign.
///
/// A mass "from impulse" is one mass for the whole campaign: the weighted mean
/// over all impacts that show impulse and velocities.
///
/// # Errors
/// No impact shows the mass.
pub fn find_rig(campaign: &Campaign) -> Result<RigFound, Error> {
    match campaign.rig {
        RigPlan::Pendulum(pendulum) => Ok(known(Rig::Pendulum(pendulum), 0.0)),
        RigPlan::Carriage {
            mass: MassPlan::Given { value, sd },
            driving_acceleration,
            ..
        } => {
            let carriage = Carriage {
                mass: value,
                mass_sd: sd,
                driving_acceleration,
            };
            Ok(known(Rig::Carriage(carriage), sd))
        }
        RigPlan::Carriage {
            mass: MassPlan::FromImpulse,
            driving_acceleration,
            driving_acceleration_sd,
        } => {
            let driving = Uncertain {
                value: driving_acceleration,
                sd: driving_acceleration_sd,
            };
            from_impulse(campaign, driving)
        }
    }
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

fn from_impulse(campaign: &Campaign, driving: Uncertain) -> Result<RigFound, Error> {
    let measured: Vec<Result<Measured, String>> = campaign
        .impacts
        .par_iter()
        .map(|entry| measured_of(campaign, entry).map_err(|error| error.to_string()))
        .collect();
    let masses: Vec<Result<Uncertain, String>> = measured
        .iter()
        .zip(&campaign.impacts)
        .map(|(measured, entry)| {
            let measured = measured.as_ref().map_err(Clone::clone)?;
            let mass = mass_of(measured, driving.value);
            mass.map_err(|source| at_recording(campaign, entry, source).to_string())
        })
        .collect();
    let found: Vec<Uncertain> = masses.iter().flatten().copied().collect();
    let Some(mass) = mean_mass(&found) else {
        let first = masses.into_iter().find_map(Result::err).unwrap_or_default();
        return Err(Error::MassUnknown {
            path: campaign.directory.clone(),
            impacts: campaign.impacts.len(),
            first,
        });
    };
    // All impacts share the error of the driving acceleration: it does not
    // shrink with their number.
    let faster = driving.value + driving.sd;
    let shifted: Vec<Uncertain> = measured
        .iter()
        .flatten()
        .filter_map(|measured| mass_of(measured, faster).ok())
        .collect();
    let shift = mean_mass(&shifted).map_or(0.0, |shifted| shifted.value - mass.value);
    let mass = Uncertain {
        value: mass.value,
        sd: mass.sd.hypot(shift),
    };
    let findings = campaign
        .impacts
        .iter()
        .zip(&masses)
        .filter_map(|(entry, mass)| {
            let problem = mass.as_ref().err()?;
            let message = format!("{} took no part in finding the mass: {problem}", entry.id);
            Some(FindingOutcome {
                code: "no-mass".to_owned(),
                message,
            })
        })
        .collect();
    let rig = Rig::Carriage(Carriage {
        mass: mass.value,
        mass_sd: mass.sd,
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

fn measured_of(campaign: &Campaign, entry: &ImpactEntry) -> Result<Measured, Error> {
    extract_recording(campaign, entry, None).map(|(impact, _)| impact.measured)
}

/// Mass from one impact under a driving acceleration that is taken as exact.
fn mass_of(measured: &Measured, driving: f64) -> Result<Uncertain, windfall_signal::error::Error> {
    let driving = Uncertain {
        value: driving,
        sd: 0.0,
    };
    mass_from_impulse(measured, driving)
}

fn at_recording(
    campaign: &Campaign,
    entry: &ImpactEntry,
    source: windfall_signal::error::Error,
) -> Error {
    Error::Signal {
        path: crate::read_recording::recording_path(&campaign.files, entry),
        source: Box::new(source),
    }
}
