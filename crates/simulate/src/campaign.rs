//! A whole simulated campaign: recordings as the instrument would have written
//! them, with tables, campaign.toml and the parameters that were drawn.

use crate::files::{SimulatedCampaign, campaign_text, rates, recording_text};
use crate::impact::failed;
use crate::new_campaign::NewCampaign;
use std::path::Path;
use windfall_contact::expression::LawExpression;
use windfall_contact::laws::kind::{Law, LawKind};
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_identify::rig::simulate::{simulate_rig, trajectory};
use windfall_signal::instrument::record;
use windfall_signal::noise::gaussian::{NoiseSource, noise_source, normal, uniform};

/// Recorded before first touch and after separation; s.
const LEAD: f64 = 3e-3;

/// Samples of the slowest channel before first touch and after separation.
const LEAD_SAMPLES: f64 = 20.0;

/// Points of the motion in a contact, at least: sensors are sampled from it.
const MOTION_SAMPLES: f64 = 200.0;

/// Stream of the seed that specimens are drawn from; the instrument uses others.
const SPECIMEN_STREAM: u64 = 100;

/// Draws after which a parameter that must be positive counts as impossible.
const MOST_DRAWS: usize = 1000;

/// Specimens of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Batch {
    /// Name of the kind, and start of the ids.
    pub variety: String,
    /// Law with the mean parameters.
    pub law: Law,
    /// Standard deviation between specimens, per parameter of the law; SI.
    pub spread: Vec<f64>,
    /// Number of specimens.
    pub specimens: usize,
    /// Impacts on each.
    pub repeats: usize,
}

/// Writes a campaign of simulated recordings into a new directory.
///
/// Every impact has its own seed, so that adding specimens at the end leaves
/// the others as they are. Returns the number of recordings.
///
/// # Errors
/// The directory is not empty, a file cannot be written, a law has parameters
/// that cannot be simulated.
pub fn write_simulated_campaign(
    directory: &Path,
    campaign: &SimulatedCampaign,
    batches: &[Batch],
) -> Result<usize, Error> {
    let mut new = NewCampaign::create(directory)?;
    let (mut specimens, mut impacts, mut truth) = (vec![], vec![], vec![]);
    let mut specimen_number = 0;
    let mut recordings = 0;
    for batch in batches {
        for specimen in 0..batch.specimens {
            specimen_number += 1;
            let id = format!("{}-{:02}", batch.variety.replace(' ', "-"), specimen + 1);
            let mut source = noise_source(campaign.seed, SPECIMEN_STREAM + specimen_number);
            let law = drawn(batch, &mut source)?;
            specimens.push(vec![id.clone(), batch.variety.clone()]);
            for repeat in 0..batch.repeats {
                let impact = match batch.repeats {
                    1 => id.clone(),
                    _ => format!("{id}-{:02}", repeat + 1),
                };
                let file = format!("{impact}.csv");
                let seed = seed_of(campaign.seed, specimen_number, repeat as u64);
                let text = recording(campaign, &law, &mut source, seed)?;
                new.file(&format!("raw/{file}"), text)?;
                impacts.push(vec![impact.clone(), id.clone(), file]);
                let law = LawExpression::from(law).to_string();
                truth.push(vec![impact, id.clone(), law]);
                recordings += 1;
            }
        }
    }
    new.table("specimens.csv", &["id", "variety"], specimens)?;
    new.table("impacts.csv", &["id", "specimen", "file"], impacts)?;
    new.table("truth.csv", &["id", "specimen", "law"], truth)?;
    let law = batches.first().map(|batch| batch.law.kind());
    let toml = campaign_text(campaign, law.unwrap_or(LawKind::KuwabaraKono));
    new.file("campaign.toml", toml)?;
    new.end()?;
    Ok(recordings)
}

/// A seed per impact (splitmix64 of Steele, Lea and Flood 2014, chained).
pub fn seed_of(seed: u64, specimen: u64, repeat: u64) -> u64 {
    [specimen, repeat].into_iter().fold(seed, |state, part| {
        let mut z = state.wrapping_add(part.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    })
}

/// The law of one specimen: normal parameters within the law's bounds.
///
/// # Errors
/// No draw is within the bounds.
pub fn drawn(batch: &Batch, source: &mut NoiseSource) -> Result<Law, Error> {
    let (kind, means) = (batch.law.kind(), batch.law.parameters());
    for _ in 0..MOST_DRAWS {
        let values: Vec<f64> = means
            .iter()
            .zip(&batch.spread)
            .map(|(mean, sd)| {
                if *sd > 0.0 {
                    mean + sd * normal(source)
                } else {
                    *mean
                }
            })
            .collect();
        if let Ok(law) = kind.with_parameters(&values) {
            return Ok(law);
        }
    }
    let problem = format!(
        "{MOST_DRAWS} draws around {} all fell outside the bounds of the law; \
         give a smaller standard deviation",
        LawExpression::from(batch.law)
    );
    Err(unusable("--spread", problem))
}

/// One recording as the instrument would have written it.
fn recording(
    campaign: &SimulatedCampaign,
    law: &Law,
    source: &mut NoiseSource,
    seed: u64,
) -> Result<String, Error> {
    let rig = &campaign.rig;
    let failed = |source| failed(law, source);
    let summary = simulate_rig(law, rig, campaign.velocity, campaign.end).map_err(failed)?;
    let duration = summary.contact_duration;
    let rates = rates(&campaign.instrument);
    let fastest = rates.iter().copied().fold(0.0, f64::max);
    let slowest = rates.iter().copied().fold(f64::INFINITY, f64::min);
    let lead = LEAD.max(LEAD_SAMPLES / slowest);
    // The clock of the instrument knows nothing of the first touch.
    let start = -lead - uniform(source) / slowest;
    let rate = fastest.max(MOTION_SAMPLES / duration);
    let count = ((duration + 2.0 * lead) * rate).ceil() as usize;
    let times: Vec<f64> = (0..count).map(|i| start + i as f64 / rate).collect();
    let motion = trajectory(law, rig, campaign.velocity, &times, campaign.end).map_err(failed)?;
    let channels = record(&motion, &campaign.instrument, seed)
        .map_err(|source| Error::signal("the simulated recording".into(), source))?;
    Ok(recording_text(&channels))
}
