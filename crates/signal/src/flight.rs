//! How much of the free motion next to a contact is free.

use crate::finding::Finding;
use crate::impact::Measured;
use crate::linear_fit::{linear_fit, sum};
use crate::measure::{Side, Surroundings};
use crate::options::ExtractOptions;
use crate::track::{Signals, Track};

/// Lengths that are tried, from the longest, as parts of the contact's duration; 1.
const LENGTHS: [f64; 3] = [2.0, 1.0, 0.5];
/// Kept away from onset and end, where the threshold was crossed late or early: a force below
/// it still acts there; likewise.
const GUARD: f64 = 0.2;
/// Fewest samples that tell whether a motion is free.
const LEAST_SAMPLES: usize = 30;
/// Terms of third and fourth order are none of a free motion; told at this many deviations…
const SIGNIFICANT: f64 = 5.0;
/// … and from this part of the noise of a sample on; 1.
const VISIBLE: f64 = 0.5;
/// The mean force of a stretch is none above this part of the peak; 1.
const SILENT: f64 = 0.02;
/// Stretches in which the force is looked at, as a part of the contact's duration; 1.
const STRETCH: f64 = 0.1;

/// Free motion kept before and after the contact; s. The less of what displacement and
/// measured rate show.
pub(crate) fn margins(
    signals: &Signals,
    measured: &Measured,
    place: &Surroundings,
    options: &ExtractOptions,
    findings: &mut Vec<Finding>,
) -> [f64; 2] {
    let peak = measured.peak_force.unwrap_or(f64::INFINITY);
    [
        (Side::Before, options.margin_before),
        (Side::After, options.margin_after),
    ]
    .map(|(side, margin)| {
        let least = margin * place.duration();
        if options.free_flight <= margin {
            return least;
        }
        let motions = [&signals.displacement, &signals.rate].into_iter().flatten();
        let flights = motions.map(|motion| {
            let force = signals.force.as_ref();
            free_flight(
                motion,
                force,
                peak,
                place,
                side,
                (margin, options.free_flight),
            )
        });
        let shortest = flights.min_by(|a, b| a.0.total_cmp(&b.0));
        shortest.map_or(least, |(length, finding)| {
            findings.extend(finding);
            length.max(least)
        })
    })
}

/// Free motion that may be used on one side of a contact, in s, and why it is not more.
///
/// Free motion is smooth over a few contact durations: a parabola describes it, an arm that
/// rings does not. Nothing presses on the impactor meanwhile.
///
/// * `motion`: displacement or rate
/// * `least`, `wanted`: contact durations that are kept in any case, and asked for
fn free_flight(
    motion: &Track,
    force: Option<&Track>,
    peak: f64,
    place: &Surroundings,
    side: Side,
    (least, wanted): (f64, f64),
) -> (f64, Option<Finding>) {
    let duration = place.duration();
    let lengths = LENGTHS.iter().copied();
    let lengths = lengths.filter(|length| (least..wanted).contains(length));
    let held_back = |used: f64, why| Finding::FlightHeldBack {
        channel: motion.name.clone(),
        after: side == Side::After,
        used,
        wanted,
        why,
    };
    let mut held: Option<&'static str> = None;
    for length in [wanted].into_iter().chain(lengths) {
        let span = stretch(place, side, length * duration);
        let why = if force.is_some_and(|force| presses(force, peak, span, duration)) {
            "the force is not zero there"
        } else if rings(motion, span) {
            "the motion is not free there, as where an arm rings"
        } else {
            return (length * duration, held.map(|why| held_back(length, why)));
        };
        held = held.or(Some(why));
    }
    (0.0, held.map(|why| held_back(least, why)))
}

/// Begin and end of a stretch next to the contact; s.
fn stretch(place: &Surroundings, side: Side, length: f64) -> (f64, f64) {
    let guard = GUARD * place.duration();
    match side {
        Side::Before => ((place.onset - length).max(place.from), place.onset - guard),
        Side::After => (place.end + guard, (place.end + length).min(place.until)),
    }
}

fn within(track: &Track, (from, until): (f64, f64)) -> std::ops::Range<usize> {
    let first = track.times.partition_point(|&t| t < from);
    first..track.times.partition_point(|&t| t <= until).max(first)
}

/// Whether a mean of the force over a part of the stretch is not zero.
fn presses(force: &Track, peak: f64, span: (f64, f64), duration: f64) -> bool {
    let values = &force.values[within(force, span)];
    let parts = ((span.1 - span.0) / (STRETCH * duration)).ceil().max(1.0);
    let length = (values.len() as f64 / parts) as usize;
    length > 0
        && values.chunks_exact(length).any(|part| {
            let mean = part.iter().sum::<f64>() / length as f64;
            let chance = force.noise / (length as f64).sqrt();
            mean.abs() > (SILENT * peak).max(SIGNIFICANT * chance)
        })
}

/// Whether a motion has more than place, velocity and acceleration.
fn rings(motion: &Track, span: (f64, f64)) -> bool {
    let part = within(motion, span);
    if part.len() < LEAST_SAMPLES {
        return false;
    }
    let (middle, half) = (0.5 * (span.0 + span.1), 0.5 * (span.1 - span.0));
    // Legendre polynomials, which hardly depend on each other.
    let row = |time: f64| {
        let u = (time - middle) / half;
        let square = u * u;
        [
            1.0,
            u,
            1.5 * square - 0.5,
            u * (2.5 * square - 1.5),
            (35.0 * square * square - 30.0 * square + 3.0) / 8.0,
        ]
    };
    let (times, values) = (&motion.times[part.clone()], &motion.values[part]);
    let Some(fit) = linear_fit(times, values, row) else {
        return false;
    };
    let stands_out = |i: usize| {
        let size = fit.coefficients[i].abs();
        size > (SIGNIFICANT * fit.deviations[i]).max(VISIBLE * motion.noise)
    };
    // A ringing of a short period is left in the scatter.
    let left = times
        .iter()
        .zip(values)
        .map(|(t, v)| (v - sum(&row(*t), &fit.coefficients)).powi(2));
    let scatter = (left.sum::<f64>() / times.len() as f64).sqrt();
    (3..5).any(stands_out) || (motion.quantum.is_some() && scatter > 2.0 * motion.noise)
}
