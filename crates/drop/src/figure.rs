//! A drop as a figure: its bounces, the force they are found in, the ringing of
//! the plate after the first.

use crate::read::Drop;
use windfall_draw::xy::{Figure, Mark, Panel, Series, Side, Style};
use windfall_files::text::number::{plain, with_digits};
use windfall_signal::bounce::train::{Bounce, BounceTrain};
use windfall_signal::ringing::model::{Ringing, amplitude_at, ringing_at};

/// Multiple of the threshold at which the contact force is cut off; 1.
const CUT: f64 = 12.0;

/// Shown before the first touch, as a part of the contact; 1.
const BEFORE: f64 = 0.5;

/// Shown after a contact, in periods of the ringing, or in contacts without ringing; 1.
const PERIODS: f64 = 9.0;
const CONTACTS: f64 = 3.0;

/// Points of a fitted curve in a period.
const POINTS: f64 = 40.0;

/// A drop with its bounces.
pub fn figure_of_drop(id: &str, drop: &Drop, train: &BounceTrain) -> Figure {
    let bounces = match train.bounces.len() {
        1 => "1 bounce".to_owned(),
        n => format!("{n} bounces"),
    };
    let mut panels = vec![overview(train), detection(train)];
    panels.extend(train.bounces.first().map(|bounce| first(train, bounce)));
    Figure {
        title: format!(
            "{id}: {} g from {} mm, {bounces}",
            plain(1e3 * drop.mass.value),
            plain(1e3 * drop.height.value)
        ),
        panels,
    }
}

/// Begin and end of each contact on the horizontal axis; ms.
fn contacts(train: &BounceTrain, zero: f64) -> Vec<(f64, f64)> {
    let ends = |bounce: &Bounce| [bounce.onset.value, bounce.end.value];
    let ends = train.bounces.iter().flat_map(ends);
    ends.map(|time| (1e3 * (time - zero), 0.0)).collect()
}

fn onsets(train: &BounceTrain) -> Vec<(f64, f64)> {
    let onsets = train.bounces.iter().map(|bounce| bounce.onset.value);
    onsets.map(|time| (1e3 * time, 0.0)).collect()
}

/// Points of some samples; ms and N.
fn points(
    train: &BounceTrain,
    values: &[f64],
    zero: f64,
    (from, to): (f64, f64),
) -> Vec<(f64, f64)> {
    let pairs = train.times.iter().zip(values);
    pairs
        .filter(|(time, _)| (from..=to).contains(*time))
        .map(|(time, value)| (1e3 * (time - zero), *value))
        .collect()
}

const ALL: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

fn overview(train: &BounceTrain) -> Panel {
    let force = points(train, &train.force, 0.0, ALL);
    let all = vec![
        Series::new("support force from its static level", Style::Line, force),
        Series::new("contact", Style::Shade, contacts(train, 0.0)),
    ];
    let mark = |(number, bounce): (usize, &Bounce)| Mark {
        label: format!("{}: {} N", number + 1, plain(bounce.peak)),
        at: (1e3 * bounce.peak_time, bounce.peak),
        side: Side::BelowRight,
    };
    Panel {
        marks: train.bounces.iter().enumerate().map(mark).collect(),
        ..Panel::new(("time", "ms"), ("force", "N"), all)
    }
}

fn detection(train: &BounceTrain) -> Panel {
    let (on, off) = train.thresholds;
    let cut = CUT * on;
    let force = train
        .contact_force
        .iter()
        .map(|force| force.clamp(-cut, cut));
    let force = points(train, &force.collect::<Vec<f64>>(), 0.0, ALL);
    let smoothed = format!(
        "contact force, smoothed over {} ms",
        plain(1e3 * train.smoothing)
    );
    let limits = format!(
        "a contact begins above {} N, is over below {} N",
        with_digits(on, 2),
        with_digits(off, 2)
    );
    let at = train.times.first().map_or(0.0, |time| 1e3 * time);
    let all = vec![
        Series::new(smoothed, Style::Line, force),
        Series::new("onset", Style::Upright, onsets(train)),
        Series::new(limits, Style::Level, vec![(at, on), (at, off)]),
    ];
    let force = format!("force, cut at ±{}", plain(cut));
    Panel::new(("time", "ms"), (&force, "N"), all)
}

fn first(train: &BounceTrain, bounce: &Bounce) -> Panel {
    let zero = bounce.onset.value;
    let contact = bounce.end.value - zero;
    let shown = bounce
        .ringing
        .map_or(CONTACTS * contact, |ringing| PERIODS * ringing.period.value);
    let next = train.bounces.get(1);
    let next = next.map_or(f64::INFINITY, |next| next.onset.value);
    let to = (bounce.end.value + shown).min(next);
    let points = |values| points(train, values, zero, (zero - BEFORE * contact, to));
    let (support, behind) = (points(&train.force), points(&train.contact_force));
    let contact = contacts(train, zero)[..2].to_vec();
    let mut all = vec![
        Series::new("support force", Style::Dots, support),
        Series::new("contact", Style::Shade, contact),
        Series::new("contact force behind it, smoothed", Style::Line, behind),
    ];
    if let Some(ringing) = &bounce.ringing {
        all.extend(ringing_series(ringing, zero, to));
    }
    Panel::new(("time from the first touch", "ms"), ("force", "N"), all)
}

fn ringing_series(ringing: &Ringing, zero: f64, to: f64) -> Vec<Series> {
    let step = ringing.period.value / POINTS;
    let count = ((to - ringing.from) / step).max(0.0) as usize;
    let times: Vec<f64> = (0..=count)
        .map(|i| ringing.from + step * i as f64)
        .collect();
    let curve = |value: &dyn Fn(f64) -> f64| -> Vec<(f64, f64)> {
        times
            .iter()
            .map(|t| (1e3 * (t - zero), value(*t)))
            .collect()
    };
    // Out along the upper envelope and back along the lower: one series.
    let mut envelope = curve(&|time| amplitude_at(ringing, time));
    let lower = curve(&|time| -amplitude_at(ringing, time));
    envelope.extend(lower.into_iter().rev());
    let label = format!(
        "ringing: period {} ms, damping ratio {}",
        plain(1e3 * ringing.period.value),
        plain(ringing.damping_ratio.value)
    );
    let line = curve(&|time| ringing_at(ringing, time));
    vec![
        Series::new(label, Style::Line, line),
        Series::new("its envelope", Style::Dashed, envelope),
    ]
}
