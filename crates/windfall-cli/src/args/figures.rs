//! Where figures go and which colours they have, for every command that draws.

use clap::{Args, ValueHint};
use std::path::PathBuf;
use windfall_draw::files::FigureFolder;
use windfall_draw::theme::FigureTheme;

/// Figures beside the result.
#[derive(Debug, Args)]
pub struct FigureArguments {
    /// Write figures into this directory: each as SVG, PNG (300 dots per inch) and its data as CSV
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub figures: Option<PathBuf>,
    /// Colours of the figures
    #[arg(long, value_enum, default_value_t = FigureTheme::Light, requires = "figures")]
    pub theme: FigureTheme,
}

impl FigureArguments {
    /// The folder, if figures were requested.
    pub fn folder(&self) -> Option<FigureFolder> {
        let directory = self.figures.clone()?;
        let theme = self.theme;
        Some(FigureFolder { directory, theme })
    }
}
