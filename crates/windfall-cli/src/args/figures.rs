//! Where figures go and which colours they have, for every command that draws.

use clap::{Args, ValueEnum, ValueHint};
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
    #[arg(long, value_enum, default_value_t = Theme::Light, requires = "figures")]
    pub theme: Theme,
}

impl FigureArguments {
    /// As the workflows take it; `None` where no figures were asked for.
    pub fn folder(&self) -> Option<FigureFolder> {
        let directory = self.figures.clone()?;
        let theme = self.theme.into();
        Some(FigureFolder { directory, theme })
    }
}

/// Colours of figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Theme {
    /// For paper
    Light,
    /// For dark screens and slides
    Dark,
}

impl From<Theme> for FigureTheme {
    fn from(theme: Theme) -> Self {
        match theme {
            Theme::Light => Self::Light,
            Theme::Dark => Self::Dark,
        }
    }
}
