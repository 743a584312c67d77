//! Logarithmic decrement: damping ratio and damped period from the peaks of a
//! free ringing, as it is done by hand.

use crate::polynomial::fit_polynomial;
use crate::uncertain::Uncertain;
use std::f64::consts::PI;

/// A positive peak of the ringing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RingingPeak {
    /// Time; s.
    pub time: Uncertain,
    /// Height above the static level; N.
    pub height: Uncertain,
}

/// What two peaks, some cycles apart, tell.
#[derive(Clone, Debug, PartialEq)]
pub struct Decrement {
    /// All positive peaks above noise, in their order.
    pub peaks: Vec<RingingPeak>,
    /// Cycles between the two peaks used: the first, and the one that many later.
    pub cycles: usize,
    /// Logarithmic decrement per cycle, δ; 1.
    pub decrement: Uncertain,
    /// Damping ratio, ζ; 1.
    pub damping_ratio: Uncertain,
    /// Damped period; s.
    pub period: Uncertain,
}

/// Peaks below this many standard deviations of the noise are not used; 1.
const LEAST_HEIGHT: f64 = 5.0;
/// The parabola of a peak spans this part of the period to either side; 1.
const PEAK_REACH: f64 = 0.11;

/// A stretch of free ringing, and what it is measured from.
#[derive(Clone, Copy, Debug)]
pub struct FreeRinging<'a> {
    /// Times; s.
    pub times: &'a [f64],
    /// Force from the static level; N.
    pub force: &'a [f64],
    /// Standard deviation of a sample; N.
    pub noise: f64,
    /// Standard uncertainty of the static level; N.
    pub level_sd: f64,
    /// Period, about; s.
    pub period: f64,
}

/// Logarithmic decrement over n cycles,
///
/// ```text
/// δ = ln(A₁/A₍₁₊ₙ₎)/n,   ζ = δ/√(4π² + δ²)
/// ```
///
/// with A₁ the first positive peak of the stretch, which must lie behind the
/// separation: an earlier one is shaped by the contact.
///
/// * `cycles`: n; `None` takes the n of the smallest uncertainty, which noise
///   puts where the amplitude has fallen to about a third
///
/// `None` if there are not enough peaks above noise.
///
/// # Source
/// Kang et al. (2023), INMATEH 71:763, eqs. 2 and 3. Differences: their eq. 2
/// has the ratio the other way round; n cycles in place of one.
pub fn logarithmic_decrement(ringing: &FreeRinging, cycles: Option<usize>) -> Option<Decrement> {
    let peaks = peaks(ringing);
    let first = *peaks.first()?;
    let by = |n: usize| {
        let last = peaks[n];
        let count = n as f64;
        let (a, b) = (first.height, last.height);
        let noise = (a.sd / a.value).hypot(b.sd / b.value);
        // A wrong level moves both peaks by the same amount.
        let level = ringing.level_sd * (1.0 / b.value - 1.0 / a.value);
        Uncertain::new((a.value / b.value).ln() / count, noise.hypot(level) / count)
    };
    let cycles = match cycles {
        Some(n) => Some(n).filter(|n| *n > 0 && *n < peaks.len()),
        None => (1..peaks.len()).min_by(|a, b| by(*a).sd.total_cmp(&by(*b).sd)),
    }?;
    let decrement = by(cycles);
    let (start, end) = (first.time, peaks[cycles].time);
    let period = Uncertain::new(
        (end.value - start.value) / cycles as f64,
        start.sd.hypot(end.sd) / cycles as f64,
    );
    Some(Decrement {
        damping_ratio: damping_from_decrement(decrement),
        peaks,
        cycles,
        decrement,
        period,
    })
}

/// Damping ratio of a logarithmic decrement, ζ = δ/√(4π² + δ²).
pub fn damping_from_decrement(decrement: Uncertain) -> Uncertain {
    let square = 4.0 * PI * PI + decrement.value * decrement.value;
    Uncertain::new(
        decrement.value / square.sqrt(),
        decrement.sd * 4.0 * PI * PI / square.powf(1.5),
    )
}

