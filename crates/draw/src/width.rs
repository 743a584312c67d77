//! How wide a figure is printed, and how large its letters are then.

use std::fmt::{Display, Formatter};
use std::str::FromStr;
use windfall_files::error::Error;
use windfall_files::option_value::{quantity, unusable};

/// A px of a drawing on paper; mm.
const PX: f64 = 25.4 / 96.0;

/// Narrowest and widest figure; mm. In a narrower one letters of 8 pt leave no room for data.
const NARROWEST: u32 = 60;
const WIDEST: u32 = 400;

/// Size of all letters on paper but raised ones: 8 pt; px.
pub const LETTERS: f64 = 8.0 / 0.75;

/// Least width of lines on paper: 0.5 pt; px.
pub const LEAST_LINE: f64 = 0.5 / 0.75;

/// Least width of a panel with its axes where several stand side by side; px.
const LEAST_CELL: f64 = 290.0;

/// The width that a figure has on paper.
///
/// Its letters are 8 pt (raised ones 5.8 pt), its lines at least 0.5 pt, and its panels stand side
/// by side as far as they fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Width {
    /// µm.
    micrometres: u32,
}

impl Width {
    /// The text width of a page, as two columns of a journal have it: 174 mm.
    pub const PAGE: Self = Self {
        micrometres: 174_000,
    };

    /// Two thirds of it, for a panel that stands alone on a page.
    pub const ALONE: Self = Self {
        micrometres: 116_000,
    };

    /// In mm.
    pub fn mm(self) -> f64 {
        f64::from(self.micrometres) / 1e3
    }

    /// In px of the drawing, which are 1/96 inch.
    pub fn px(self) -> f64 {
        self.mm() / PX
    }

    /// How many of these panels stand side by side.
    pub fn columns(self, panels: usize) -> usize {
        ((self.px() / LEAST_CELL) as usize).clamp(1, panels.max(1))
    }
}

/// A length in px as text in mm.
pub fn mm_text(px: f64) -> String {
    format!("{}mm", (px * PX * 1e3).round() / 1e3)
}

impl FromStr for Width {
    type Err = Error;

    /// From a length with its unit, such as "84 mm".
    fn from_str(text: &str) -> Result<Self, Error> {
        let mm = 1e3 * quantity("--width", text, "m")?;
        match (f64::from(NARROWEST)..=f64::from(WIDEST)).contains(&mm) {
            true => Ok(Self {
                micrometres: (mm * 1e3).round() as u32,
            }),
            false => Err(unusable(
                format!("--width {text}"),
                format!("figures with letters of 8 pt are {NARROWEST} mm to {WIDEST} mm wide"),
            )),
        }
    }
}

impl Display for Width {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} mm", self.mm())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_widths_of_journals() {
        let one: Width = "84mm".parse().unwrap();
        assert_eq!((one.mm(), one.columns(4)), (84.0, 1));
        assert!((one.px() - 317.480_315).abs() < 1e-6);
        assert_eq!("17.4 cm".parse::<Width>().unwrap(), Width::PAGE);
        assert_eq!((Width::PAGE.columns(4), Width::PAGE.columns(1)), (2, 1));
        assert_eq!(mm_text(one.px()), "84mm");
        for wrong in ["84", "59 mm", "0.5 m", "84 N", "NaN mm"] {
            assert!(wrong.parse::<Width>().is_err(), "{wrong}");
        }
    }
}
