//! `windfall scene`

use crate::args_format::Format;
use crate::args_scene::{SceneCommand, SceneRunArguments, SceneStudyArguments};
use crate::command_fit::{moving, progress_bar};
use crate::command_scene_view;
use crate::show::{write_json, write_result};
use std::ops::ControlFlow;
use std::sync::atomic::Ordering;
use windfall::scene_run::SceneStart;
use windfall::workflow_scene::{SceneRequest, run_scene};
use windfall::workflow_study::{StudyRequest, run_study};
use windfall::write_scene::{csv_of_scene, text_of_scene};
use windfall::write_study::{csv_of_study, text_of_study};
use windfall_web::interrupt::interruption;

/// Runs what is asked of scenes.
pub fn run(command: &SceneCommand) -> anyhow::Result<()> {
    match command {
        SceneCommand::Run(arguments) => run_one(arguments),
        SceneCommand::Study(arguments) => run_variants(arguments),
        SceneCommand::Picture(arguments) => command_scene_view::picture(arguments),
        SceneCommand::Vtk(arguments) => command_scene_view::vtk(arguments),
    }
}

fn run_one(arguments: &SceneRunArguments) -> anyhow::Result<()> {
    let bar = progress_bar();
    let (shown, interrupted) = (moving(&bar), interruption());
    let progress = |done, all| match interrupted.load(Ordering::Relaxed) {
        true => ControlFlow::Break(()),
        false => shown(done, all),
    };
    let request = SceneRequest {
        out: arguments.out.clone(),
        threads: arguments.threads,
        start: match (arguments.resume, arguments.restart) {
            (true, _) => SceneStart::Resume,
            (false, true) => SceneStart::Restart,
            (false, false) => SceneStart::Fresh,
        },
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

fn run_variants(arguments: &SceneStudyArguments) -> anyhow::Result<()> {
    let bar = progress_bar();
    let progress = moving(&bar);
    let request = StudyRequest {
        out: arguments.out.clone(),
        threads: arguments.threads,
    };
    let outcome = run_study(&arguments.file, &request, &progress);
    bar.finish_and_clear();
    let outcome = outcome?;
    match arguments.format {
        Format::Json => write_json(&outcome),
        Format::Csv => write_result(&csv_of_study(&outcome)?),
        Format::Text => write_result(&text_of_study(&outcome)),
    }
}
