//! `windfall scene`

use crate::args::scene::{
    ExportName, SceneCommand, SceneExportArguments, SceneRunArguments, SceneStudyArguments,
};
use crate::caller::watch;
use crate::command::scene_view;
use crate::progress::with_bar;
use crate::show::show;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use windfall_engines::contacts::{ContactsOutcome, export_contacts};
use windfall_engines::parameters::Other;
use windfall_engines::ranks::follow::run_rank;
use windfall_engines::run::{DeckOutcome, EngineRequest, export_deck, run_on_engine};
use windfall_engines::text::{text_of_contacts, text_of_deck};
use windfall_scene_run::file::engine_kind::Engine;
use windfall_scene_run::run::stopped::SceneStart;
use windfall_scene_run::run::tables::{csv_of_scene, text_of_scene};
use windfall_scene_run::run::workflow::SceneRequest;
use windfall_scene_run::study::run::run_study;
use windfall_scene_run::study::text::{csv_of_study, text_of_study};
use windfall_web::interrupt::interruption;

/// Runs what is asked of scenes.
pub fn run(command: &SceneCommand) -> anyhow::Result<()> {
    match command {
        SceneCommand::Run(arguments) => run_one(arguments),
        SceneCommand::Study(arguments) => run_variants(arguments),
        SceneCommand::Picture(arguments) => scene_view::picture(arguments),
        SceneCommand::Vtk(arguments) => scene_view::vtk(arguments),
        SceneCommand::Table(arguments) => scene_view::table(arguments),
        SceneCommand::Export(arguments) => export(arguments),
        SceneCommand::Rank(request) => Ok(run_rank(request)?),
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
    if let Some(speed) = speed {
        anyhow::ensure!(
            speed > 0.0 && speed.is_finite(),
            "--speed {speed}: a speed above zero, in m/s"
        );
    }
    let (file, out) = (&arguments.file, arguments.out.as_deref());
    let work = || export_contacts(file, other, out, speed);
    let csv = |own: &ContactsOutcome| Ok(text_of_contacts(own));
    show(&arguments.format.into(), work, text_of_contacts, csv)?;
    Ok(())
}

fn deck(arguments: &SceneExportArguments, engine: Engine) -> anyhow::Result<()> {
    let (file, out) = (&arguments.file, arguments.out.as_deref());
    let work = || export_deck(file, engine, &arguments.deck, out);
    let csv = |own: &DeckOutcome| Ok(text_of_deck(own));
    show(&arguments.format.into(), work, text_of_deck, csv)?;
    Ok(())
}

fn run_one(arguments: &SceneRunArguments) -> anyhow::Result<()> {
    let request = SceneRequest {
        start: match (arguments.resume, arguments.restart) {
            (true, _) => SceneStart::Resume,
            (false, true) => SceneStart::Restart,
            (false, false) => SceneStart::Fresh,
        },
        ..arguments.request.clone()
    };
    let engine = EngineRequest {
        windfall: command(),
        ..arguments.engine.clone()
    };
    // A program that called has signals of its own, and says when to stop.
    let interrupted = match watch().is_some() {
        true => Arc::default(),
        false => interruption(),
    };
    let work = || {
        with_bar(|shown| {
            let progress = |done, all| match interrupted.load(Ordering::Relaxed) {
                true => ControlFlow::Break(()),
                false => shown(done, all),
            };
            run_on_engine(&arguments.file, &request, &engine, &progress)
        })
    };
    show(&arguments.format.into(), work, text_of_scene, csv_of_scene)?;
    Ok(())
}

/// The command itself, which ranks start: this program, or the script that an interpreter runs.
fn command() -> Option<PathBuf> {
    let words = std::env::args_os().take(2).map(PathBuf::from);
    let mut programs = std::env::current_exe().ok().into_iter().chain(words);
    let is_windfall = |path: &Path| path.file_stem().is_some_and(|stem| stem == "windfall");
    programs.find(|path| is_windfall(path) && path.is_file())
}

fn run_variants(arguments: &SceneStudyArguments) -> anyhow::Result<()> {
    let (file, request) = (&arguments.file, &arguments.request);
    let work = || with_bar(|progress| run_study(file, request, progress));
    show(&arguments.format.into(), work, text_of_study, csv_of_study)?;
    Ok(())
}
