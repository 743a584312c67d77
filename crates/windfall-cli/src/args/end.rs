//! When a simulated contact is over.

use clap::ValueEnum;

/// When a simulated contact is over.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum End {
    /// When the law's force returns to zero: no adhesion
    #[default]
    ForceZero,
    /// When the displacement is back at zero
    GapZero,
}

/// The word that the library knows.
pub fn end_text(end: End) -> String {
    match end {
        End::ForceZero => "force-zero".to_owned(),
        End::GapZero => "gap-zero".to_owned(),
    }
}
