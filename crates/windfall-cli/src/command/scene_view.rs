//! `windfall scene picture`, `windfall scene vtk` and `windfall scene table`

use crate::args::scene_view::{ScenePictureArguments, SceneTableArguments, SceneVtkArguments};
use crate::progress::with_bar;
use crate::show::{csv_of_names, show};
use windfall_files::option_value::{positive, quantity, unusable};
use windfall_scene_run::frames::table::{TableOutcome, table_of_scene};
use windfall_scene_run::frames::view::{
    PictureOutcome, PictureRequest, VtkOutcome, draw_scene, vtk_of_scene,
};

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
        width: arguments.width,
        out: arguments.out.clone(),
    };
    let work = || draw_scene(&arguments.run, &request);
    let text = |own: &PictureOutcome| {
        let files = own.files.iter().map(|file| file.display().to_string());
        let files = files.collect::<Vec<_>>().join(", ");
        format!("{}\n\nWritten: {files}\n", own.caption)
    };
    let csv = |own: &PictureOutcome| csv_of_names("file", own.files.iter().map(|f| f.display()));
    show(&arguments.format.into(), work, text, csv)?;
    Ok(())
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
    let work = || with_bar(|progress| vtk_of_scene(&arguments.run, out, progress));
    let text = |own: &VtkOutcome| {
        let (frames, files) = (own.frames, own.files);
        let written = own.collection.display();
        format!(
            "{frames} frames. Open this one in ParaView; {files} files lie beside it.\n\n\
             Written: {written}\n"
        )
    };
    let csv = |own: &VtkOutcome| csv_of_names("file", [own.collection.display()]);
    show(&arguments.format.into(), work, text, csv)?;
    Ok(())
}

/// Writes a table for other programs.
pub fn table(arguments: &SceneTableArguments) -> anyhow::Result<()> {
    let (run, table, out) = (&arguments.run, arguments.table, &arguments.out);
    let work = || with_bar(|progress| table_of_scene(run, table, out, progress));
    let text = |own: &TableOutcome| {
        let (rows, file) = (own.rows, own.file.display());
        format!("{rows} rows.\n\nWritten: {file}\n")
    };
    let csv = |own: &TableOutcome| csv_of_names("file", [own.file.display()]);
    show(&arguments.format.into(), work, text, csv)?;
    Ok(())
}
