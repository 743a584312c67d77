//! One figure under the name that `--plot` gives, with its data beside it.

use crate::png::{PRINT, png_of_svg};
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_files::write_file::{check_outputs, write_whole};

/// Writes a figure as SVG or PNG, by the ending of the name, and what it shows
/// as CSV under the same name.
///
/// * `option`: that names the figure, for errors
///
/// # Errors
/// The name has another ending; one of the two may not be written, or cannot.
pub fn write_plot(
    option: &str,
    path: &Path,
    svg: String,
    csv: &str,
) -> Result<[PathBuf; 2], Error> {
    let unusable = |problem: String| unusable(format!("{option} {}", path.display()), problem);
    let dots = match path.extension().and_then(|extension| extension.to_str()) {
        Some("svg") => false,
        Some("png") => true,
        _ => {
            return Err(unusable(
                "figures are written as SVG or PNG; give a name that ends in \".svg\" or \".png\""
                    .to_owned(),
            ));
        }
    };
    let data = path.with_extension("csv");
    check_outputs([Some(path), Some(data.as_path())])?;
    let picture = match dots {
        true => png_of_svg(&svg, PRINT)?,
        false => svg.into_bytes(),
    };
    write_whole(path, &picture)?;
    write_whole(&data, csv.as_bytes())?;
    Ok([path.to_path_buf(), data])
}
