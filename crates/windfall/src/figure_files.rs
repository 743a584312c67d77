//! Figures of a campaign as files: NAME.svg, and NAME.csv with what it shows.

use crate::error::Error;
use crate::figure_theme::LIGHT;
use crate::figure_xy::{Figure, csv_of_figure, svg_of_figure};
use crate::write_file::write_whole;
use std::path::{Path, PathBuf};

/// Writes a figure and its data into a directory, which is made where it is
/// missing. A file of the same name is replaced.
///
/// * `name`: id of the recording; what file names cannot hold becomes "_"
///
/// # Errors
/// The directory or a file cannot be written.
pub fn write_figure(directory: &Path, name: &str, figure: &Figure) -> Result<PathBuf, Error> {
    std::fs::create_dir_all(directory).map_err(|source| Error::FileAccess {
        path: directory.to_path_buf(),
        action: "write",
        source,
    })?;
    let name = file_name(name);
    let picture = directory.join(format!("{name}.svg"));
    write_whole(&picture, svg_of_figure(figure, &LIGHT).as_bytes())?;
    let table = directory.join(format!("{name}.csv"));
    write_whole(&table, csv_of_figure(figure)?.as_bytes())?;
    Ok(picture)
}

/// A name for a file: what file names cannot hold becomes "_".
#[must_use]
pub fn file_name(name: &str) -> String {
    let kept = |c: char| c.is_alphanumeric() || "-_.".contains(c);
    let filled = name.chars().map(|c| if kept(c) { c } else { '_' });
    filled.collect()
}
