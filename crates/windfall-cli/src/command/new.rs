//! `windfall new`

use crate::args::common::NewArguments;
use crate::args::kind::NewKind;
use crate::outcome::WrittenFiles;
use crate::show::{csv_of_names, show};
use windfall_campaign::settings::template::{
    write_scene_template, write_study_template, write_template,
};
use windfall_files::option_value::unusable;
use windfall_files::text::quote::{command, path_word};
use windfall_inspect::gather::new::{Gathered, gather};
use windfall_inspect::gather::preset::preset_of;
use windfall_inspect::gather::text::{csv_of_gathered, text_of_gathered};

/// Writes a template and names the files.
pub fn run(arguments: &NewArguments) -> anyhow::Result<()> {
    let directory = &arguments.directory;
    let kind = arguments.kind.template();
    if let Some(from) = &arguments.from {
        let names = arguments.names.as_deref();
        let Some(kind) = kind else {
            let problem = "a scene has no recordings; name a kind of rig";
            return Err(unusable(format!("--from {}", from.display()), problem).into());
        };
        let preset = arguments.preset.as_deref().map(preset_of).transpose()?;
        let work = || gather(kind, directory, from, names, preset.as_ref());
        let text = |own: &Gathered| text_of_gathered(own, directory);
        show(&arguments.format.into(), work, text, csv_of_gathered)?;
        return Ok(());
    }
    let study = matches!(arguments.kind, NewKind::SceneStudy);
    let on_file = |word: &str, name: &str| {
        let file = path_word(directory.join(name));
        command(&["scene", word, &file])
    };
    let (written, next) = match kind {
        Some(kind) => (
            write_template(kind, directory)?,
            format!(
                "put the recordings into raw/, edit the files, then\n  {}",
                command(&["fit", &path_word(directory)])
            ),
        ),
        None if study => (
            write_study_template(directory)?,
            on_file("study", "study.toml"),
        ),
        None => (
            write_scene_template(directory)?,
            format!("edit the file, then\n  {}", on_file("run", "scene.toml")),
        ),
    };
    let names = written.iter().map(|path| path.display().to_string());
    let files = WrittenFiles {
        written: names.collect(),
    };
    show(
        &arguments.format.into(),
        || Ok::<_, anyhow::Error>(files),
        |own| format!("{}\n\nNext: {next}\n", own.written.join("\n")),
        |own| csv_of_names("written", &own.written),
    )?;
    Ok(())
}
