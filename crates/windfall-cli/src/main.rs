//! The `windfall` command: parses arguments, calls one workflow, displays.
//!
//! Results go to standard output, messages and progress to standard error.
//! Exit status: 0 success, 1 the work failed, 2 the request was wrong.

mod args;
mod args_bruise;
mod args_calibrate;
mod args_compare;
mod args_design;
mod args_end;
mod args_figures;
mod args_fit;
mod args_format;
mod args_geometry;
mod args_laws;
mod args_population;
mod args_regress;
mod args_report;
mod args_scene;
mod args_scene_view;
mod args_serve;
mod args_simulate;
mod args_simulate_drop;
mod args_simulate_eccentric;
mod args_surface;
mod command_bruise;
mod command_calibrate;
mod command_card;
mod command_compare;
mod command_design;
mod command_fit;
mod command_geometry;
mod command_inspect;
mod command_laws;
mod command_new;
mod command_population;
mod command_regress;
mod command_report;
mod command_scene;
mod command_scene_view;
mod command_serve;
mod command_simulate;
mod command_simulate_drop;
mod command_simulate_eccentric;
mod command_surface;
mod show;

use args::{Arguments, Command};
use clap::{CommandFactory, Parser};
use std::process::ExitCode;

fn main() -> ExitCode {
    let outcome = match Arguments::parse().command {
        Command::New(arguments) => command_new::run(&arguments),
        Command::Inspect(arguments) => command_inspect::run(&arguments),
        Command::Design(arguments) => command_design::run(&arguments),
        Command::Fit(arguments) => command_fit::run(&arguments),
        Command::Laws(arguments) => command_laws::run(&arguments),
        Command::Population(arguments) => command_population::run(&arguments),
        Command::Report(arguments) => command_report::run(&arguments),
        Command::Serve(arguments) => command_serve::run(&arguments),
        Command::Calibrate(arguments) => command_calibrate::run(&arguments),
        Command::Scene(command) => command_scene::run(&command),
        Command::Simulate(arguments) => command_simulate::run(&arguments),
        Command::Summary(arguments) => command_compare::run_summary(&arguments),
        Command::Compare(arguments) => command_compare::run_compare(&arguments),
        Command::Regress(arguments) => command_regress::run(&arguments),
        Command::Surface(arguments) => command_surface::run(&arguments),
        Command::Radius(arguments) => command_geometry::run_radius(&arguments),
        Command::Bruise(arguments) => command_bruise::run(&arguments),
        Command::Card(arguments) => command_card::run(&arguments),
        Command::Completions { shell } => {
            let mut command = Arguments::command();
            let mut text = Vec::new();
            clap_complete::generate(shell, &mut command, "windfall", &mut text);
            show::write_result(&String::from_utf8_lossy(&text))
        }
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            show::message(&format!("error: {}", show::with_causes(&error)));
            ExitCode::from(status_of(&error))
        }
    }
}

/// 1 when the work failed, 2 when the request was wrong.
fn status_of(error: &anyhow::Error) -> u8 {
    match error.downcast_ref::<windfall::error::Error>() {
        Some(known) if known.is_request() => 2,
        _ => 1,
    }
}
