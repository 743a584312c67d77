//! Figures as files: NAME.svg, NAME.png, and NAME.csv with what they show.

use crate::png::{PRINT, png_of_svg};
use crate::svg::Drawing;
use crate::theme::FigureTheme;
use crate::xy::{Figure, csv_of_figure, drawing_of_figure};
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::inputs::check_output;
use windfall_files::provenance::digest_text;
use windfall_files::write_file::{check_target, make_directory, write_whole};

/// Where figures go and which colours they have.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct FigureFolder {
    /// Write figures into this directory: each as SVG, PNG (300 dots per inch) and its data as CSV
    #[cfg_attr(feature = "clap", arg(id = "figures", long, required = false, value_name = "DIR", value_hint = clap::ValueHint::DirPath))]
    pub directory: PathBuf,
    /// Colours of the figures
    #[cfg_attr(
        feature = "clap",
        arg(long, value_enum, default_value_t, requires = "figures")
    )]
    pub theme: FigureTheme,
}

impl FigureFolder {
    /// A directory for figures on paper.
    pub fn of(directory: &Path) -> Self {
        Self {
            directory: directory.to_path_buf(),
            theme: FigureTheme::Light,
        }
    }
}

/// A figure and the name of its files.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedFigure {
    /// Name of its files, without an ending, as [`file_name`] makes them.
    pub name: String,
    /// What stands below it.
    pub caption: String,
    /// The figure.
    pub figure: Figure,
}

/// A figure that is drawn already, with the data that it shows.
#[derive(Clone, Debug)]
pub struct Painting {
    /// Name of its files, without an ending, as [`file_name`] makes them.
    pub name: String,
    /// What it shows, in a sentence or two.
    pub caption: String,
    /// The picture, whose colours the theme names.
    pub drawing: Drawing,
    /// The data that it shows, as CSV.
    pub csv: String,
}

/// Writes a figure and its data. Files of the same names are replaced.
///
/// * `name`: id of the recording; what file names cannot hold becomes "_"
///
/// Returns the files: data, dots, vectors.
pub fn write_figure(
    folder: &FigureFolder,
    name: &str,
    figure: &Figure,
) -> Result<Vec<PathBuf>, Error> {
    write_drawing(
        folder,
        name,
        &drawing_of_figure(figure),
        &csv_of_figure(figure)?,
    )
}

/// [`write_figure`] of several, on all threads; files in the order of the figures.
pub fn write_figures(
    folder: &FigureFolder,
    figures: &[&NamedFigure],
) -> Result<Vec<PathBuf>, Error> {
    check_paths(folder, figures.iter().map(|own| own.name.as_str()))?;
    let write = |named: &&NamedFigure| write_figure(folder, &named.name, &named.figure);
    let written: Result<Vec<Vec<PathBuf>>, Error> = figures.par_iter().map(write).collect();
    Ok(written?.into_iter().flatten().collect())
}

/// Writes what is drawn already, as [`write_figures`] does.
pub fn write_paintings(
    folder: &FigureFolder,
    paintings: &[Painting],
) -> Result<Vec<PathBuf>, Error> {
    check_paths(folder, paintings.iter().map(|own| own.name.as_str()))?;
    let write = |p: &Painting| write_drawing(folder, &p.name, &p.drawing, &p.csv);
    let written: Result<Vec<Vec<PathBuf>>, Error> = paintings.par_iter().map(write).collect();
    Ok(written?.into_iter().flatten().collect())
}

/// Endings of the files of a figure: data, dots, vectors.
const ENDINGS: [&str; 3] = ["csv", "png", "svg"];

/// Refuses names of which one may not be written, before any of them is.
fn check_paths<'a>(
    folder: &FigureFolder,
    names: impl Iterator<Item = &'a str>,
) -> Result<(), Error> {
    for name in names {
        let name = file_name(name);
        for ending in ENDINGS {
            check_target(&folder.directory.join(format!("{name}.{ending}")))?;
        }
    }
    Ok(())
}

fn write_drawing(
    folder: &FigureFolder,
    name: &str,
    drawing: &Drawing,
    csv: &str,
) -> Result<Vec<PathBuf>, Error> {
    let directory = &folder.directory;
    let name = file_name(name);
    let path = |ending: &str| directory.join(format!("{name}.{ending}"));
    // Before the dots, which take longest.
    ENDINGS
        .iter()
        .try_for_each(|own| check_output(&path(own)))?;
    make_directory(directory)?;
    let svg = drawing.svg(folder.theme.colours());
    let png = match cfg!(feature = "png") {
        true => Some(png_of_svg(&svg, PRINT)?),
        false => None,
    };
    let contents = [Some(csv.as_bytes()), png.as_deref(), Some(svg.as_bytes())];
    let mut files = Vec::new();
    for (ending, contents) in ENDINGS.iter().zip(contents) {
        let Some(contents) = contents else { continue };
        write_whole(&path(ending), contents)?;
        files.push(path(ending));
    }
    Ok(files)
}

/// Longest name of a file, without its ending; bytes.
const LONGEST_NAME: usize = 100;

/// A name for a file: what file names cannot hold becomes "_", and a long name is cut off.
/// Names that would become the same differ in digits of their digest.
pub fn file_name(name: &str) -> String {
    let kept = |c: char| c.is_alphanumeric() || "-_.".contains(c);
    if name.chars().all(kept) && name.len() <= LONGEST_NAME {
        return name.to_owned();
    }
    let mut filled: String = name
        .chars()
        .map(|c| if kept(c) { c } else { '_' })
        .collect();
    let digits = &digest_text(name)[..DIGITS];
    let mut length = DIGITS + 1;
    filled.retain(|c| {
        length += c.len_utf8();
        length <= LONGEST_NAME
    });
    format!("{filled}-{digits}")
}

/// Digits of a digest in a name.
const DIGITS: usize = 6;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::theme::{DARK, LIGHT};

    #[test]
    fn rejects_one_file_for_two_names() {
        let long = "🍏".repeat(99);
        let names = ["a b", "a/b", "a_b", "a:b", &long, &format!("{long}b")];
        let files = names.map(file_name);
        for (place, file) in files.iter().enumerate() {
            assert!(file.len() <= LONGEST_NAME && !files[..place].contains(file));
            assert_eq!(&file_name(file), file);
        }
        assert_eq!(files[2], "a_b");
        assert!(files[0].starts_with("a_b-"));
    }

    /// Vectors, dots and data under one name, in the colours of the theme.
    #[test]
    fn closed_form_three_files_in_the_colours_asked_for() {
        let directory = tempfile::tempdir().unwrap();
        for (theme, colours) in [(FigureTheme::Light, &LIGHT), (FigureTheme::Dark, &DARK)] {
            let folder = FigureFolder {
                directory: directory.path().join("figures"),
                theme,
            };
            let painting = Painting {
                name: "force N/mm".to_owned(),
                caption: String::new(),
                drawing: Drawing::new(30.0, 20.0),
                csv: "x,y\n1,2\n".to_owned(),
            };
            let files = write_paintings(&folder, &[painting]).unwrap();
            let names: Vec<_> = files.iter().map(|f| f.file_name().unwrap()).collect();
            let name = file_name("force N/mm");
            assert_eq!(
                names,
                ["csv", "png", "svg"].map(|own| std::ffi::OsString::from(format!("{name}.{own}")))
            );
            let svg = std::fs::read_to_string(&files[2]).unwrap();
            assert!(svg.contains(colours.background), "{svg}");
            assert_eq!(&std::fs::read(&files[1]).unwrap()[1..4], b"PNG");
        }
    }
}
