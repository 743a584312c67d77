//! `windfall simulate compression`: a campaign of slow compressions by a known
//! law, to try the program and to check it.

use crate::new_campaign::NewCampaign;
use clap::{Args, ValueHint};
use std::path::{Path, PathBuf};
use windfall_cards::law_use::chosen_law;
use windfall_contact::laws::kind::Law;
use windfall_files::error::Error;
use windfall_files::option_value::{at_least_zero, positive, unusable};
use windfall_files::table::write::csv_text;
use windfall_files::text::quote::string_text;
use windfall_signal::noise::gaussian::{noise_source, normal};

/// What is simulated; texts with units.
#[derive(Clone, Debug, Args)]
pub struct SimulateCompressionRequest {
    /// Force law of the crosshead's travel, with its parameters
    #[arg(long)]
    pub law: String,
    /// File of own laws ([laws.NAME] tables, as in campaign.toml) that --law can name
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub laws: Option<PathBuf>,
    /// Rate of deformation; may be repeated: every fruit is compressed at each
    #[arg(long = "rate", default_value = "1 mm/s")]
    pub rates: Vec<String>,
    /// Largest deformation
    #[arg(long, default_value = "2 mm")]
    pub deformation: String,
    /// Radius of the fruit
    #[arg(long, default_value = "38 mm")]
    pub radius: String,
    /// Plates that deform the fruit: 1 or 2
    #[arg(long, default_value_t = 2)]
    pub plates: u32,
    /// Force at which the tissue yields; never if left out
    #[arg(long)]
    pub yield_force: Option<String>,
    /// Number of fruit
    #[arg(long, default_value_t = 3)]
    pub fruit: usize,
    /// Spread of stiffness and damping between fruit, as a part
    #[arg(long, default_value_t = 0.0)]
    pub spread: f64,
    /// Standard deviation of the noise of force
    #[arg(long, default_value = "0.02 N")]
    pub force_noise: String,
    /// Sampling rate
    #[arg(long, default_value = "1 kHz")]
    pub sampling_rate: String,
    /// Seed of noise and spread
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

struct Plan {
    law: Law,
    rates: Vec<f64>,
    deformation: f64,
    yield_force: f64,
    force_noise: f64,
    sampling_rate: f64,
}

/// Most samples of a recording.
const MOST_SAMPLES: f64 = 1e6;

/// Stiffness after the yield, as a part of that before; the force falls.
const AFTER_YIELD: f64 = -0.3;

/// Time recorded before the plate touches, as a part of the loading.
const BEFORE: f64 = 0.1;

/// Writes a campaign directory with its recordings; the files written.
pub fn simulate_compression(
    directory: &Path,
    request: &SimulateCompressionRequest,
) -> Result<Vec<PathBuf>, Error> {
    let plan = plan(request)?;
    let radius = positive("--radius", &request.radius, "m")?;
    let mut new = NewCampaign::create(directory)?;
    let (mut specimens, mut rows) = (vec![], vec![]);
    for fruit in 0..request.fruit {
        let id = format!("fruit-{}", fruit + 1);
        let law = fruit_law(&plan.law, request, fruit);
        specimens.push(vec![id.clone(), (1e3 * radius).to_string()]);
        for (index, rate) in plan.rates.iter().enumerate() {
            let name = format!("{id}-{}.csv", index + 1);
            let stream = (fruit * plan.rates.len() + index) as u64;
            let text = recording(&plan, &law, *rate, (request.seed, stream + 1000))?;
            new.file(&format!("raw/{name}"), text)?;
            let number = format!("{id}-{}", index + 1);
            rows.push(vec![number, id.clone(), name, (1e3 * rate).to_string()]);
        }
    }
    let label = format!("{} at seed {}", request.law, request.seed);
    let law = plan.law.kind().name();
    new.file("campaign.toml", campaign(&label, request.plates, law))?;
    new.table("specimens.csv", &["id", "radius_mm"], specimens)?;
    let header = ["id", "specimen", "file", "rate_mm_s"];
    new.table("impacts.csv", &header, rows)?;
    new.end()
}

fn plan(request: &SimulateCompressionRequest) -> Result<Plan, Error> {
    let law = chosen_law(&request.law, request.laws.as_deref())?.law;
    let rates = request
        .rates
        .iter()
        .map(|rate| positive("--rate", rate, "m/s"));
    let rates = rates.collect::<Result<Vec<f64>, _>>()?;
    let deformation = positive("--deformation", &request.deformation, "m")?;
    let sampling_rate = positive("--sampling-rate", &request.sampling_rate, "Hz")?;
    if !(1..=2).contains(&request.plates) {
        return Err(unusable("--plates", "expected 1 or 2"));
    }
    if !(0.0..1.0).contains(&request.spread) {
        return Err(unusable("--spread", "expected a part from 0 to below 1"));
    }
    for rate in &rates {
        let samples = (1.0 + BEFORE) * deformation / rate * sampling_rate;
        if !(20.0..=MOST_SAMPLES).contains(&samples) {
            let problem = format!(
                "at {rate} m/s a recording would have {samples:.0} samples; between 20 and \
                 {MOST_SAMPLES:.0} are possible"
            );
            return Err(unusable("--sampling-rate", problem));
        }
    }
    let yield_force = match &request.yield_force {
        Some(text) => positive("--yield-force", text, "N")?,
        None => f64::INFINITY,
    };
    Ok(Plan {
        law,
        rates,
        deformation,
        yield_force,
        force_noise: at_least_zero("--force-noise", &request.force_noise, "N")?,
        sampling_rate,
    })
}

/// The law of one fruit: parameters with dimension spread log-normally together.
fn fruit_law(law: &Law, request: &SimulateCompressionRequest, fruit: usize) -> Law {
    let mut source = noise_source(request.seed, fruit as u64);
    let factor = (request.spread * normal(&mut source)).exp();
    let description = law.kind().describe();
    let values: Vec<f64> = law
        .parameters()
        .iter()
        .zip(description.parameters)
        .map(
            |(value, parameter)| match ["k", "c"].contains(&parameter.name) {
                true => value * factor,
                false => *value,
            },
        )
        .collect();
    law.kind().from_values(&values).unwrap_or(*law)
}

fn recording(plan: &Plan, law: &Law, rate: f64, seed: (u64, u64)) -> Result<String, Error> {
    let mut source = noise_source(seed.0, seed.1);
    let duration = plan.deformation / rate;
    let samples = ((1.0 + BEFORE) * duration * plan.sampling_rate) as usize;
    let mut yielded: Option<(f64, f64)> = None;
    let rows = (0..samples).map(|i| {
        let time = i as f64 / plan.sampling_rate;
        let travel = rate * (time - BEFORE * duration);
        let loading = match travel > 0.0 {
            true => law.force(travel, rate, travel).max(0.0),
            false => 0.0,
        };
        let force = match yielded {
            None if loading >= plan.yield_force => {
                yielded = Some((travel, loading));
                loading
            }
            None => loading,
            Some((at, force)) => (force * (1.0 + AFTER_YIELD * (travel - at) / at)).max(0.0),
        };
        let shown = force + plan.force_noise * normal(&mut source);
        // A crosshead that moves down shows falling positions.
        let position = 0.04 - travel;
        vec![
            format!("{time:.6}"),
            format!("{shown:.5}"),
            format!("{:.6}", 1e3 * position),
        ]
    });
    let header = ["time_s", "force_N", "position_mm"].map(str::to_owned);
    csv_text(&header, rows.collect::<Vec<_>>())
}

fn campaign(label: &str, plates: u32, law: &str) -> String {
    let [label, law] = [label, law].map(string_text);
    format!(
        "# Slow compressions made by windfall simulate compression.\n\
         format = 1\n\n\
         [campaign]\n\
         title = \"Simulated slow compressions\"\n\
         simulated = {label}\n\n\
         [rig]\n\
         kind = \"compression\"\n\
         plates = {plates}\n\
         poisson_ratio = 0.3\n\n\
         [files]\n\
         directory = \"raw\"\n\
         time = \"time_s\"\n\n\
         [channels.force]\n\
         column = \"force_N\"\n\
         unit = \"N\"\n\n\
         [channels.position]\n\
         column = \"position_mm\"\n\
         unit = \"mm\"\n\n\
         [fit]\n\
         laws = [{law}]\n"
    )
}
