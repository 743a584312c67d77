//! `windfall simulate drop DIR`: recordings of drops on a plate as a load cell
//! writes them, to try the program and to check it.

use crate::campaign::{Batch, drawn, seed_of};
use crate::files::recording_text;
use crate::impact::failed;
use crate::new_campaign::NewCampaign;
use crate::request::drop::DropPlan;
use crate::request::recordings::spread;
use clap::Args;
use std::path::Path;
use windfall_cards::law_use::end_name;
use windfall_cards::user_laws::text::law_table;
use windfall_contact::expression::LawExpression;
use windfall_contact::laws::kind::Law;
use windfall_drop_rig::rig::DropRig;
use windfall_drop_rig::simulate::{DropSummary, drop_trajectory, simulate_drop};
use windfall_files::error::Error;
use windfall_files::option_value::{at_least_zero, positive, quantity, unusable};
use windfall_files::text::quote::string_text;
use windfall_signal::instrument::{Converter, Instrument, Sensor, Trajectory, record};
use windfall_signal::noise::gaussian::{NoiseSource, noise_source, normal, uniform};

/// Stream of the seed that fruit are drawn from; the instrument uses others.
const FRUIT_STREAM: u64 = 100;

/// Recorded before the release: from here to twice of it; s.
const LEAD: f64 = 0.05;

/// Bounces listed in truth.csv.
const TOLD: usize = 3;

/// Most samples of a recording.
const MOST_SAMPLES: f64 = 5e6;

/// Most bits of a converter.
const MOST_BITS: u32 = 32;

/// A campaign of drops; texts with units.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "A campaign of recordings")]
pub struct SimulateDropsRequest {
    /// Drops from each height, of a fresh fruit each
    #[arg(long, default_value_t = 5, value_name = "NUMBER")]
    pub drops: usize,
    /// Spread of mass between fruit, as a part
    #[arg(long, default_value_t = 0.06, value_name = "PART")]
    pub mass_spread: f64,
    /// Standard deviation of the weighing
    #[arg(long, default_value = "0.02 g", value_name = "QUANTITY")]
    pub mass_sd: String,
    /// Standard deviation of the setting of a height
    #[arg(long, default_value = "1 mm", value_name = "QUANTITY")]
    pub height_sd: String,
    /// Standard deviation of a parameter between fruit, such as c=0.05; repeated
    #[arg(long, value_name = "NAME=SD")]
    pub spread: Vec<String>,
    /// Parameter that campaign.toml gives, so that it is not estimated; repeated. The depth d of
    /// adams-impact if left out
    #[arg(long, value_name = "NAME")]
    pub hold: Vec<String>,
    /// Sensitivity of load cell and transmitter
    #[arg(long, default_value = "0.1 V/N", value_name = "QUANTITY")]
    pub sensitivity: String,
    /// Standard deviation of the noise of force
    #[arg(long, default_value = "0.03 N", value_name = "QUANTITY")]
    pub noise: String,
    /// Resolution of the analogue-to-digital converter; 0 for no rounding
    #[arg(long, default_value_t = 12, value_name = "NUMBER")]
    pub bits: u32,
    /// Largest voltage of the converter
    #[arg(long, default_value = "5 V", value_name = "QUANTITY")]
    pub range: String,
    /// Its lowest voltage; minus the largest if left out. At "0 V" the downward swings of a
    /// ringing plate are cut off
    #[arg(long, value_name = "QUANTITY", allow_hyphen_values = true)]
    pub lowest: Option<String>,
    /// Sampling rate; that of the motion is an option of its own
    #[arg(skip = "10 kHz")]
    pub sampling_rate: String,
    /// Length of each recording; that of the motion is an option of its own
    #[arg(skip = "1.5 s")]
    pub duration: String,
    /// Seed of fruit, heights, trigger and noise
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

/// The request in SI.
struct Bench<'a> {
    plan: &'a DropPlan,
    drops: usize,
    mass_spread: f64,
    mass_sd: f64,
    height_sd: f64,
    held: Vec<usize>,
    batch: Batch,
    sensor: Sensor,
    duration: f64,
    seed: u64,
}

/// One drop as it truly is.
struct TrueDrop {
    law: Law,
    rig: DropRig,
    height: f64,
    release: f64,
    summary: DropSummary,
}

