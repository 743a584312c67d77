//! `windfall simulate`

use crate::args_format::Format;
use crate::args_simulate::{
    End, SimulateArguments, SimulateCarriageArguments, SimulateEvent, SimulateImpactArguments,
    SimulatePendulumArguments,
};
use crate::show::{write_json, write_result};
use std::path::Path;
use windfall::request_simulate::{
    CarriageRequest, PendulumRequest, RecordingsRequest, simulate_carriage,
    simulate_carriage_motion, simulate_pendulum_motion, simulate_pendulum_recordings,
};
use windfall::simulate_example::write_example;
use windfall::workflow_simulate::{
    SimulatedMotion, csv_of_motion, csv_of_simulation, json_of_motion, text_of_simulation,
};

/// Simulates one event.
pub fn run(arguments: &SimulateArguments) -> anyhow::Result<()> {
    match &arguments.event {
        SimulateEvent::Impact(arguments) => impact(arguments),
        SimulateEvent::Pendulum(arguments) => pendulum(arguments),
        SimulateEvent::Carriage(arguments) => carriage(arguments),
    }
}

fn end_text(end: End) -> String {
    match end {
        End::ForceZero => "force-zero".to_owned(),
        End::GapZero => "gap-zero".to_owned(),
    }
}

fn impact(arguments: &SimulateImpactArguments) -> anyhow::Result<()> {
    let impact = simulate_carriage(&CarriageRequest {
        law: arguments.law.clone(),
        mass: arguments.mass.clone(),
        velocity: arguments.velocity.clone(),
        driving_acceleration: arguments.driving_acceleration.clone(),
        end: end_text(arguments.end),
    })?;
    match arguments.format {
        Format::Json => write_json(&impact),
        Format::Csv => write_result(&csv_of_simulation(&impact)?),
        Format::Text => write_result(&text_of_simulation(&impact)),
    }
}

fn carriage(arguments: &SimulateCarriageArguments) -> anyhow::Result<()> {
    let request = CarriageRequest {
        law: arguments.law.clone(),
        mass: arguments.mass.clone(),
        velocity: arguments.velocity.clone(),
        driving_acceleration: arguments.driving_acceleration.clone(),
        end: end_text(arguments.end),
    };
    show_motion(
        &simulate_carriage_motion(&request, &arguments.rate)?,
        arguments.format,
    )
}

fn pendulum(arguments: &SimulatePendulumArguments) -> anyhow::Result<()> {
    if let Some(directory) = &arguments.example {
        let recordings = write_example(directory, arguments.seed)?;
        return written(directory, recordings, arguments.format);
    }
    let request = PendulumRequest {
        law: arguments.law.clone().unwrap_or_default(),
        inertia: arguments.inertia.clone(),
        arm: arguments.arm.clone(),
        mass: arguments.mass.clone(),
        centre_of_mass: arguments.centre_of_mass.clone(),
        velocity: arguments.velocity.clone(),
        end: end_text(arguments.end),
    };
    let Some(directory) = &arguments.recordings else {
        let motion = simulate_pendulum_motion(&request, &arguments.rate)?;
        return show_motion(&motion, arguments.format);
    };
    let recordings = RecordingsRequest {
        rate: arguments.rate.clone(),
        noise: arguments.noise.clone(),
        spread: arguments.spread.clone(),
        specimens: arguments.specimens,
        repeats: arguments.repeats,
        seed: arguments.seed,
    };
    let count = simulate_pendulum_recordings(&request, &recordings, directory)?;
    written(directory, count, arguments.format)
}

fn written(directory: &Path, recordings: usize, format: Format) -> anyhow::Result<()> {
    let directory = directory.display();
    match format {
        Format::Json => write_json(&serde_json::json!({
            "directory": directory.to_string(), "recordings": recordings, "simulated": true
        })),
        Format::Csv => write_result(&format!(
            "directory,recordings\n\"{directory}\",{recordings}\n"
        )),
        Format::Text => write_result(&format!(
            "{recordings} simulated recordings in {directory}\n\nNext:\n  windfall fit {directory}\n"
        )),
    }
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
