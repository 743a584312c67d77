//! The rig of a campaign, with the quantities that are estimated over all impacts before any
//! law is fitted.

use crate::error::CampaignError;
use crate::impacts::mass::{RigFound, rig_of};
use crate::impacts::response::estimate_response;
use crate::recording::extract::extract_recording;
use crate::result::bench::{COARSEST, pooled};
use crate::result::counted::excluded;
use crate::settings::bench::is_of_response;
use crate::settings::model::{BenchFound, ImpactCampaign, MassPlan, RigPlan};
use rayon::prelude::*;
use windfall_files::error::Error;
use windfall_identify::rig::bench::BenchQuantity;
use windfall_identify::rig::kind::Rig;
use windfall_signal::impact::Measured;
use windfall_signal::recording::Quantity;
use windfall_signal::uncertain::Uncertain;

/// Deviations by which impacts may differ from what campaign.toml says with its uncertainty.
const CONTRADICTS: f64 = 5.0;

/// The rig of a campaign, with what of it is estimated; its uncertainties go to the fits.
///
/// # Errors
/// No impact shows the mass; fewer than five tell what is to be estimated, or they contradict
/// what campaign.toml says.
pub fn find_rig(campaign: &mut ImpactCampaign) -> Result<RigFound, Error> {
    estimate_bench(campaign)?;
    let found = rig_of(campaign)?;
    let bench = &mut campaign.bench.sd;
    if matches!(found.rig, Rig::Carriage(_)) {
        *bench = bench.with(BenchQuantity::Mass, found.mass.sd);
        // Of an impulse that reads 1 % more follows a mass that is 1 % larger.
        if found.mass.impacts > 0 {
            bench.tied = Some(BenchQuantity::Mass);
        }
    }
    campaign.fit.options.bench = *bench;
    Ok(found)
}

/// Estimates what `[fit] estimate` names, and puts it in the place of what campaign.toml says.
///
/// Newton's law tells gain and delay of the force beside the displacement in each impact, and
/// no law of the fruit enters ([`windfall_signal::impact::Measured::force_gain`]). Over the
/// impacts they are averaged by their deviations, without those that are far from the others;
/// what campaign.toml gives with an uncertainty is averaged with them.
///
/// # Errors
/// Fewer than five impacts tell a quantity, or they contradict what is given with an
/// uncertainty.
pub(crate) fn estimate_bench(campaign: &mut ImpactCampaign) -> Result<(), Error> {
    let asked = std::mem::take(&mut campaign.bench.estimate);
    if asked.is_empty() {
        return Ok(());
    }
    let rig = rig_of(campaign)?.rig;
    estimate_response(campaign, &rig, &asked)?;
    let entries = campaign.shared.entries.par_iter();
    let entries = entries.filter(|entry| excluded(entry).is_none());
    let mass = Some(rig.effective_mass());
    let extracted = entries.filter_map(|entry| extract_recording(campaign, entry, mass).ok());
    let measured: Vec<Measured> = extracted.map(|(impact, _)| impact.measured).collect();
    for quantity in asked.into_iter().filter(|own| !is_of_response(*own)) {
        let (name, pooled_name) = match quantity {
            BenchQuantity::ForceDelay => ("delay", "force_delay"),
            _ => ("gain", "force_gain"),
        };
        let of = |own: &Measured| {
            let (value, sd) = match quantity {
                BenchQuantity::ForceDelay => (own.force_delay?, own.force_delay_sd?),
                _ => (own.force_gain?, own.force_gain_sd?),
            };
            let sharpness = (own.resolution?, own.contact_duration?);
            (sd > 0.0).then(|| (Uncertain::new(value, sd), sharpness))
        };
        let own: Vec<_> = measured.iter().filter_map(of).collect();
        let told = own.iter().filter(|(_, own)| own.0 <= COARSEST).count();
        let found = pooled(pooled_name, own);
        let Some(found) = found else {
            return Err(Error::from(CampaignError::BenchUntold {
                path: campaign.shared.directory.clone(),
                quantity: quantity.name(),
                what: name,
                told,
            }));
        };
        let value = with_prior(campaign, quantity, Uncertain::new(found.value, found.sd))?;
        apply(campaign, quantity, value, found.impacts);
    }
    Ok(())
}