/// Writes a campaign directory with its recordings; the number of recordings.
///
/// A recording begins some time before the release, which nothing marks; its
/// level at rest is the weight of the plate. Masses are as weighed, heights as
/// they were to be set; what they truly were is in truth.csv. Every drop has
/// its own seed, so that another height leaves the others as they are.
pub fn simulate_drops(
    directory: &Path,
    plan: &DropPlan,
    request: &SimulateDropsRequest,
) -> Result<usize, Error> {
    let bench = bench(plan, request)?;
    let mut new = NewCampaign::create(directory)?;
    let (mut specimens, mut impacts, mut truth) = (vec![], vec![], vec![]);
    for (level, height) in plan.heights.iter().enumerate() {
        for repeat in 0..bench.drops {
            let number = level * bench.drops + repeat + 1;
            let seed = seed_of(bench.seed, level as u64, repeat as u64);
            let mut source = noise_source(seed, FRUIT_STREAM);
            let drop = true_drop(&bench, *height, &mut source)?;
            let weighed = drop.rig.mass + bench.mass_sd * normal(&mut source);
            let text = recording(&bench, &drop, seed)?;
            let millimetres = 1e3 * height;
            let (fruit, id) = (
                format!("fruit-{number:02}"),
                format!("drop-{}-{}", round(millimetres, 1), repeat + 1),
            );
            let file = format!("{id}.csv");
            new.file(&format!("raw/{file}"), text)?;
            specimens.push(vec![fruit.clone(), round(1e3 * weighed, 3)]);
            impacts.push(vec![id.clone(), fruit.clone(), file, round(millimetres, 6)]);
            truth.push(truth_row(&[id, fruit], &drop));
        }
    }
    let recordings = impacts.len();
    new.table("specimens.csv", &["id", "mass_g"], specimens)?;
    let header = ["id", "specimen", "file", "drop_height_mm"];
    new.table("impacts.csv", &header, impacts)?;
    new.table("truth.csv", &TRUTH, truth)?;
    new.file("campaign.toml", campaign_text(&bench))?;
    new.end()?;
    Ok(recordings)
}

/// At most so many decimals, without zeros at the end.
fn round(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

fn bench<'a>(plan: &'a DropPlan, request: &SimulateDropsRequest) -> Result<Bench<'a>, Error> {
    if !(1..=10_000).contains(&request.drops) {
        return Err(unusable("--drops", "expected 1 to 10000"));
    }
    if !(0.0..0.5).contains(&request.mass_spread) {
        let problem = "expected a part from 0 to below 0.5";
        return Err(unusable("--mass-spread", problem));
    }
    let duration = positive("--duration", &request.duration, "s")?;
    let sensor = sensor(plan, request)?;
    if duration * sensor.sampling_rate > MOST_SAMPLES {
        let problem = format!("expected a recording of up to {MOST_SAMPLES} samples");
        return Err(unusable("--duration, --sampling-rate", problem));
    }
    Ok(Bench {
        plan,
        drops: request.drops,
        mass_spread: request.mass_spread,
        mass_sd: at_least_zero("--mass-sd", &request.mass_sd, "kg")?,
        height_sd: at_least_zero("--height-sd", &request.height_sd, "m")?,
        held: held(&plan.law, &request.hold)?,
        batch: Batch {
            variety: String::new(),
            law: plan.law,
            spread: spread(&plan.law, &request.spread)?,
            specimens: request.drops,
            repeats: 1,
        },
        sensor,
        duration,
        seed: request.seed,
    })
}

fn sensor(plan: &DropPlan, request: &SimulateDropsRequest) -> Result<Sensor, Error> {
    let high = positive("--range", &request.range, "V")?;
    let low = match &request.lowest {
        Some(text) => quantity("--lowest", text, "V")?,
        None => -high,
    };
    if low >= high {
        return Err(unusable("--lowest", "must be below --range"));
    }
    if request.bits > MOST_BITS {
        let problem = format!("expected up to {MOST_BITS}, or 0 for no rounding");
        return Err(unusable("--bits", problem));
    }
    let sensitivity = positive("--sensitivity", &request.sensitivity, "V/N")?;
    let weight = plan
        .rig
        .plate
        .map_or(0.0, |plate| plate.mass * plan.rig.gravity);
    Ok(Sensor {
        persistence: 0.0,
        sensitivity,
        offset: weight * sensitivity,
        noise: at_least_zero("--noise", &request.noise, "N")?,
        sampling_rate: positive("--sampling-rate", &request.sampling_rate, "Hz")?,
        converter: (request.bits > 0).then_some(Converter {
            bits: request.bits,
            low,
            high,
        }),
    })
}

/// Positions of the parameters that campaign.toml gives.
fn held(law: &Law, names: &[String]) -> Result<Vec<usize>, Error> {
    let description = law.kind().describe();
    if names.is_empty() {
        return Ok(description.index_of("d").into_iter().collect());
    }
    let position = |name: &String| {
        description.index_of(name).ok_or_else(|| {
            let known: Vec<&str> = description.parameters.iter().map(|p| p.name).collect();
            let problem = format!(
                "expected a parameter of {}: {}",
                description.name,
                known.join(", ")
            );
            unusable(format!("--hold {name}"), problem)
        })
    };
    names.iter().map(position).collect()
}

