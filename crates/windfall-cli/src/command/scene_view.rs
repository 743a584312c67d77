//! `windfall scene picture`, `windfall scene vtk` and `windfall scene table`

use crate::args::format::Format;
use crate::args::scene_view::{ScenePictureArguments, SceneTableArguments, SceneVtkArguments};
use crate::progress::with_bar;
use crate::show::{write_json, write_names, write_result};
use windfall_files::option_value::{positive, quantity, unusable};
use windfall_scene_run::frames::table::table_of_scene;
use windfall_scene_run::frames::view::{PictureRequest, draw_scene, vtk_of_scene};

/// Draws a scene.
pub fn picture(arguments: &ScenePictureArguments) -> anyhow::Result<()> {
    let time = arguments.time.as_deref();
    let most = arguments.largest_force.as_deref();
    let request = PictureRequest {
        time: time.map(|text| quantity("--time", text, "s")).transpose()?,
        from: arguments.from.as_deref().map(angles).transpose()?,
        most: most
            .map(|text| positive("--largest-force", text, "N"))
            .transpose()?,
        theme: arguments.theme,
        out: arguments.out.clone(),
    };
    let outcome = draw_scene(&arguments.run, &request)?;
    let files: Vec<String> = outcome
        .files
        .iter()
        .map(|file| file.display().to_string())
        .collect();
    match arguments.format {
        Format::Json => write_json(&outcome),
        Format::Csv => write_names("file", &files),
        Format::Text => write_result(&format!(
            "{}\n\nWritten: {}\n",
            outcome.caption,
            files.join(", ")
        )),
    }
}

/// Azimuth and elevation; rad.
fn angles(text: &str) -> Result<[f64; 2], windfall_files::error::Error> {
    const OPTION: &str = "--from";
    let Some((azimuth, elevation)) = text.split_once(',') else {
        let problem = format!("\"{text}\": expected azimuth and elevation, as \"-62 deg,24 deg\"");
        return Err(unusable(OPTION, problem));
    };
    Ok([
        quantity(OPTION, azimuth.trim(), "rad")?,
        quantity(OPTION, elevation.trim(), "rad")?,
    ])
}

/// Writes files for ParaView.
pub fn vtk(arguments: &SceneVtkArguments) -> anyhow::Result<()> {
    let out = arguments.out.as_deref();
    let outcome = with_bar(|progress| vtk_of_scene(&arguments.run, out, progress))?;
    match arguments.format {
        Format::Json => write_json(&outcome),
        Format::Csv => write_names("file", &[outcome.collection.display().to_string()]),
        Format::Text => write_result(&format!(
            "{} frames. Open this one in ParaView; {} files lie beside it.\n\nWritten: {}\n",
            outcome.frames,
            outcome.files,
            outcome.collection.display()
        )),
    }
}

/// Writes a table for other programs.
pub fn table(arguments: &SceneTableArguments) -> anyhow::Result<()> {
    let (run, table, out) = (&arguments.run, arguments.table, &arguments.out);
    let outcome = with_bar(|progress| table_of_scene(run, table, out, progress))?;
    match arguments.format {
        Format::Json => write_json(&outcome),
        Format::Csv => write_names("file", &[outcome.file.display().to_string()]),
        Format::Text => write_result(&format!(
            "{} rows.\n\nWritten: {}\n",
            outcome.rows,
            outcome.file.display()
        )),
    }
}
