//! `windfall new`

use crate::args::common::{NewArguments, NewKind};
use crate::args::format::Format;
use crate::show::{write_json, write_result};
use windfall_campaign::settings::template::{
    TemplateKind, write_scene_template, write_study_template, write_template,
};

/// Writes a template and names the files.
pub fn run(arguments: &NewArguments) -> anyhow::Result<()> {
    let directory = &arguments.directory;
    let kind = match arguments.kind {
        NewKind::Pendulum => Some(TemplateKind::Pendulum),
        NewKind::Carriage => Some(TemplateKind::Carriage),
        NewKind::Compression => Some(TemplateKind::Compression),
        NewKind::Acoustic => Some(TemplateKind::Acoustic),
        NewKind::Repeats => Some(TemplateKind::Repeats),
        NewKind::Drop => Some(TemplateKind::Drop),
        NewKind::Scene | NewKind::SceneStudy => None,
    };
    let study = matches!(arguments.kind, NewKind::SceneStudy);
    let (written, next) = match kind {
        Some(kind) => (
            write_template(kind, directory)?,
            format!(
                "put the recordings into raw/, edit the files, then\n  windfall fit {}",
                directory.display()
            ),
        ),
        None if study => (
            write_study_template(directory)?,
            format!(
                "windfall scene study {}",
                directory.join("study.toml").display()
            ),
        ),
        None => (
            write_scene_template(directory)?,
            format!(
                "edit the file, then\n  windfall scene run {}",
                directory.join("scene.toml").display()
            ),
        ),
    };
    let names: Vec<String> = written
        .iter()
        .map(|path| path.display().to_string())
        .collect();
    match arguments.format {
        Format::Json => write_json(&serde_json::json!({ "written": names })),
        Format::Csv => write_result(&format!("written\n{}\n", names.join("\n"))),
        Format::Text => write_result(&format!("{}\n\nNext: {next}\n", names.join("\n"))),
    }
}
