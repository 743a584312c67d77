//! `windfall scene`

use crate::args_format::Format;
use crate::args_scene::{SceneCommand, SceneRunArguments};
use crate::command_fit::{moving, progress_bar};
use crate::command_scene_view;
use crate::show::{write_json, write_result};
use windfall::workflow_scene::{SceneRequest, run_scene};
use windfall::write_scene::{csv_of_scene, text_of_scene};

/// Runs what is asked of scenes.
pub fn run(command: &SceneCommand) -> anyhow::Result<()> {
    match command {
        SceneCommand::Run(arguments) => run_one(arguments),
        SceneCommand::Picture(arguments) => command_scene_view::picture(arguments),
        SceneCommand::Vtk(arguments) => command_scene_view::vtk(arguments),
    }
}

fn run_one(arguments: &SceneRunArguments) -> anyhow::Result<()> {
    let bar = progress_bar();
    let progress = moving(&bar);
    let request = SceneRequest {
        out: arguments.out.clone(),
        threads: arguments.threads,
    };
    let outcome = run_scene(&arguments.file, &request, &progress);
    bar.finish_and_clear();
    let outcome = outcome?;
    match arguments.format {
        Format::Json => write_json(&outcome),
        Format::Csv => write_result(&csv_of_scene(&outcome)?),
        Format::Text => write_result(&text_of_scene(&outcome)),
    }
}