fn true_drop(bench: &Bench, height: f64, source: &mut NoiseSource) -> Result<TrueDrop, Error> {
    let plan = bench.plan;
    let law = drawn(&bench.batch, source)?;
    let rig = DropRig {
        mass: plan.rig.mass * (bench.mass_spread * normal(source)).exp(),
        ..plan.rig
    };
    let height = height + bench.height_sd * normal(source);
    let release = LEAD * (1.0 + uniform(source));
    let summary = simulate_drop(&law, &rig, height, TOLD, plan.end);
    let summary = summary.map_err(|source| failed(&law, source))?;
    Ok(TrueDrop {
        law,
        rig,
        height,
        release,
        summary,
    })
}

/// What the load cell writes: the force on the plate's support, in volts.
fn recording(bench: &Bench, drop: &TrueDrop, seed: u64) -> Result<String, Error> {
    let rate = bench.sensor.sampling_rate;
    let samples = (bench.duration * rate).ceil() as usize;
    let times = (0..samples).map(|i| i as f64 / rate - drop.release);
    let times: Vec<f64> = times.collect();
    let motion = drop_trajectory(&drop.law, &drop.rig, drop.height, &times, bench.plan.end)
        .map_err(|source| failed(&drop.law, source))?;
    let zeros = vec![0.0; samples];
    let trajectory = Trajectory {
        times,
        displacement: zeros.clone(),
        rate: zeros.clone(),
        force: motion.support_force,
        acceleration: zeros,
    };
    let instrument = Instrument {
        force: Some(bench.sensor),
        ..Instrument::default()
    };
    let channels = record(&trajectory, &instrument, seed)
        .map_err(|source| Error::signal("the simulated recording".into(), source))?;
    Ok(recording_text(&channels))
}

/// Columns of truth.csv.
const TRUTH: [&str; 10] = [
    "id",
    "specimen",
    "mass_g",
    "drop_height_mm",
    "law",
    "release_time_s",
    "onset_times_s",
    "peak_contact_forces_N",
    "peak_support_forces_N",
    "restitutions",
];

fn truth_row(ids: &[String], drop: &TrueDrop) -> Vec<String> {
    let impacts = &drop.summary.impacts;
    let list = |values: Vec<f64>| {
        let texts = values.iter().map(f64::to_string).collect::<Vec<_>>();
        texts.join(" ")
    };
    let onsets = impacts.iter().map(|i| drop.release + i.onset_time);
    let mut row = ids.to_vec();
    row.extend([
        (1e3 * drop.rig.mass).to_string(),
        (1e3 * drop.height).to_string(),
        LawExpression::from(drop.law).to_string(),
        drop.release.to_string(),
        list(onsets.collect()),
        list(impacts.iter().map(|i| i.peak_contact_force).collect()),
        list(impacts.iter().map(|i| i.peak_support_force).collect()),
        list(impacts.iter().map(|i| i.restitution).collect()),
    ]);
    row
}

/// campaign.toml that reads the recordings back: it knows what the bench knows.
fn campaign_text(bench: &Bench) -> String {
    let (plan, sensor) = (bench.plan, &bench.sensor);
    let truth = LawExpression::from(plan.law);
    let label = format!("windfall simulate drop, {truth}, seed {}", bench.seed);
    let mut law = LawExpression::from(plan.law);
    for (position, value) in law.values.iter_mut().enumerate() {
        if !bench.held.contains(&position) {
            *value = None;
        }
    }
    let plate = match &plan.rig.plate {
        None => "plate = \"rigid\"".to_owned(),
        Some(plate) => format!(
            "plate_mass = \"{} kg\"                 # its stiffness and damping: from the ringing",
            plate.mass
        ),
    };
    // Exponents have defaults: they are estimated only when they are named.
    let parameters = plan.law.kind().describe().parameters.iter().enumerate();
    let free: Vec<String> = parameters
        .filter(|(i, p)| p.default.is_some() && !bench.held.contains(i))
        .map(|(_, p)| format!("\"{}\"", p.name))
        .collect();
    format!(
        r#"# Simulated by windfall: no fruit was hurt. What was drawn is in truth.csv.
format = 1

[campaign]
title = "Simulated drops"
simulated = {label}

[rig]
kind = "drop"
gravity = "{gravity} m/s^2"
mass_sd = "{mass_sd} kg"
height_sd = "{height_sd} m"
{plate}
effective_mass_factor = {factor:?}

[files]
directory = "raw"
rate = "{rate} Hz"

[channels.force]
column = "force_V"
sensitivity = "{sensitivity} V/N"

[fit]
law = {law}
free = [{free}]
end = "{end}"

[calibrate]
bounces = 2
{own}"#,
        label = string_text(&label),
        law = string_text(&law.to_string()),
        gravity = plan.rig.gravity,
        mass_sd = bench.mass_sd,
        height_sd = bench.height_sd,
        factor = plan.rig.effective_mass_factor,
        rate = sensor.sampling_rate,
        sensitivity = sensor.sensitivity,
        free = free.join(", "),
        end = end_name(plan.end),
        own = match law_table(plan.law.kind()) {
            table if table.is_empty() => table,
            table => format!("\n{table}"),
        },
    )
}
