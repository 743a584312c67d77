//! Heights as colours: the bands between round levels, and the bar that explains them.

use windfall_draw::axis::{Axis, axis, unit_label};
use windfall_draw::frame::Rectangle;
use windfall_draw::svg::{Anchor, Drawing, Ink};
use windfall_draw::theme::SCALE;

/// Most levels but for one at an end: with them every band has a colour of its own.
const LEVELS: usize = 10;

/// Round levels with the colours of the bands between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Heights {
    /// Range of the values and the levels, as ticks.
    pub axis: Axis,
}

impl Heights {
    /// Levels for values from `low` to `high`.
    pub fn between(low: f64, high: f64) -> Self {
        Self {
            axis: axis(low, high, LEVELS),
        }
    }

    /// Levels for all these values; those that are no numbers are passed over.
    pub fn of<'a>(values: impl Iterator<Item = &'a f64>) -> Self {
        let finite = values.copied().filter(|value| value.is_finite());
        let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
            (low.min(v), high.max(v))
        });
        match low <= high {
            true => Self::between(low, high),
            false => Self::between(0.0, 1.0),
        }
    }

    /// Colour of the band above so many levels.
    pub fn ink(&self, levels: usize) -> Ink {
        let bands = self.axis.ticks.len();
        let step = (SCALE - 1) as f64 * levels as f64 / bands.max(1) as f64;
        Ink::Scale(step.round() as usize)
    }

    /// Colour of a value.
    pub fn ink_of(&self, value: f64) -> Ink {
        let below = self.axis.ticks.iter().filter(|level| **level <= value);
        self.ink(below.count())
    }

    /// The bar with its levels and its title, upwards along it.
    pub fn draw_bar(&self, drawing: &mut Drawing, at: Rectangle, title: &str, unit: &str) {
        let height = |value: f64| {
            let part = (value - self.axis.low) / (self.axis.high - self.axis.low);
            at.bottom() - part * at.height
        };
        let ends = [self.axis.low].into_iter().chain(self.axis.ticks.clone());
        for (band, from) in ends.enumerate() {
            let (bottom, top) = (height(from), at.top);
            let corners = [
                (at.left, bottom),
                (at.right(), bottom),
                (at.right(), top),
                (at.left, top),
            ];
            drawing.area(&[corners.to_vec()], self.ink(band));
        }
        for (level, label) in self.axis.ticks.iter().zip(&self.axis.labels) {
            let y = height(*level);
            drawing.rule((at.left, y), (at.right() + 4.0, y), Ink::Frame);
            drawing.text((at.right() + 7.0, y + 3.6), Anchor::Start, 10.5, label);
        }
        let title = format!("{title}{}", unit_label(unit, self.axis.power));
        let middle = at.top + 0.5 * at.height;
        drawing.turned_text((at.right() + 54.0, middle), 11.5, &title);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_bands_between_levels_use_the_whole_scale() {
        let heights = Heights::between(0.0, 1.0);
        assert_eq!(heights.axis.ticks.len(), SCALE - 1);
        assert_eq!(heights.ink_of(-1.0), Ink::Scale(0));
        assert_eq!(heights.ink_of(1.0), Ink::Scale(SCALE - 1));
        assert_eq!(heights.ink_of(0.55), heights.ink(6));
        assert_eq!(Heights::of([f64::NAN].iter()), heights);
    }
}
