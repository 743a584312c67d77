//! `windfall simulate`

use crate::args::end::end_text;
use crate::args::format::Format;
use crate::args::simulate::{
    SimulateArguments, SimulateCarriageArguments, SimulateCompressionArguments, SimulateEvent,
    SimulateImpactArguments, SimulatePendulumArguments, SimulateRepeatsArguments,
    SimulateTapArguments,
};
use crate::show::{message, write_json, write_result, written};
use windfall_simulate::campaign::Weighed;
use windfall_simulate::compression::{SimulateCompressionRequest, simulate_compression};
use windfall_simulate::example::write_example;
use windfall_simulate::figure::write_impact_figure;
use windfall_simulate::impact::SimulatedMotion;
use windfall_simulate::repeats::{SimulateRepeatsRequest, Spots, simulate_repeats};
use windfall_simulate::request::event::{
    CarriageRequest, PendulumRequest, carriage_event, impact_of_event, motion_of_event,
    pendulum_event,
};
use windfall_simulate::request::instrument::{
    PendulumInstrument, instrument_of_carriage, instrument_of_pendulum,
};
use windfall_simulate::request::recordings::{RecordingsRequest, simulate_recordings};
use windfall_simulate::taps::{SimulateTapsRequest, simulate_taps};
use windfall_simulate::text::{
    csv_of_motion, csv_of_simulation, json_of_motion, text_of_simulation,
};

/// Simulates one event.
pub fn run(arguments: &SimulateArguments) -> anyhow::Result<()> {
    match &arguments.event {
        SimulateEvent::Impact(arguments) => impact(arguments),
        SimulateEvent::Pendulum(arguments) => pendulum(arguments),
        SimulateEvent::Carriage(arguments) => carriage(arguments),
        SimulateEvent::Compression(arguments) => compression(arguments),
        SimulateEvent::Tap(arguments) => tap(arguments),
        SimulateEvent::Repeats(arguments) => repeats(arguments),
        SimulateEvent::Drop(arguments) => crate::command::simulate_drop::run(arguments),
    }
}

fn compression(arguments: &SimulateCompressionArguments) -> anyhow::Result<()> {
    let request = SimulateCompressionRequest {
        law: arguments.law.clone(),
        laws: arguments.laws.clone(),
        rates: arguments.rates.clone(),
        deformation: arguments.deformation.clone(),
        radius: arguments.radius.clone(),
        plates: arguments.plates,
        yield_force: arguments.yield_force.clone(),
        fruit: arguments.fruit,
        spread: arguments.spread,
        force_noise: arguments.force_noise.clone(),
        sampling_rate: arguments.sampling_rate.clone(),
        seed: arguments.seed,
    };
    let written = simulate_compression(&arguments.directory, &request)?;
    write_result(&format!(
        "{} files in {directory}\n\nNext:\n  windfall fit {directory}\n",
        written.len(),
        directory = arguments.directory.display()
    ))
}

fn tap(arguments: &SimulateTapArguments) -> anyhow::Result<()> {
    let request = SimulateTapsRequest {
        frequency: arguments.frequency.clone(),
        quality: arguments.quality,
        mass: arguments.mass.clone(),
        fruit: arguments.fruit,
        taps: arguments.taps,
        spread: arguments.spread,
        split: arguments.split,
        signal_to_noise: arguments.signal_to_noise,
        file: arguments.file.clone(),
        sampling_rate: arguments.sampling_rate.clone(),
        seed: arguments.seed,
    };
    let written = simulate_taps(&arguments.directory, &request)?;
    write_result(&format!(
        "{} files in {directory}\n\nNext:\n  windfall fit {directory}\n",
        written.len(),
        directory = arguments.directory.display()
    ))
}

fn repeats(arguments: &SimulateRepeatsArguments) -> anyhow::Result<()> {
    let request = SimulateRepeatsRequest {
        fruit: arguments.fruit,
        energies: arguments.energies.clone(),
        repeats: arguments.repeats,
        spots: match arguments.spots.as_str() {
            "fresh" => Spots::Fresh,
            _ => Spots::Same,
        },
        critical_energy: arguments.critical_energy.clone(),
        spread: arguments.spread,
        mass: arguments.mass.clone(),
        force_noise: arguments.force_noise.clone(),
        velocity_scatter: arguments.velocity_scatter,
        sampling_rate: arguments.sampling_rate.clone(),
        seed: arguments.seed,
    };
    let recordings = simulate_repeats(&arguments.directory, &request)?;
    written(&arguments.directory, recordings, arguments.format)
}

