//! `windfall simulate`

use crate::args::format::Shown;
use crate::args::simulate::{
    SimulateArguments, SimulateCarriageArguments, SimulateCompressionArguments, SimulateEvent,
    SimulateImpactArguments, SimulatePendulumArguments, SimulateRepeatsArguments,
    SimulateTapArguments,
};
use crate::show::{show, show_motion, show_written, tell_written, write_result};
use std::path::Path;
use windfall_files::error::Error;
use windfall_files::text::quote::{command, path_word};
use windfall_simulate::compression::simulate_compression;
use windfall_simulate::example::write_example;
use windfall_simulate::figure::write_impact_figure;
use windfall_simulate::files::Weighed;
use windfall_simulate::repeats::simulate_repeats;
use windfall_simulate::request::event::{Event, impact_of_event, motion_of_event};
use windfall_simulate::request::impact::{carriage_event, impact_event, pendulum_event};
use windfall_simulate::request::instrument::{instrument_of_carriage, instrument_of_pendulum};
use windfall_simulate::request::recordings::simulate_recordings;
use windfall_simulate::taps::simulate_taps;
use windfall_simulate::text::{
    csv_of_motion, csv_of_simulation, outcome_of_motion, text_of_simulation,
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
    let files = simulate_compression(&arguments.directory, &arguments.request)?;
    next(&arguments.directory, files.len())
}

fn tap(arguments: &SimulateTapArguments) -> anyhow::Result<()> {
    let files = simulate_taps(&arguments.directory, &arguments.request)?;
    next(&arguments.directory, files.len())
}

fn next(directory: &Path, files: usize) -> anyhow::Result<()> {
    let word = path_word(directory);
    let directory = directory.display();
    write_result(&format!(
        "{files} files in {directory}\n\nNext:\n  {}\n",
        command(&["fit", &word])
    ))
}

fn repeats(arguments: &SimulateRepeatsArguments) -> anyhow::Result<()> {
    let work = || simulate_repeats(&arguments.directory, &arguments.request);
    show_written(&arguments.format.into(), &arguments.directory, work)
}

fn impact(arguments: &SimulateImpactArguments) -> anyhow::Result<()> {
    let event = impact_event(&arguments.request)?;
    let work = || {
        let impact = impact_of_event(&event)?;
        if let Some(path) = &arguments.plot {
            tell_written(write_impact_figure(path, &event, arguments.width)?);
        }
        Ok::<_, Error>(impact)
    };
    let shown = &arguments.shown;
    show(shown, work, text_of_simulation, csv_of_simulation)?;
    Ok(())
}

fn carriage(arguments: &SimulateCarriageArguments) -> anyhow::Result<()> {
    let request = &arguments.request;
    let event = carriage_event(request)?;
    let Some(directory) = &request.recordings else {
        return motion(&event, &request.rate, &arguments.shown);
    };
    let mut sensors = request.sensors.clone();
    if sensors.is_empty() {
        sensors = ["force", "position"].map(str::to_owned).to_vec();
    }
    let instrument = instrument_of_carriage(&sensors)?;
    let weighed = match request.unweighed {
        true => Weighed::FromImpulse,
        false => Weighed::Given,
    };
    let (specimens, drawn) = (&request.specimens, (weighed, request.seed));
    let work = || simulate_recordings(&event, instrument, specimens, drawn, directory);
    show_written(&arguments.shown, directory, work)
}

fn pendulum(arguments: &SimulatePendulumArguments) -> anyhow::Result<()> {
    let request = &arguments.request;
    if let Some(directory) = &request.example {
        let work = || write_example(directory, request.seed);
        return show_written(&arguments.shown, directory, work);
    }
    let event = pendulum_event(request)?;
    let Some(directory) = &request.recordings else {
        return motion(&event, &request.instrument.rate, &arguments.shown);
    };
    let instrument = instrument_of_pendulum(&request.instrument, &event)?;
    let (specimens, drawn) = (&request.specimens, (Weighed::Given, request.seed));
    let work = || simulate_recordings(&event, instrument, specimens, drawn, directory);
    show_written(&arguments.shown, directory, work)
}

fn motion(event: &Event, rate: &str, shown: &Shown) -> anyhow::Result<()> {
    let motion = motion_of_event(event, rate)?;
    show_motion(
        shown,
        (
            text_of_simulation(&motion.impact),
            motion.trajectory.times.len(),
        ),
        || outcome_of_motion(&motion),
        || csv_of_motion(&motion),
    )
}
