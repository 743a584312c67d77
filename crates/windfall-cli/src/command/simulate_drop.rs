//! `windfall simulate drop`

use crate::args::end::end_text;
use crate::args::format::Format;
use crate::args::simulate_drop::SimulateDropArguments;
use crate::command::simulate_eccentric;
use crate::show::{write_json, write_result, written};
use std::path::Path;
use windfall_simulate::drop::{simulate_drop_motion, simulate_one_drop};
use windfall_simulate::drop_text::{
    csv_of_drop, csv_of_drop_motion, json_of_drop_motion, text_of_drop,
};
use windfall_simulate::drops::{SimulateDropsRequest, simulate_drops};
use windfall_simulate::request::drop::{DropPlan, DropRequest, drop_plan};

/// Sampling rate and length of recordings.
const RATE: &str = "10 kHz";
const DURATION: &str = "1.5 s";

/// Simulates one drop, or a campaign of recordings.
pub fn run(arguments: &SimulateDropArguments) -> anyhow::Result<()> {
    let plan = drop_plan(&DropRequest {
        law: arguments.law.clone(),
        laws: arguments.laws.clone(),
        mass: arguments.mass.clone(),
        heights: arguments.heights.clone(),
        plate_mass: arguments.plate.plate_mass.clone(),
        plate_stiffness: arguments.plate.plate_stiffness.clone(),
        plate_damping: arguments.plate.plate_damping.clone(),
        effective_mass_factor: arguments.effective_mass_factor,
        gravity: arguments.gravity.clone(),
        end: end_text(arguments.end),
    })?;
    if simulate_eccentric::is_asked(&arguments.eccentric) {
        return simulate_eccentric::run(&plan, arguments);
    }
    match (&arguments.directory, &arguments.sampling_rate) {
        (Some(directory), _) => recordings(directory, &plan, arguments),
        (None, Some(rate)) => motion(&plan, arguments, rate),
        (None, None) => one(&plan, arguments),
    }
}

fn one(plan: &DropPlan, arguments: &SimulateDropArguments) -> anyhow::Result<()> {
    let drop = simulate_one_drop(plan, arguments.impacts)?;
    match arguments.format {
        Format::Json => write_json(&drop),
        Format::Csv => write_result(&csv_of_drop(&drop)?),
        Format::Text => write_result(&text_of_drop(&drop)),
    }
}

fn motion(plan: &DropPlan, arguments: &SimulateDropArguments, rate: &str) -> anyhow::Result<()> {
    let duration = arguments.duration.as_deref();
    let motion = simulate_drop_motion(plan, arguments.impacts, rate, duration)?;
    match arguments.format {
        Format::Json => write_json(&json_of_drop_motion(&motion)),
        Format::Csv => write_result(&csv_of_drop_motion(&motion)?),
        Format::Text => write_result(&format!(
            "{}\nThe motion, {} samples: --format csv or json.\n",
            text_of_drop(&motion.drop),
            motion.trajectory.times.len()
        )),
    }
}

fn recordings(
    directory: &Path,
    plan: &DropPlan,
    arguments: &SimulateDropArguments,
) -> anyhow::Result<()> {
    let asked = &arguments.recordings;
    let text = |option: &Option<String>, usual: &str| option.clone().unwrap_or(usual.to_owned());
    let request = SimulateDropsRequest {
        drops: asked.drops,
        mass_spread: asked.mass_spread,
        mass_sd: asked.mass_sd.clone(),
        height_sd: asked.height_sd.clone(),
        spread: asked.spread.clone(),
        hold: asked.hold.clone(),
        sensitivity: asked.sensitivity.clone(),
        noise: asked.noise.clone(),
        bits: asked.bits,
        range: asked.range.clone(),
        lowest: asked.lowest.clone(),
        sampling_rate: text(&arguments.sampling_rate, RATE),
        duration: text(&arguments.duration, DURATION),
        seed: asked.seed,
    };
    let count = simulate_drops(directory, plan, &request)?;
    written(directory, count, arguments.format)
}