/// Positive peaks, one a period, as long as they stand out of the noise.
fn peaks(ringing: &FreeRinging) -> Vec<RingingPeak> {
    let (times, force) = (ringing.times, ringing.force);
    let mut found: Vec<RingingPeak> = Vec::new();
    let mut from = 0;
    while from < times.len() {
        // Within the next period lies one positive peak.
        let until = times.partition_point(|t| *t < times[from] + ringing.period);
        let Some(top) = (from..until).max_by(|a, b| force[*a].total_cmp(&force[*b])) else {
            break;
        };
        // At the edge it is the flank of a peak outside.
        let inside = top > 0 && top + 1 < times.len();
        if inside && let Some(peak) = refined(ringing, top) {
            if peak.height.value < LEAST_HEIGHT * ringing.noise {
                break;
            }
            found.push(peak);
        }
        let next = times.partition_point(|t| *t < times[top] + 0.5 * ringing.period);
        from = next.max(from + 1);
        if until == times.len() {
            break;
        }
    }
    found
}

fn refined(ringing: &FreeRinging, top: usize) -> Option<RingingPeak> {
    let reach = PEAK_REACH * ringing.period;
    let centre = ringing.times[top];
    let first = ringing.times.partition_point(|t| *t < centre - reach);
    let last = ringing.times.partition_point(|t| *t <= centre + reach);
    // A peak of few samples needs its neighbours.
    let first = first.min(top.saturating_sub(1));
    let last = last.max((top + 2).min(ringing.times.len()));
    let (times, force) = (&ringing.times[first..last], &ringing.force[first..last]);
    let fit = fit_polynomial(times, force, centre, 2)?;
    let d = &fit.derivatives;
    let shift = -d[1] / d[2];
    if d[2] >= 0.0 || shift.abs() > reach {
        return None;
    }
    Some(RingingPeak {
        time: Uncertain::new(
            centre + shift,
            ringing.noise * fit.noise_gains[1] / d[2].abs(),
        ),
        height: Uncertain::new(
            d[0] - 0.5 * d[1] * d[1] / d[2],
            ringing.noise * fit.noise_gains[0],
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn closed_form_decrement_of_a_damped_cosine() {
        // ζ = 0.073 by its definition: δ = 2π ζ/√(1−ζ²).
        let (zeta, period) = (0.073_f64, 3.5e-3);
        let delta = TAU * zeta / (1.0 - zeta * zeta).sqrt();
        let times: Vec<f64> = (0..400).map(|i| f64::from(i) * 5e-5).collect();
        let force: Vec<f64> = times
            .iter()
            .map(|t| 8.0 * (-delta * t / period).exp() * (TAU * t / period - 1.0).cos())
            .collect();
        let ringing = FreeRinging {
            times: &times,
            force: &force,
            noise: 1e-3,
            level_sd: 0.0,
            period,
        };
        for cycles in [1, 2, 4] {
            let found = logarithmic_decrement(&ringing, Some(cycles)).unwrap();
            assert!(
                (found.decrement.value / delta - 1.0).abs() < 2e-3,
                "{found:?}"
            );
            assert!((found.damping_ratio.value / zeta - 1.0).abs() < 2e-3);
            assert!(
                (found.period.value / period - 1.0).abs() < 1e-4,
                "{found:?}"
            );
        }
        let best = logarithmic_decrement(&ringing, None).unwrap();
        // The least uncertainty with σ²(1 + e^{2nδ})/n² is at n = 2.4 for this δ.
        assert!((2..=3).contains(&best.cycles), "{best:?}");
        assert_eq!(logarithmic_decrement(&ringing, Some(50)), None);
    }

    #[test]
    fn reference_one_cycle_of_the_study() {
        // ζ = 0.073 needs A₂/A₃ = exp(2π 0.073/√(1 − 0.073²)) = 1.583915.
        let decrement = Uncertain::new(1.583_914_899_f64.ln(), 0.0);
        assert!((damping_from_decrement(decrement).value - 0.073).abs() < 1e-9);
    }
}
