//! Colours of values, the same in pictures and in the page.

/// Dark to light, even in lightness, so that the order is seen without hue.
///
/// # Source
/// S. van der Walt, N. Smith (2015), map "viridis" (public domain), at ninths.
const ANCHORS: [[u8; 3]; 9] = [
    [68, 1, 84],
    [71, 45, 123],
    [59, 82, 139],
    [44, 114, 142],
    [33, 144, 141],
    [39, 173, 129],
    [92, 200, 99],
    [170, 220, 50],
    [253, 231, 37],
];

/// Red, green and blue.
pub type Rgb = [u8; 3];

/// Colour of a part between 0 and 1; what lies beyond gets the colour of the end.
pub fn colour_of(part: f64) -> Rgb {
    let last = ANCHORS.len() - 1;
    let at = part.clamp(0.0, 1.0) * last as f64;
    // What is no number has no colour of its own.
    let below = (at.max(0.0).floor() as usize).min(last - 1);
    let share = at - below as f64;
    mixed(ANCHORS[below], ANCHORS[below + 1], share)
}

/// The colour a part of the way from one to another.
pub fn mixed(from: Rgb, to: Rgb, part: f64) -> Rgb {
    std::array::from_fn(|k| {
        let (a, b) = (f64::from(from[k]), f64::from(to[k]));
        (a + part * (b - a)).round() as u8
    })
}

/// A colour as CSS writes it.
pub fn css([r, g, b]: Rgb) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// L* of CIELAB of an sRGB colour (IEC 61966-2-1, CIE 15).
    fn lightness(colour: [f64; 3]) -> f64 {
        let linear = colour.map(|own| match own <= 0.04045 {
            true => own / 12.92,
            false => ((own + 0.055) / 1.055).powf(2.4),
        });
        let y = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
        match y > 216.0 / 24389.0 {
            true => 116.0 * y.cbrt() - 16.0,
            false => 24389.0 / 27.0 * y,
        }
    }

    /// Lightness rises evenly, for those as well who lack the middle receptor (Machado,
    /// Oliveira, Fernandes 2009, deuteranomaly of severity 1).
    #[test]
    fn closed_form_lightness_rises_evenly() {
        let deuteranope = [
            [0.367322, 0.860646, -0.227968],
            [0.280085, 0.672501, 0.047413],
            [-0.011820, 0.042940, 0.968881],
        ];
        for seen in [None, Some(deuteranope)] {
            let steps: Vec<f64> = (0..=16)
                .map(|k| {
                    let own = colour_of(f64::from(k) / 16.0).map(|c| f64::from(c) / 255.0);
                    let own = seen.map_or(own, |matrix| {
                        matrix.map(|row| {
                            let sum: f64 = row.iter().zip(own).map(|(a, b)| a * b).sum();
                            sum.clamp(0.0, 1.0)
                        })
                    });
                    lightness(own)
                })
                .collect();
            let mean = (steps[16] - steps[0]) / 16.0;
            assert!(mean > 4.0, "{steps:?}");
            for pair in steps.windows(2) {
                let step = pair[1] - pair[0];
                assert!(step > 0.4 * mean && step < 1.7 * mean, "{steps:?}");
            }
        }
        assert_eq!(css(colour_of(f64::NAN)).len(), 7);
        assert_eq!(colour_of(-1.0), ANCHORS[0]);
        assert_eq!(colour_of(2.0), ANCHORS[8]);
    }
}
