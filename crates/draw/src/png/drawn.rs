//! SVG drawn as PNG.

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};
use std::sync::{Arc, LazyLock};
use windfall_files::error::Error;

/// The font of every figure, so that a picture does not depend on the fonts of the
/// machine: Liberation Sans, as wide as Arial and Helvetica (licence beside it).
pub static FONT: &[u8] = include_bytes!("../../fonts/LiberationSans-Regular.ttf");
const FONT_FAMILY: &str = "Liberation Sans";

/// Read once: it takes longer than a figure.
pub static OPTIONS: LazyLock<Options<'static>> = LazyLock::new(|| {
    let mut options = Options {
        font_family: FONT_FAMILY.to_owned(),
        ..Options::default()
    };
    let fonts = Arc::make_mut(&mut options.fontdb);
    fonts.load_font_data(FONT.to_vec());
    fonts.set_sans_serif_family(FONT_FAMILY);
    options
});

/// See [`png_of_svg`](crate::png::png_of_svg).
pub fn drawn(svg: &str, scale: f32) -> Result<Vec<u8>, Error> {
    let failed = |detail: String| Error::FigureUndrawable { detail };
    let tree = Tree::from_str(svg, &OPTIONS).map_err(|error| failed(error.to_string()))?;
    let size = tree.size();
    let dots = |length: f32| (length * scale).ceil() as u32;
    let (width, height) = (dots(size.width()), dots(size.height()));
    let mut picture = Pixmap::new(width, height)
        .ok_or_else(|| failed(format!("{width} x {height} dots have no room")))?;
    let transform = Transform::from_scale(scale, scale);
    resvg::render(&tree, transform, &mut picture.as_mut());
    picture
        .encode_png()
        .map_err(|error| failed(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::png::png_of_svg;
    use crate::svg::{Anchor, Drawing, Ink};
    use crate::theme::{DARK, LIGHT, Theme};

    fn picture(theme: &Theme, text: &str) -> Pixmap {
        let mut drawing = Drawing::new(60.0, 20.0);
        drawing.dot((5.0, 10.0), 4.0, Ink::Series(0));
        drawing.text((12.0, 14.0), Anchor::Start, 10.0, text);
        Pixmap::decode_png(&png_of_svg(&drawing.svg(theme), 2.0).unwrap()).unwrap()
    }

    /// The PNG has the dots asked for, the colours of the theme, and letters.
    #[test]
    fn closed_form_dots_colours_and_letters() {
        for (theme, background, series) in [
            (&LIGHT, [255, 255, 255], [0x00, 0x72, 0xb2]),
            (&DARK, [0x14, 0x17, 0x1a], [0x4b, 0xa3, 0xe3]),
        ] {
            let written = picture(theme, "F (N)");
            assert_eq!((written.width(), written.height()), (120, 40));
            let at = |p: &Pixmap, x, y| p.pixel(x, y).map(|c| [c.red(), c.green(), c.blue()]);
            assert_eq!(at(&written, 119, 0), Some(background));
            assert_eq!(at(&written, 10, 20), Some(series));
            // Letters change the picture, raised digits too.
            assert_ne!(written.data(), picture(theme, "").data());
            assert_ne!(picture(theme, "s²").data(), picture(theme, "s").data());
        }
    }

    #[test]
    fn refuses_what_is_no_drawing() {
        let error = png_of_svg("<svg", 1.0).unwrap_err().to_string();
        assert!(error.contains("figure"), "{error}");
    }
}
