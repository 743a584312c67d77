//! `windfall report`: arguments.

use crate::args::format::Format;
use clap::{Args, ValueHint};
use std::path::PathBuf;
use windfall_draw::files::FigureFormat;
use windfall_draw::theme::FigureTheme;
use windfall_draw::width::Width;

/// `windfall report`
#[derive(Debug, Args)]
#[command(
    after_help = "Fits what is not in DIR/results.sqlite yet, then writes into DIR/report: report.html \
(numbered figures and tables, methods, findings and origin in one file that needs no network; print it for a PDF), \
figures/ (each as SVG, PNG at 300 dots per inch, and CSV, or as --figure-format says), impacts.csv, results.json, inputs.csv \
(SHA-256 of every file read), windfall.bib and CITATION.cff. Files of other names there are left alone.

Examples:
  windfall report my-campaign
  windfall report my-campaign --group variety --intervals profile
  windfall report my-campaign --law kuwabara-kono --law hertz --out two-laws --theme dark
  windfall report my-campaign --width 84mm --figure-format pdf"
)]
pub struct ReportArguments {
    /// The campaign directory
    #[arg(default_value = ".", value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub directory: PathBuf,
    /// Directory to write into in place of DIR/report
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Colours of the files of figures; the page follows the reader's setting
    #[arg(long, value_enum, default_value_t = FigureTheme::Light)]
    pub theme: FigureTheme,
    /// Width of the files of figures in print, as a journal asks for it: 84mm, 174mm; letters are 8 pt at that size
    #[arg(long, value_name = "LENGTH")]
    pub width: Option<Width>,
    /// Formats of the files of figures in place of SVG and PNG
    #[arg(long, value_enum, value_delimiter = ',', value_name = "FORMAT")]
    pub figure_format: Vec<FigureFormat>,
    /// Law to fit in place of those of the campaign; may be repeated
    #[arg(long = "law", value_name = "LAW")]
    pub laws: Vec<String>,
    /// Parameter to estimate although it has a value; may be repeated
    #[arg(long, value_name = "NAME")]
    pub free: Vec<String>,
    /// How the 95 % intervals are made
    #[arg(long, value_parser = ["asymptotic", "profile", "bootstrap", "posterior"], value_name = "HOW")]
    pub intervals: Option<String>,
    /// Column of specimens.csv or impacts.csv by which results are grouped
    #[arg(long, value_name = "COLUMN")]
    pub group: Option<String>,
    /// Number of threads; all cores if left out. It never changes a result
    #[arg(long, value_name = "N")]
    pub threads: Option<usize>,
    /// How the list of written files is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}
