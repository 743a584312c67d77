//! `windfall scene`

use crate::args::format::Format;
use crate::args::scene::{
    EngineName, ExportName, SceneCommand, SceneExportArguments, SceneRunArguments,
    SceneStudyArguments,
};
use crate::command::fit::{moving, progress_bar};
use crate::command::scene_view;
use crate::show::{write_json, write_result};
use std::ops::ControlFlow;
use std::sync::atomic::Ordering;
use windfall_engines::contacts::export_contacts;
use windfall_engines::parameters::Other;
use windfall_engines::run::{EngineRequest, export_deck, run_on_engine};
use windfall_engines::text::{text_of_contacts, text_of_deck};
use windfall_scene_run::file::engine_kind::Engine;
use windfall_scene_run::run::advance::SceneStart;
use windfall_scene_run::run::tables::{csv_of_scene, text_of_scene};
use windfall_scene_run::run::workflow::SceneRequest;
use windfall_scene_run::study::run::{StudyRequest, run_study};
use windfall_scene_run::study::text::{csv_of_study, text_of_study};
use windfall_web::interrupt::interruption;

/// Runs what is asked of scenes.
pub fn run(command: &SceneCommand) -> anyhow::Result<()> {
    match command {
        SceneCommand::Run(arguments) => run_one(arguments),
        SceneCommand::Study(arguments) => run_variants(arguments),
        SceneCommand::Picture(arguments) => scene_view::picture(arguments),
        SceneCommand::Vtk(arguments) => scene_view::vtk(arguments),
        SceneCommand::Export(arguments) => export(arguments),
    }
}

fn engine(name: EngineName) -> Engine {
    match name {
        EngineName::Windfall => Engine::Windfall,
        EngineName::Lammps => Engine::Lammps,
        EngineName::Liggghts => Engine::Liggghts,
    }
}

fn export(arguments: &SceneExportArguments) -> anyhow::Result<()> {
    let other = match arguments.engine {
        ExportName::Lammps => return deck(arguments, Engine::Lammps),
        ExportName::Liggghts => return deck(arguments, Engine::Liggghts),
        ExportName::Adams => Other::Adams,
        ExportName::Yade => Other::Yade,
        ExportName::Mercurydpm => Other::MercuryDpm,
        ExportName::Edem => Other::Edem,
        ExportName::Chrono => Other::Chrono,
    };
    let speed = arguments.speed;
    anyhow::ensure!(
        speed > 0.0 && speed.is_finite(),
        "--speed {speed}: a speed above zero, in m/s"
    );
    let outcome = export_contacts(&arguments.file, other, arguments.out.as_deref(), speed)?;
    match arguments.format {
        Format::Json => write_json(&outcome),
        _ => write_result(&text_of_contacts(&outcome)),
    }
}

fn deck(arguments: &SceneExportArguments, engine: Engine) -> anyhow::Result<()> {
    let request = EngineRequest {
        engine,
        classes: arguments.of_engine.classes,
        frame_steps: arguments.of_engine.frame_steps,
        ..EngineRequest::default()
    };
    let outcome = export_deck(&arguments.file, &request, arguments.out.as_deref())?;
    match arguments.format {
        Format::Json => write_json(&outcome),
        _ => write_result(&text_of_deck(&outcome)),
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
    let own = EngineRequest {
        engine: engine(arguments.engine),
        program: arguments.engine_program.clone(),
        ranks: arguments.ranks,
        classes: arguments.of_engine.classes,
        frame_steps: arguments.of_engine.frame_steps,
        frames: arguments.frames.clone(),
    };
    let outcome = run_on_engine(&arguments.file, &request, &own, &progress);
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
