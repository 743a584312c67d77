//! The frame of a panel: axes with ticks, grid and titles around a rectangle.

use crate::axis::{Axis, unit_label};
use crate::svg::{Anchor, Drawing, Ink};
use crate::text_width::{lines_of, text_width};

/// Sizes of the letters at ticks and of titles; px.
const TICK: f64 = 10.5;
const TITLE: f64 = 11.5;

/// Least distance of labels at ticks; px.
const APART: f64 = 2.0;

/// Distance of the lines of a title, and how far it may reach beyond its axis; px.
const LINE: f64 = 13.0;
const BEYOND: f64 = 40.0;

/// A rectangle of a drawing; px, y downwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// Left end.
    pub left: f64,
    /// Upper end.
    pub top: f64,
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
}

impl Rectangle {
    /// Right end.
    pub fn right(&self) -> f64 {
        self.left + self.width
    }

    /// Lower end.
    pub fn bottom(&self) -> f64 {
        self.top + self.height
    }

    /// Whether a place lies within, and this far from every side.
    pub fn holds(&self, (x, y): (f64, f64), room: f64) -> bool {
        x >= self.left + room
            && x <= self.right() - room
            && y >= self.top + room
            && y <= self.bottom() - room
    }
}

/// A panel with its axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Where it stands.
    pub within: Rectangle,
    /// Horizontal axis.
    pub across: Axis,
    /// Vertical axis.
    pub up: Axis,
}

impl Frame {
    /// Position of a data point in the drawing.
    pub fn place(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let (across, up, within) = (&self.across, &self.up, &self.within);
        (
            within.left + within.width * (x - across.low) / (across.high - across.low),
            within.top + within.height * (up.high - y) / (up.high - up.low),
        )
    }

    /// Lines behind the data at the ticks.
    pub fn draw_grid(&self, drawing: &mut Drawing) {
        let within = &self.within;
        for tick in &self.across.ticks {
            let (x, _) = self.place((*tick, self.up.low));
            drawing.rule((x, within.top), (x, within.bottom()), Ink::Grid);
        }
        for tick in &self.up.ticks {
            let (_, y) = self.place((self.across.low, *tick));
            drawing.rule((within.left, y), (within.right(), y), Ink::Grid);
        }
    }

    /// Axes with ticks, their labels and titles.
    ///
    /// * `x`, `y`: name and unit
    /// * `aside`: distance of the vertical title from the axis; px
    pub fn draw_axes(
        &self,
        drawing: &mut Drawing,
        (x, x_unit): (&str, &str),
        (y, y_unit): (&str, &str),
        aside: f64,
    ) {
        let within = &self.within;
        let (left, bottom) = (within.left, within.bottom());
        self.draw_ticks(drawing);
        let title = format!("{x}{}", unit_label(x_unit, self.across.power));
        let middle = left + 0.5 * within.width;
        let size = drawing.letters(TITLE);
        for (line, text) in lines_of(&title, size, within.width + BEYOND)
            .iter()
            .enumerate()
        {
            let at = (middle, bottom + 36.0 + LINE * line as f64);
            drawing.text(at, Anchor::Middle, TITLE, text);
        }
        let title = format!("{y}{}", unit_label(y_unit, self.up.power));
        let middle = within.top + 0.5 * within.height;
        let lines = lines_of(&title, size, within.height + BEYOND);
        for (line, text) in lines.iter().rev().enumerate() {
            let at = (left - aside - LINE * line as f64, middle);
            drawing.turned_text(at, TITLE, text);
        }
    }

    /// Axes with ticks and their labels.
    pub fn draw_ticks(&self, drawing: &mut Drawing) {
        let within = &self.within;
        let (left, bottom) = (within.left, within.bottom());
        // A label that the one before it leaves no room for is left out.
        let mut taken = f64::NEG_INFINITY;
        for (tick, label) in self.across.ticks.iter().zip(&self.across.labels) {
            let (x, _) = self.place((*tick, self.up.low));
            drawing.rule((x, bottom), (x, bottom + 4.0), Ink::Frame);
            let half = 0.5 * text_width(label, drawing.letters(TICK));
            if x - half > taken {
                drawing.text((x, bottom + 16.0), Anchor::Middle, TICK, label);
                taken = x + half + APART;
            }
        }
        for (tick, label) in self.up.ticks.iter().zip(&self.up.labels) {
            let (_, y) = self.place((self.across.low, *tick));
            drawing.rule((left - 4.0, y), (left, y), Ink::Frame);
            drawing.text((left - 7.0, y + 3.6), Anchor::End, TICK, label);
        }
        drawing.rule((left, within.top), (left, bottom), Ink::Frame);
        drawing.rule((left, bottom), (within.right(), bottom), Ink::Frame);
    }
}
