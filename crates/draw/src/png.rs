//! Figures as PNG, at the resolution that journals print.

#[cfg(feature = "png")]
mod drawn;

#[cfg(feature = "png")]
pub(crate) use drawn::{FONT, OPTIONS};

use windfall_files::error::Error;

/// Dots of a PNG per px of the drawing: 300 per inch, where a px is 1/96 inch.
pub const PRINT: f32 = 300.0 / 96.0;

/// Draws an SVG file.
///
/// * `scale`: dots per px of the drawing; [`PRINT`] for paper
///
/// # Errors
/// [`Error::FigureUndrawable`]: the text is no SVG, or so large that there is no
/// room for its dots.
/// The same where the cargo feature `png` is off.
pub fn png_of_svg(svg: &str, scale: f32) -> Result<Vec<u8>, Error> {
    #[cfg(feature = "png")]
    return drawn::drawn(svg, scale);
    #[cfg(not(feature = "png"))]
    {
        let _ = (svg, scale);
        let detail = "this build of windfall draws no PNG (its cargo feature `png` is off); \
                      write it as SVG"
            .to_owned();
        Err(Error::FigureUndrawable { detail })
    }
}
