//! Excursions of the force above a threshold, as contacts.

/// Excursions with a smaller peak, relative to the largest, are ringing; 1.
pub(crate) const RINGING_PEAK: f64 = 0.05;

/// Excursions that are shorter, relative to the longest, are ringing; 1.
const RINGING_DURATION: f64 = 0.1;

/// Default of the minimum gap as a part of the longest contact; 1.
const DEFAULT_GAP: f64 = 0.1;

/// Fewest successive smoothed samples of a contact.
pub(crate) const LEAST_SAMPLES: usize = 3;

/// One contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactWindow {
    /// First upward crossing of the threshold; s.
    pub onset: f64,
    /// Last downward crossing of the threshold; s.
    pub end: f64,
    /// Largest smoothed force; N.
    pub peak: f64,
    /// Lowest smoothed force between its end and the next contact; after the last, for as long
    /// as it lasted; N.
    pub low_after: f64,
    /// False if the recording begins in this contact.
    pub onset_seen: bool,
    /// False if the recording ends in this contact.
    pub end_seen: bool,
}

/// Windows above the threshold, without ringing, joined over small gaps.
///
/// * `release`: a contact is over below this; `minimum_gap`: s, by default a tenth
///   of the longest contact
pub(crate) fn windows(
    times: &[f64],
    smooth: &[f64],
    threshold: f64,
    release: f64,
    minimum_gap: Option<f64>,
) -> Vec<ContactWindow> {
    let mut found = spans(smooth, threshold, release)
        .into_iter()
        .filter(|span| span.1 - span.0 + 1 >= LEAST_SAMPLES)
        .map(|(first, last)| window(times, smooth, threshold, first, last))
        .collect::<Vec<_>>();

    let peak = found.iter().map(|w| w.peak).fold(0.0, f64::max);
    let longest = found.iter().map(|w| w.end - w.onset).fold(0.0, f64::max);
    found
        .retain(|w| w.peak >= RINGING_PEAK * peak && w.end - w.onset >= RINGING_DURATION * longest);

    let gap = minimum_gap.unwrap_or(DEFAULT_GAP * longest);
    let mut joined: Vec<ContactWindow> = Vec::with_capacity(found.len());
    for next in found {
        match joined.last_mut() {
            Some(last) if next.onset - last.end < gap => {
                last.end = next.end;
                last.end_seen = next.end_seen;
                last.peak = last.peak.max(next.peak);
            }
            _ => joined.push(next),
        }
    }
    for i in 0..joined.len() {
        let own = joined[i];
        let next = joined.get(i + 1).map(|w| w.onset);
        let until = next.unwrap_or(2.0 * own.end - own.onset);
        let first = times.partition_point(|&t| t < own.end);
        let last = times.partition_point(|&t| t < until).max(first);
        joined[i].low_after = smooth[first..last].iter().copied().fold(0.0, f64::min);
    }
    joined
}

/// First and last sample at or above the threshold of each excursion above `release`.
fn spans(smooth: &[f64], threshold: f64, release: f64) -> Vec<(usize, usize)> {
    let mut spans = Vec::new();
    let mut open: Option<(usize, usize)> = None;
    for (i, &value) in smooth.iter().enumerate() {
        if value >= threshold {
            open = Some(open.map_or((i, i), |(first, _)| (first, i)));
        } else if value < release {
            spans.extend(open.take());
        }
    }
    spans.extend(open);
    spans
}

fn window(
    times: &[f64],
    smooth: &[f64],
    threshold: f64,
    first: usize,
    last: usize,
) -> ContactWindow {
    let crossing = |outside: usize, inside: usize| {
        let part = (threshold - smooth[outside]) / (smooth[inside] - smooth[outside]);
        times[outside] + part * (times[inside] - times[outside])
    };
    let end_seen = last + 1 < smooth.len();
    ContactWindow {
        onset: if first > 0 {
            crossing(first - 1, first)
        } else {
            times[first]
        },
        end: if end_seen {
            crossing(last + 1, last)
        } else {
            times[last]
        },
        peak: smooth[first..=last]
            .iter()
            .copied()
            .fold(f64::NEG_INFINITY, f64::max),
        low_after: 0.0,
        onset_seen: first > 0,
        end_seen,
    }
}
