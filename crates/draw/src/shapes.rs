//! What series are told apart by without colours, and how balls are lit.

use crate::colour_map::{Rgb, css, mixed};
use std::fmt::Write;

/// Dashes of lines by their number.
pub(crate) const PATTERNS: [&str; 7] = [
    "",
    "8 2.5 2 2.5",
    "2 2.5",
    "12 4",
    "8 2.5 2 2.5 2 2.5",
    "4 2 1 2",
    "14 3 3 3",
];

/// Corners of marks by their number, over the radius of a dot of about the same area; a dot itself
/// has none.
pub(crate) const SHAPES: [&[(f64, f64)]; 7] = [
    &[],
    &[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)],
    &[(0.0, -1.4), (1.25, 0.8), (-1.25, 0.8)],
    &[(0.0, -1.35), (1.35, 0.0), (0.0, 1.35), (-1.35, 0.0)],
    &[(0.0, 1.4), (1.25, -0.8), (-1.25, -0.8)],
    &[
        (-0.45, -1.35),
        (0.45, -1.35),
        (0.45, -0.45),
        (1.35, -0.45),
        (1.35, 0.45),
        (0.45, 0.45),
        (0.45, 1.35),
        (-0.45, 1.35),
        (-0.45, 0.45),
        (-1.35, 0.45),
        (-1.35, -0.45),
        (-0.45, -0.45),
    ],
    &[(-1.2, -1.2), (1.2, -1.2), (-1.2, 1.2), (1.2, 1.2)],
];

/// How a ball of a colour is lit: where, and how far towards white or black.
pub(crate) fn shading(colour: Rgb) -> String {
    const WHITE: Rgb = [255; 3];
    const BLACK: Rgb = [0; 3];
    let stops = [
        (0.0, WHITE, 0.55),
        (0.2, WHITE, 0.2),
        (0.5, WHITE, 0.0),
        (0.82, BLACK, 0.2),
        (1.0, BLACK, 0.5),
    ];
    let mut text = format!(
        r#"<radialGradient id="ball-{}" cx="0.5" cy="0.5" r="0.5" fx="0.36" fy="0.3">"#,
        &css(colour)[1..]
    );
    for (at, towards, part) in stops {
        let own = css(mixed(colour, towards, part));
        let _ = write!(text, r#"<stop offset="{at}" stop-color="{own}"/>"#);
    }
    text + "</radialGradient>\n"
}
