//! Figures of a campaign as files: NAME.svg, and NAME.csv with what it shows.

use crate::error::Error;
use crate::figure_xy::{Figure, csv_of_figure, svg_of_figure};
use std::path::{Path, PathBuf};

/// Writes a figure and its data into a directory, which is made where it is
/// missing. A file of the same name is replaced.
///
/// * `name`: id of the recording; what file names cannot hold becomes "_"
///
/// # Errors
/// The directory or a file cannot be written.
pub fn write_figure(directory: &Path, name: &str, figure: &Figure) -> Result<PathBuf, Error> {
    let failed = |path: &Path| {
        let path = path.to_path_buf();
        move |source| Error::FileAccess {
            path,
            action: "write",
            source,
        }
    };
    std::fs::create_dir_all(directory).map_err(failed(directory))?;
    let kept = |c: char| c.is_alphanumeric() || "-_.".contains(c);
    let name: String = name
        .chars()
        .map(|c| if kept(c) { c } else { '_' })
        .collect();
    let picture = directory.join(format!("{name}.svg"));
    std::fs::write(&picture, svg_of_figure(figure)).map_err(failed(&picture))?;
    let table = directory.join(format!("{name}.csv"));
    std::fs::write(&table, csv_of_figure(figure)?).map_err(failed(&table))?;
    Ok(picture)
}
