//! Tables of a scene that has run, for programs that read columns.

use crate::frames::read::SceneFrames;
use crate::frames::view::{open_frames, run_directory};
use crate::run::columns::SceneTable;
use crate::run::frame_format::{Frame, FruitFrame};
use serde::Serialize;
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::inputs::protect;
use windfall_files::progress::Progress;
use windfall_files::sheet::Cell;
use windfall_files::sheet::each_row::each_row;
use windfall_files::sheet::form::Form;
use windfall_files::sheet::write::{TableWriter, write_table};

/// A table that was written.
#[derive(Clone, Debug, Serialize, utoipa::ToSchema)]
pub struct TableOutcome {
    /// Rows.
    pub rows: u64,
    /// The file.
    #[schema(value_type = String)]
    pub file: PathBuf,
}

/// Writes a table of a scene that has run.
///
/// * `path`: directory of the results, or the scene file beside it
/// * `out`: an ending says the form: .parquet, .arrow, .csv
///
/// # Errors
/// The scene has not run, or without frames; a file cannot be read or written; it was cancelled.
pub fn table_of_scene(
    path: &Path,
    table: SceneTable,
    out: &Path,
    progress: Progress,
) -> Result<TableOutcome, Error> {
    let form = Form::of_path("--out", out)?;
    let (schema, mut rows) = (table.schema(), 0);
    // What is read is known before it is decided what may be written.
    if table == SceneTable::Frames {
        let mut frames = open_frames(path)?;
        write_table(out, form, &schema, |writer| {
            fill_frames(&mut frames, writer, &mut rows, progress)
        })?;
    } else {
        let text = run_directory(path).join(format!("{}.csv", schema.table));
        if !text.is_file() {
            let advice = "run the scene to its end first: windfall scene run FILE".to_owned();
            return Err(Error::FileAbsent { path: text, advice });
        }
        protect(&text);
        write_table(out, form, &schema, |writer| {
            each_row(&text, &schema, |row| {
                rows += 1;
                writer.push(row)
            })
        })?;
    }
    let file = out.to_path_buf();
    Ok(TableOutcome { rows, file })
}

fn fill_frames(
    frames: &mut SceneFrames,
    writer: &mut TableWriter,
    rows: &mut u64,
    progress: Progress,
) -> Result<(), Error> {
    let all = frames.frames.len();
    for number in 0..all {
        let frame = frames.frame(number)?;
        for fruit in &frame.fruit {
            let radius = frames.radii[fruit.fruit as usize - 1];
            writer.push(&row(&frame, fruit, radius))?;
            *rows += 1;
        }
        if progress(number + 1, all).is_break() {
            return Err(Error::Cancelled);
        }
    }
    Ok(())
}

fn row(frame: &Frame, own: &FruitFrame, radius: f32) -> Vec<Cell<'static>> {
    let numbers = own.place.iter().chain(&own.turn).chain(&own.velocity);
    let numbers = numbers.copied().chain([radius, own.peak_force]);
    let first = [Cell::Number(frame.time), Cell::Count(own.fruit.into())];
    let rest = numbers.map(|value| Cell::Number(value.into()));
    first.into_iter().chain(rest).collect()
}
