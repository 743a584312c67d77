//! One figure under the name that `--plot` gives, with its data beside it.

use crate::files::FigureFormat;
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_files::write_file::{check_outputs, write_whole};

/// Writes a figure as SVG, PNG or PDF, by the ending of the name, and what it shows
/// as CSV under the same name.
///
/// * `option`: that names the figure, for errors
///
/// # Errors
/// The name has another ending; one of the two may not be written, or cannot.
pub fn write_plot(option: &str, path: &Path, svg: &str, csv: &str) -> Result<[PathBuf; 2], Error> {
    let unusable = |problem: String| unusable(format!("{option} {}", path.display()), problem);
    let formats = [FigureFormat::Svg, FigureFormat::Png, FigureFormat::Pdf];
    let ending = path.extension().and_then(|extension| extension.to_str());
    let Some(format) = formats.iter().find(|own| Some(own.ending()) == ending) else {
        return Err(unusable(
            "figures are written as SVG, PNG or PDF; give a name that ends in \".svg\", \".png\" \
             or \".pdf\""
                .to_owned(),
        ));
    };
    let data = path.with_extension("csv");
    check_outputs([Some(path), Some(data.as_path())])?;
    let picture = format.of_svg(svg)?;
    write_whole(path, &picture)?;
    write_whole(&data, csv.as_bytes())?;
    Ok([path.to_path_buf(), data])
}