/// The mean of what impacts say of gain or delay, and of what campaign.toml says with an
/// uncertainty.
fn with_prior(
    campaign: &ImpactCampaign,
    quantity: BenchQuantity,
    found: Uncertain,
) -> Result<Uncertain, Error> {
    let sd = campaign.bench.sd.of(quantity);
    if sd == 0.0 {
        return Ok(found);
    }
    // Gains are of the value that is told, delays beside it.
    let (perfect, unit) = match quantity {
        BenchQuantity::ForceDelay => (0.0, 1.0),
        _ => (1.0, told(campaign, quantity)),
    };
    let prior = Uncertain::new(perfect, sd / unit);
    if (found.value - perfect).abs() > CONTRADICTS * found.sd.hypot(prior.sd) {
        let value = told(campaign, quantity);
        let impacts = match quantity {
            BenchQuantity::ForceDelay => value + found.value,
            _ => value * found.value,
        };
        return Err(Error::from(CampaignError::BenchContradicted {
            path: campaign.shared.directory.clone(),
            quantity: quantity.name(),
            unit: quantity.unit(),
            told: [value, sd],
            found: [impacts, found.sd * unit],
        }));
    }
    let weights = [prior, found].map(|own| 1.0 / (own.sd * own.sd));
    let total = weights[0] + weights[1];
    let mean = (weights[0] * prior.value + weights[1] * found.value) / total;
    Ok(Uncertain::new(mean, 1.0 / total.sqrt()))
}

/// What campaign.toml says.
fn told(campaign: &ImpactCampaign, quantity: BenchQuantity) -> f64 {
    let mut plans = campaign.shared.files.channels.iter();
    match (quantity, campaign.rig) {
        (BenchQuantity::Inertia, RigPlan::Pendulum(rig)) => rig.inertia,
        (
            BenchQuantity::Mass,
            RigPlan::Carriage {
                mass: MassPlan::Given { value, .. },
                ..
            },
        ) => value,
        (BenchQuantity::ForceDelay, _) => plans
            .find(|plan| plan.quantity == Quantity::Force)
            .map_or(0.0, |plan| plan.delay),
        _ => 1.0,
    }
}

/// Puts an estimate in the place of what campaign.toml says.
///
/// * `found`: gain, 1; or delay beside that of campaign.toml, s
fn apply(campaign: &mut ImpactCampaign, quantity: BenchQuantity, found: Uncertain, impacts: usize) {
    let told = told(campaign, quantity);
    let (value, sd) = match quantity {
        BenchQuantity::ForceDelay => (told + found.value, found.sd),
        _ => (told * found.value, told * found.sd),
    };
    let forces = campaign.shared.files.channels.iter_mut();
    let mut forces = forces.filter(|plan| plan.quantity == Quantity::Force);
    match (quantity, &mut campaign.rig) {
        (BenchQuantity::Inertia, RigPlan::Pendulum(rig)) => rig.inertia = value,
        (BenchQuantity::Mass, RigPlan::Carriage { mass, .. }) => {
            *mass = MassPlan::Given { value, sd };
        }
        (BenchQuantity::ForceGain, _) => forces.for_each(|plan| plan.scale /= value),
        (BenchQuantity::ForceDelay, _) => {
            if let Some(plan) = forces.next() {
                plan.delay = value;
            }
        }
        _ => (),
    }
    let bench = &mut campaign.bench;
    // The force is read with the new gain, which is known to this part of itself.
    let of_fits = match quantity {
        BenchQuantity::ForceGain => sd / value,
        _ => sd,
    };
    bench.sd = bench.sd.with(quantity, of_fits);
    if quantity != BenchQuantity::ForceDelay {
        bench.sd.tied = Some(quantity);
    }
    bench.found.push(BenchFound {
        quantity,
        value,
        sd,
        told: Some(told),
        impacts,
    });
}
