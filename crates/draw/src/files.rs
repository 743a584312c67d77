//! Figures as files: NAME.svg, NAME.png, and NAME.csv with what they show.

use crate::png::{PRINT, png_of_svg};
use crate::svg::Drawing;
use crate::theme::FigureTheme;
use crate::xy::{Figure, csv_of_figure, drawing_of_figure};
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::write_file::{make_directory, write_whole};

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
    let write = |named: &&NamedFigure| write_figure(folder, &named.name, &named.figure);
    let written: Result<Vec<Vec<PathBuf>>, Error> = figures.par_iter().map(write).collect();
    Ok(written?.into_iter().flatten().collect())
}

/// Writes what is drawn already, as [`write_figures`] does.
pub fn write_paintings(
    folder: &FigureFolder,
    paintings: &[Painting],
) -> Result<Vec<PathBuf>, Error> {
    let write = |p: &Painting| write_drawing(folder, &p.name, &p.drawing, &p.csv);
    let written: Result<Vec<Vec<PathBuf>>, Error> = paintings.par_iter().map(write).collect();
    Ok(written?.into_iter().flatten().collect())
}

fn write_drawing(
    folder: &FigureFolder,
    name: &str,
    drawing: &Drawing,
    csv: &str,
) -> Result<Vec<PathBuf>, Error> {
    let directory = &folder.directory;
    make_directory(directory)?;
    let svg = drawing.svg(folder.theme.colours());
    let png = match cfg!(feature = "png") {
        true => Some(png_of_svg(&svg, PRINT)?),
        false => None,
    };
    let name = file_name(name);
    let mut files = Vec::new();
    for (ending, contents) in [
        ("csv", Some(csv.as_bytes())),
        ("png", png.as_deref()),
        ("svg", Some(svg.as_bytes())),
    ] {
        let Some(contents) = contents else { continue };
        let path = directory.join(format!("{name}.{ending}"));
        write_whole(&path, contents)?;
        files.push(path);
    }
    Ok(files)
}

/// A name for a file: what file names cannot hold becomes "_".
pub fn file_name(name: &str) -> String {
    let kept = |c: char| c.is_alphanumeric() || "-_.".contains(c);
    let filled = name.chars().map(|c| if kept(c) { c } else { '_' });
    filled.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::theme::{DARK, LIGHT};

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
            assert_eq!(
                names,
                ["force_N_mm.csv", "force_N_mm.png", "force_N_mm.svg"]
            );
            let svg = std::fs::read_to_string(&files[2]).unwrap();
            assert!(svg.contains(colours.background), "{svg}");
            assert_eq!(&std::fs::read(&files[1]).unwrap()[1..4], b"PNG");
        }
    }
}
