//! Figures as PDF: vectors, with letters that can be searched and are part of the file.

#[cfg(feature = "png")]
mod font;
#[cfg(feature = "png")]
mod packed;
#[cfg(feature = "png")]
mod paint;
#[cfg(feature = "png")]
mod written;

use windfall_files::error::Error;

/// Draws an SVG file as a page of its size; a px is 0.75 pt.
///
/// Text is text, in a part of the font of the figures that the file holds.
///
/// # Errors
/// [`Error::FigureUndrawable`]: the text is no SVG.
/// The same where the cargo feature `png` is off.
pub fn pdf_of_svg(svg: &str) -> Result<Vec<u8>, Error> {
    #[cfg(feature = "png")]
    return written::written(svg);
    #[cfg(not(feature = "png"))]
    {
        let _ = svg;
        let detail = "this build of windfall draws no PDF (its cargo feature `png` is off); \
                      write it as SVG"
            .to_owned();
        Err(Error::FigureUndrawable { detail })
    }
}
