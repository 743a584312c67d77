//! Figures as files: NAME.svg, NAME.png and NAME.pdf, and NAME.csv with what they show.

use crate::grid::{Grid, drawing_of_grid};
use crate::pdf::pdf_of_svg;
use crate::png::{PRINT, png_of_svg};
use crate::svg::Drawing;
use crate::theme::FigureTheme;
use crate::width::Width;
use crate::xy::{Figure, csv_of_figure, drawing_of_figure};
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::inputs::check_output;
use windfall_files::provenance::digest_text;
use windfall_files::write_file::{check_target, make_directory, write_whole};

/// A kind of file of figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum FigureFormat {
    /// Vectors for pages and editors.
    Svg,
    /// 300 dots per inch.
    Png,
    /// Vectors for journals, the font of the letters included.
    Pdf,
}

impl FigureFormat {
    /// Ending of its files.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Png => "png",
            Self::Pdf => "pdf",
        }
    }

    /// A figure in this format.
    ///
    /// # Errors
    /// [`Error::FigureUndrawable`], also where the cargo feature `png` is off and the format is
    /// not SVG.
    pub fn of_svg(self, svg: &str) -> Result<Vec<u8>, Error> {
        match self {
            Self::Svg => Ok(svg.as_bytes().to_vec()),
            Self::Png => png_of_svg(svg, PRINT),
            Self::Pdf => pdf_of_svg(svg),
        }
    }
}

/// Where figures go and how they are drawn.
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
    /// Width in print, as a journal asks for it: 84mm, 174mm; letters are 8 pt at that size
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "LENGTH", requires = "figures")
    )]
    pub width: Option<Width>,
    /// Formats of the figures in place of SVG and PNG; the data are always CSV
    #[cfg_attr(
        feature = "clap",
        arg(
            id = "figure_format",
            long = "figure-format",
            value_enum,
            value_delimiter = ',',
            value_name = "FORMAT",
            requires = "figures"
        )
    )]
    pub formats: Vec<FigureFormat>,
}

impl FigureFolder {
    /// A directory for figures in light colours, as large as a screen shows them.
    pub fn of(directory: &Path) -> Self {
        Self {
            directory: directory.to_path_buf(),
            ..Self::default()
        }
    }

    /// Formats that are written, by their endings; where none is asked for, SVG, and PNG if this
    /// build draws it.
    fn formats(&self) -> Vec<FigureFormat> {
        let mut formats = match (self.formats.is_empty(), cfg!(feature = "png")) {
            (false, _) => self.formats.clone(),
            (true, true) => vec![FigureFormat::Png, FigureFormat::Svg],
            (true, false) => vec![FigureFormat::Svg],
        };
        formats.sort_by_key(|own| own.ending());
        formats.dedup();
        formats
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

/// What a figure shows, drawn or not yet.
#[derive(Clone, Debug)]
pub enum Picture {
    /// Panels side by side, as many as fit.
    Grid(Grid),
    /// Drawn at the width that was asked for.
    Drawn(Drawing),
}

impl Picture {
    /// The drawing at a width on paper.
    pub fn drawing(&self, width: Option<Width>) -> Drawing {
        match self {
            Self::Grid(grid) => drawing_of_grid(grid, width),
            Self::Drawn(drawing) => drawing.clone(),
        }
    }
}

/// A picture with the data that it shows.
#[derive(Clone, Debug)]
pub struct Painting {
    /// Name of its files, without an ending, as [`file_name`] makes them.
    pub name: String,
    /// What it shows, in a sentence or two.
    pub caption: String,
    /// The picture, whose colours the theme names.
    pub picture: Picture,
    /// The data that it shows, as CSV.
    pub csv: String,
}

/// Writes a figure and its data. Files of the same names are replaced.
///
/// * `name`: id of the recording; what file names cannot hold becomes "_"
///
/// Returns the files: data, and the figure in each format.
pub fn write_figure(
    folder: &FigureFolder,
    name: &str,
    figure: &Figure,
) -> Result<Vec<PathBuf>, Error> {
    write_drawing(
        folder,
        name,
        &drawing_of_figure(figure, folder.width),
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
    let write =
        |p: &Painting| write_drawing(folder, &p.name, &p.picture.drawing(folder.width), &p.csv);
    let written: Result<Vec<Vec<PathBuf>>, Error> = paintings.par_iter().map(write).collect();
    Ok(written?.into_iter().flatten().collect())
}

/// Refuses names of which one may not be written, before any of them is.
fn check_paths<'a>(
    folder: &FigureFolder,
    names: impl Iterator<Item = &'a str>,
) -> Result<(), Error> {
    for name in names {
        let name = file_name(name);
        let endings = folder.formats().into_iter().map(FigureFormat::ending);
        for ending in std::iter::once("csv").chain(endings) {
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
    let formats = folder.formats();
    // Before they are drawn, which takes longest.
    let endings = formats.iter().map(|own| own.ending());
    std::iter::once("csv")
        .chain(endings)
        .try_for_each(|own| check_output(&path(own)))?;
    make_directory(directory)?;
    let svg = drawing.svg(folder.theme.colours());
    let pictures: Result<Vec<Vec<u8>>, Error> =
        formats.iter().map(|own| own.of_svg(&svg)).collect();
    let mut files = vec![path("csv")];
    write_whole(&files[0], csv.as_bytes())?;
    for (format, picture) in formats.iter().zip(pictures?) {
        let file = path(format.ending());
        write_whole(&file, &picture)?;
        files.push(file);
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
                ..FigureFolder::default()
            };
            let painting = Painting {
                name: "force N/mm".to_owned(),
                caption: String::new(),
                picture: Picture::Drawn(Drawing::new(30.0, 20.0)),
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
