//! A small panel with its scales, before it is known how large it is drawn.

use crate::axis::{Axis, axis};
use crate::frame::Frame;
use crate::panel::Panel;
use crate::panel_drawing::shown_ranges;
use std::collections::BTreeSet;

/// Width of a character of the names and notes; px.
pub(crate) const CHARACTER: f64 = 5.7;

/// Longest name at an axis; characters.
pub(crate) const LONGEST_NAME: usize = 22;

/// What stands along an axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Scale {
    /// Round numbers over the range of the data.
    #[default]
    Data,
    /// Round numbers from one end to the other, at least as far as the data.
    Reaching(f64, f64),
    /// Round numbers from exactly one end to the other: what lies beyond is not drawn.
    Between(f64, f64),
    /// Names at 0, 1, 2 …
    Names(Vec<String>),
}

/// A small panel.
#[derive(Clone, Debug, PartialEq)]
pub struct GridPanel {
    /// What stands above it.
    pub title: String,
    /// Its series and named places.
    pub panel: Panel,
    /// Horizontal axis.
    pub across: Scale,
    /// Vertical axis.
    pub up: Scale,
    /// Texts about places, in the units of the axes.
    pub texts: Vec<((f64, f64), String)>,
    /// Why it is empty, where it is.
    pub empty: String,
}

impl GridPanel {
    /// A panel with axes of numbers over its data.
    pub fn new(title: impl Into<String>, panel: Panel) -> Self {
        Self {
            title: title.into(),
            panel,
            across: Scale::Data,
            up: Scale::Data,
            texts: Vec::new(),
            empty: String::new(),
        }
    }

    /// The panel with the same range and scale on both axes.
    #[must_use]
    pub fn with_equal_axes(self) -> Self {
        Self {
            panel: self.panel.with_equal_axes(),
            ..self
        }
    }

    /// What it shows of each axis: the same of both where they are equal.
    pub(crate) fn ranges(&self) -> ((f64, f64), (f64, f64)) {
        shown_ranges(&self.panel)
    }

    /// Whether no series has a point that can be drawn.
    pub(crate) fn is_empty(&self) -> bool {
        let points = self.panel.series.iter().flat_map(|own| &own.points);
        let mut finite = points.filter(|(x, y)| x.is_finite() && y.is_finite());
        finite.next().is_none()
    }
}

/// The panel without what lies beyond its frame.
pub(crate) fn inside(panel: &Panel, frame: &Frame) -> Panel {
    let holds = |axis: &Axis, value: f64| {
        let room = 1e-9 * (axis.high - axis.low);
        value >= axis.low - room && value <= axis.high + room
    };
    let within = |(x, y): &(f64, f64)| holds(&frame.across, *x) && holds(&frame.up, *y);
    let mut panel = panel.clone();
    for series in &mut panel.series {
        if !series.style.has_ends() {
            series.points.retain(within);
        }
    }
    panel.marks.retain(|mark| within(&mark.at));
    panel
}

pub(crate) fn axis_of(scale: &Scale, (low, high): (f64, f64), ticks: usize, room: f64) -> Axis {
    match scale {
        Scale::Names(names) => Axis {
            low: -0.6,
            high: names.len().max(1) as f64 - 0.4,
            ticks: (0..names.len()).map(|place| place as f64).collect(),
            labels: fitting(names, CHARACTER * LONGEST_NAME as f64),
            power: 0,
        },
        Scale::Between(low, high) => axis(*low, *high, ticks),
        Scale::Reaching(from, to) => {
            let (low, high) = (low.min(*from), high.max(*to));
            let room = room * (high - low);
            // An end that was asked for, such as zero, is the end.
            let low = if low < *from { low - room } else { low };
            let high = if high > *to { high + room } else { high };
            axis(low, high, ticks)
        }
        Scale::Data => {
            let room = room * (high - low);
            axis(low - room, high + room, ticks)
        }
    }
}

/// Names cut so that each fits into a width; px.
pub(crate) fn fitting(names: &[String], width: f64) -> Vec<String> {
    let most = ((width / CHARACTER) as usize).clamp(2, LONGEST_NAME);
    cut_apart(names, most)
}

/// Names of at most so many characters. What all of them begin or end with is left out where they
/// could not be told apart otherwise.
pub(crate) fn cut_apart(names: &[String], most: usize) -> Vec<String> {
    let all_cut = |names: &[String]| names.iter().map(|own| cut(own, most)).collect::<Vec<_>>();
    let different = |names: &[String]| names.iter().collect::<BTreeSet<_>>().len();
    let own = all_cut(names);
    if different(&own) == different(names) {
        return own;
    }
    let all: Vec<Vec<char>> = names.iter().map(|name| name.chars().collect()).collect();
    let shortest = all.iter().map(Vec::len).min().unwrap_or(0);
    let first = &all[0];
    // Words stay whole.
    let same = |at: &dyn Fn(&[char], usize) -> char, most: usize| {
        let alike = |place: &usize| all.iter().all(|own| at(own, *place) == at(first, *place));
        let alike = (0..most).take_while(alike).count();
        let between = |place: &usize| !at(first, place - 1).is_alphanumeric();
        (1..=alike).rev().find(between).unwrap_or(0)
    };
    let front = same(&|own, place| own[place], shortest);
    let back = same(&|own, place| own[own.len() - 1 - place], shortest - front);
    let inner = all.iter().map(|own| {
        let mark = |any: usize| if any > 0 { "…" } else { "" };
        let inner: String = own[front..own.len() - back].iter().collect();
        format!("{}{inner}{}", mark(front), mark(back))
    });
    all_cut(&inner.collect::<Vec<_>>())
}

/// A text of at most so many characters.
pub(crate) fn cut(text: &str, most: usize) -> String {
    match text.chars().count() > most {
        true => text.chars().take(most.max(1) - 1).chain(['…']).collect(),
        false => text.to_owned(),
    }
}