fn impact(arguments: &SimulateImpactArguments) -> anyhow::Result<()> {
    let event = carriage_event(&CarriageRequest {
        law: arguments.law.clone(),
        laws: arguments.laws.clone(),
        mass: arguments.mass.clone(),
        velocity: arguments.velocity.clone(),
        driving_acceleration: arguments.driving_acceleration.clone(),
        end: end_text(arguments.end),
    })?;
    let impact = impact_of_event(&event)?;
    if let Some(path) = &arguments.plot {
        for written in write_impact_figure(path, &event)? {
            message(&format!("written: {}", written.display()));
        }
    }
    match arguments.format {
        Format::Json => write_json(&impact),
        Format::Csv => write_result(&csv_of_simulation(&impact)?),
        Format::Text => write_result(&text_of_simulation(&impact)),
    }
}

fn carriage(arguments: &SimulateCarriageArguments) -> anyhow::Result<()> {
    let event = carriage_event(&CarriageRequest {
        law: arguments.law.clone(),
        laws: arguments.laws.clone(),
        mass: arguments.mass.clone(),
        velocity: arguments.velocity.clone(),
        driving_acceleration: arguments.driving_acceleration.clone(),
        end: end_text(arguments.end),
    })?;
    let Some(directory) = &arguments.recordings else {
        return show_motion(&motion_of_event(&event, &arguments.rate)?, arguments.format);
    };
    let mut sensors = arguments.sensors.clone();
    if sensors.is_empty() {
        sensors = ["force", "position"].map(str::to_owned).to_vec();
    }
    let instrument = instrument_of_carriage(&sensors)?;
    let request = RecordingsRequest {
        spread: arguments.spread.clone(),
        specimens: arguments.specimens,
        repeats: arguments.repeats,
        weighed: match arguments.unweighed {
            true => Weighed::FromImpulse,
            false => Weighed::Given,
        },
        seed: arguments.seed,
    };
    let count = simulate_recordings(&event, instrument, &request, directory)?;
    written(directory, count, arguments.format)
}

fn pendulum(arguments: &SimulatePendulumArguments) -> anyhow::Result<()> {
    if let Some(directory) = &arguments.example {
        let recordings = write_example(directory, arguments.seed)?;
        return written(directory, recordings, arguments.format);
    }
    let event = pendulum_event(&PendulumRequest {
        law: arguments.law.clone().unwrap_or_default(),
        laws: arguments.laws.clone(),
        inertia: arguments.inertia.clone(),
        arm: arguments.arm.clone(),
        mass: arguments.mass.clone(),
        centre_of_mass: arguments.centre_of_mass.clone(),
        velocity: arguments.velocity.clone(),
        end: end_text(arguments.end),
    })?;
    let Some(directory) = &arguments.recordings else {
        return show_motion(&motion_of_event(&event, &arguments.rate)?, arguments.format);
    };
    let instrument = PendulumInstrument {
        rate: arguments.rate.clone(),
        encoder: arguments.encoder.clone(),
        counts_per_revolution: arguments.counts_per_revolution,
        sensitivity: arguments.sensitivity.clone(),
        noise: arguments.noise.clone(),
        bits: arguments.bits,
        range: arguments.range.clone(),
    };
    let request = RecordingsRequest {
        spread: arguments.spread.clone(),
        specimens: arguments.specimens,
        repeats: arguments.repeats,
        weighed: Weighed::Given,
        seed: arguments.seed,
    };
    let instrument = instrument_of_pendulum(&instrument, &event)?;
    let count = simulate_recordings(&event, instrument, &request, directory)?;
    written(directory, count, arguments.format)
}

fn show_motion(motion: &SimulatedMotion, format: Format) -> anyhow::Result<()> {
    match format {
        Format::Json => write_json(&json_of_motion(motion)),
        Format::Csv => write_result(&csv_of_motion(motion)?),
        Format::Text => write_result(&format!(
            "{}\nThe motion, {} samples: --format csv or json.\n",
            text_of_simulation(&motion.impact),
            motion.trajectory.times.len()
        )),
    }
}
