//! `windfall simulate tap`: a campaign of taps on fruit of known frequency, to
//! try the program and to check it.

use crate::new_campaign::NewCampaign;
use crate::wav::wav_bytes;
use clap::Args;
use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::option_value::{chosen, positive, unusable};
use windfall_files::table::write::csv_text;
use windfall_signal::noise::gaussian::{NoiseSource, noise_source, normal, uniform};

/// What is simulated; texts with units.
#[derive(Clone, Debug, Args)]
pub struct SimulateTapsRequest {
    /// Frequency of the first mode
    #[arg(long, default_value = "800 Hz")]
    pub frequency: String,
    /// Its quality: frequency over width of the peak
    #[arg(long, default_value_t = 20.0)]
    pub quality: f64,
    /// Mass of a fruit
    #[arg(long, default_value = "0.2 kg")]
    pub mass: String,
    /// Number of fruit
    #[arg(long, default_value_t = 6)]
    pub fruit: usize,
    /// Taps in a recording; each fruit has a recording at each of two places
    #[arg(long, default_value_t = 2)]
    pub taps: usize,
    /// Spread of frequency and mass between fruit, as a part
    #[arg(long, default_value_t = 0.08)]
    pub spread: f64,
    /// Distance of the two frequencies of a split mode, as a part; 0 for spheres
    #[arg(long, default_value_t = 0.0)]
    pub split: f64,
    /// Signal over noise, in power over the first 50 ms of a tap; dB
    #[arg(long, default_value_t = 30.0, allow_hyphen_values = true)]
    pub signal_to_noise: f64,
    /// Format of the recordings: wav or csv
    #[arg(long, default_value = "wav")]
    pub file: String,
    /// Sampling rate
    #[arg(long, default_value = "44100 Hz")]
    pub sampling_rate: String,
    /// Seed of noise and spread
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

#[derive(Clone, Copy)]
enum FileKind {
    Wav,
    Csv,
}

struct Plan {
    frequency: f64,
    mass: f64,
    rate: u32,
    file: FileKind,
}

/// Quiet before the first tap, and time from tap to tap; s.
const QUIET: f64 = 0.2;
const APART: f64 = 0.4;
/// Duration of the hit, and its height over that of the ringing.
const HIT: f64 = 1e-3;
const HIT_LEVEL: f64 = 0.8;
/// Higher mode: frequency (0S3 over 0S2 of a sphere) and amplitude over the first.
const HIGHER: (f64, f64) = (1.47, 0.4);
/// Amplitude of the ringing, full scale being 1.
const AMPLITUDE: f64 = 0.4;
/// Over this time the power of a tap is averaged; s.
const POWER_TIME: f64 = 0.05;
/// Places of a fruit that are tapped.
const PLACES: [&str; 2] = ["stem up", "quarter turn"];

/// Writes a campaign directory with its recordings; the files written.
pub fn simulate_taps(
    directory: &Path,
    request: &SimulateTapsRequest,
) -> Result<Vec<PathBuf>, Error> {
    let plan = plan(request)?;
    let mut new = NewCampaign::create(directory)?;
    let (mut specimens, mut rows) = (vec![], vec![]);
    for fruit in 0..request.fruit {
        let id = format!("fruit-{}", fruit + 1);
        let mut source = noise_source(request.seed, 2 * fruit as u64);
        let mut spread = |mean: f64| mean * (request.spread * normal(&mut source)).exp();
        let (frequency, mass) = (spread(plan.frequency), spread(plan.mass));
        specimens.push(vec![
            id.clone(),
            (1e3 * mass).to_string(),
            frequency.to_string(),
        ]);
        let mut source = noise_source(request.seed, 2 * fruit as u64 + 1);
        for (place, orientation) in PLACES.iter().enumerate() {
            let samples = recording(&plan, request, frequency, place, &mut source);
            let (ending, bytes) = match plan.file {
                FileKind::Wav => ("wav", wav_bytes(&samples, plan.rate)),
                FileKind::Csv => ("csv", csv_bytes(&samples, plan.rate)?),
            };
            let number = format!("{id}-{}", place + 1);
            let name = format!("{number}.{ending}");
            new.file(&format!("raw/{name}"), bytes)?;
            rows.push(vec![number, id.clone(), name, (*orientation).to_owned()]);
        }
    }
    new.file("campaign.toml", campaign(&plan, request))?;
    let header = ["id", "mass_g", "simulated_frequency_Hz"];
    new.table("specimens.csv", &header, specimens)?;
    let header = ["id", "specimen", "file", "orientation"];
    new.table("impacts.csv", &header, rows)?;
    new.end()
}

fn plan(request: &SimulateTapsRequest) -> Result<Plan, Error> {
    let frequency = positive("--frequency", &request.frequency, "Hz")?;
    let rate = positive("--sampling-rate", &request.sampling_rate, "Hz")?;
    if !(6.0 * frequency..=1e6).contains(&rate) || rate.fract() != 0.0 {
        let problem = "expected a whole number of Hz, from six times the frequency to 1 MHz";
        return Err(unusable("--sampling-rate", problem));
    }
    if !(request.quality >= 1.0 && request.quality <= 1000.0) {
        return Err(unusable("--quality", "expected a number from 1 to 1000"));
    }
    for (option, value) in [("--spread", request.spread), ("--split", request.split)] {
        if !(0.0..0.5).contains(&value) {
            return Err(unusable(option, "expected a part from 0 to below 0.5"));
        }
    }
    if !(1..=100).contains(&request.taps) || !(1..=10_000).contains(&request.fruit) {
        let problem = "expected 1 to 100 taps and 1 to 10000 fruit";
        return Err(unusable("--taps, --fruit", problem));
    }
    if !request.signal_to_noise.is_finite() {
        return Err(unusable("--signal-to-noise", "expected a number of dB"));
    }
    let files = [("wav", FileKind::Wav), ("csv", FileKind::Csv)];
    Ok(Plan {
        frequency,
        mass: positive("--mass", &request.mass, "kg")?,
        rate: rate as u32,
        file: chosen("--file", &request.file, &files)?,
    })
}

/// Taps at one place: hits, ringing, noise.
fn recording(
    plan: &Plan,
    request: &SimulateTapsRequest,
    frequency: f64,
    place: usize,
    source: &mut NoiseSource,
) -> Vec<f64> {
    let rate = f64::from(plan.rate);
    let count = ((QUIET + APART * request.taps as f64) * rate) as usize;
    let decay = PI * frequency / request.quality;
    let power = 0.5 * AMPLITUDE * AMPLITUDE * -(-2.0 * decay * POWER_TIME).exp_m1()
        / (2.0 * decay * POWER_TIME);
    let noise = (power / 10_f64.powf(request.signal_to_noise / 10.0)).sqrt();
    let mut samples: Vec<f64> = (0..count).map(|_| noise * normal(source)).collect();
    for tap in 0..request.taps {
        let strength = 0.7 + 0.3 * uniform(source);
        let onset = QUIET + APART * tap as f64 + 0.01 * uniform(source);
        // Each place excites one part of a split mode more than the other.
        let halves = [
            (-0.5, 0.35 + 0.3 * place as f64),
            (0.5, 0.65 - 0.3 * place as f64),
        ];
        let mut modes: Vec<(f64, f64)> = match request.split > 0.0 {
            true => halves
                .map(|(side, part)| (frequency * (1.0 + side * request.split), part))
                .to_vec(),
            false => vec![(frequency, 1.0)],
        };
        modes.push((HIGHER.0 * frequency, HIGHER.1));
        let phases: Vec<f64> = modes.iter().map(|_| TAU * uniform(source)).collect();
        let first = (onset * rate).ceil() as usize;
        for (i, sample) in samples.iter_mut().enumerate().skip(first) {
            let t = i as f64 / rate - onset;
            let ring = modes.iter().zip(&phases).map(|(&(f, part), phase)| {
                part * (-PI * f / request.quality * t).exp() * (TAU * f * t + phase).sin()
            });
            let hit = if t < HIT {
                HIT_LEVEL * (PI * t / HIT).sin()
            } else {
                0.0
            };
            *sample += AMPLITUDE * strength * (ring.sum::<f64>() + hit);
        }
    }
    samples
}

fn csv_bytes(samples: &[f64], rate: u32) -> Result<Vec<u8>, Error> {
    let header = ["time_s", "sound_V"].map(str::to_owned);
    let row = |(i, sample): (usize, &f64)| {
        vec![
            format!("{:.8}", i as f64 / f64::from(rate)),
            format!("{sample:.6}"),
        ]
    };
    let rows: Vec<Vec<String>> = samples.iter().enumerate().map(row).collect();
    Ok(csv_text(&header, rows)?.into_bytes())
}

fn campaign(plan: &Plan, request: &SimulateTapsRequest) -> String {
    let (time, column) = match plan.file {
        FileKind::Wav => ("", "channel 1"),
        FileKind::Csv => ("time = \"time_s\"\n", "sound_V"),
    };
    format!(
        "# Taps made by windfall simulate tap.\n\
         format = 1\n\n\
         [campaign]\n\
         title = \"Simulated taps\"\n\
         simulated = \"first mode at {frequency} Hz, Q {quality}, seed {seed}\"\n\n\
         [rig]\n\
         kind = \"acoustic\"\n\n\
         [files]\n\
         directory = \"raw\"\n\
         {time}\n\
         [channels.sound]\n\
         column = \"{column}\"\n",
        frequency = plan.frequency,
        quality = request.quality,
        seed = request.seed,
    )
}
