//! Slow compression of a fruit: from force and position to the loading curve,
//! its yield and its stiffness.
//!
//! The curve is read forwards, once: what happens after the yield has no
//! influence on anything before it.

use crate::straight_line::{Slope, Window};

/// What is told from a force-deformation curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompressionOptions {
    /// Force above which the fruit is touched; N. From the noise when `None`.
    pub touch_force: Option<f64>,
    /// Stiffness of machine, load cell and pads in series with the fruit; N/m. May be infinite.
    pub machine_stiffness: f64,
    /// Length without an increase of force at a yield, as a part of the deformation; 1.
    pub yield_window: f64,
    /// Rise of the force over which the local stiffness is taken, as a part of it; 1.
    pub stiffness_window: f64,
    /// The tissue has softened below this part of the largest stiffness so far; 1.
    pub softening: f64,
    /// A fall of the force below this part of its largest so far is a rupture; 1.
    pub rupture: f64,
}

/// Where the range of a curve that is fitted ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FitRange {
    /// At the largest local stiffness, where the curve begins to bend down.
    LargestStiffness,
    /// At this part of the bioyield force, or without yield of the largest force; 1.
    PartOfYield(f64),
    /// At this deformation after the first sample of the curve; m.
    Deformation(f64),
}

impl Default for CompressionOptions {
    fn default() -> Self {
        Self {
            touch_force: None,
            machine_stiffness: f64::INFINITY,
            yield_window: 0.1,
            stiffness_window: 0.3,
            softening: 0.5,
            rupture: 0.7,
        }
    }
}

/// A sample of a force-deformation curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// Position in the arrays of the curve.
    pub index: usize,
    /// Time in the recording; s.
    pub time: f64,
    /// Deformation since the first sample of the curve; m.
    pub deformation: f64,
    /// Force; N.
    pub force: f64,
}

/// Why the loading ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoadingEnd {
    /// The force no longer increased with deformation.
    Bioyield,
    /// The force fell suddenly.
    Rupture,
    /// The deformation decreased: unloading, or a controller that oscillates.
    Reversal,
    /// The position was held, and the force fell: stress relaxation.
    Hold,
    /// The recording ended.
    RecordingEnd,
}

/// The loading curve of one fruit.
#[derive(Clone, Debug, PartialEq)]
pub struct CompressionCurve {
    /// Sampling times; s.
    pub times: Vec<f64>,
    /// Deformation of the fruit since the first sample; m.
    pub deformation: Vec<f64>,
    /// Force; N.
    pub force: Vec<f64>,
    /// Whether the first touch was missed: there was force from the first sample on.
    pub began_in_contact: bool,
    /// Standard deviation of a force sample's noise; N.
    pub force_noise: f64,
    /// Last sample of the loading.
    pub loading_end: CurvePoint,
    /// Why it is the last.
    pub ended_by: LoadingEnd,
    /// The bioyield point: the first without an increase of force (ASAE S368).
    pub bioyield: Option<CurvePoint>,
    /// Where the local stiffness fell to a part of the largest before.
    pub softening: Option<CurvePoint>,
    /// The largest force before the force fell suddenly.
    pub rupture: Option<CurvePoint>,
    /// Largest local stiffness of the loading; N/m.
    pub stiffness: Slope,
    /// Last sample of the window with the largest stiffness.
    pub stiffness_end: usize,
    /// Work from the first sample to the end of the loading, by the trapezoidal rule; J.
    pub energy: f64,
}

/// What a curve cannot be made of.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs, reason = "each message names its fields")]
pub enum CompressionError {
    #[error("{samples} samples of force and position; at least {least} are needed")]
    TooFewSamples { samples: usize, least: usize },
    #[error(
        "the largest force is {largest:.4} N and the fruit counts as touched from {threshold:.4} N; \
         if force is recorded as negative in compression, set sign = -1 in [channels.force]; or \
         lower `touch_force` in [compression]"
    )]
    NoTouch { largest: f64, threshold: f64 },
    #[error(
        "only {samples} samples lie between touch (at {time:.3} s) and the end of the loading; at \
         least {least} are needed. Check the channels, or the time range in impacts.csv"
    )]
    NoLoading {
        samples: usize,
        time: f64,
        least: usize,
    },
    #[error("the position does not change while the force rises; check its column")]
    NoMotion,
    #[error(
        "the position is held from the first sample on while the force falls from {first:.4} N to \
         {last:.4} N: this is stress relaxation, not a loading; set kind = \"relaxation\" in [rig] \
         (`windfall new relaxation DIR` writes a template)"
    )]
    Held { first: f64, last: f64 },
}

/// Fewest samples of a recording, and of its loading.
pub const LEAST_SAMPLES: usize = 16;

/// Samples over which a position that is held is judged.
pub const SHORTEST_RUN: usize = 16;

/// Samples of the shortest window for a local stiffness.
const SHORTEST_WINDOW: usize = 8;

/// Force counts as present above so many times its noise.
const TOUCH: f64 = 5.0;

/// The fitted range begins at this part of the force at its end; 1.
const CERTAIN: f64 = 0.02;

/// Least rise of the force for a local stiffness, in noise; [`PRELOADS`] comes on top.
const JUDGED: f64 = 20.0;

/// Least rise of the force at the largest stiffness for a yield to be judged, in noise.
const SEEN: f64 = 10.0;

/// Preloads by which the force must have risen.
const PRELOADS: f64 = 2.0;

/// Judgements over the length of a window.
const JUDGEMENTS: usize = 50;

/// A machine that stands has gone this part of its way, the inverse; 1.
const STOPPED: f64 = 10.0;

/// A decrease of the deformation by this part of it is a reversal; 1.
const REVERSAL: f64 = 0.005;

/// The loading curve of a recording.
///
/// * `times`, `position`, `force`: samples together; s, m, N. The force is
///   positive in compression; the position may count either way.
///
/// # Numerics
/// The local stiffness at a sample is the slope of the straight line through
/// the samples behind it, over a part of the force; whether force increases at
/// all is judged by the slope over a part of the deformation so far. Every
/// decision uses samples up to the one it is made at.
///
/// # Errors
/// See [`CompressionError`].
pub fn compression_curve(
    times: &[f64],
    position: &[f64],
    force: &[f64],
    options: &CompressionOptions,
) -> Result<CompressionCurve, CompressionError> {
    let samples = times.len().min(position.len()).min(force.len());
    if samples < LEAST_SAMPLES {
        let least = LEAST_SAMPLES;
        return Err(CompressionError::TooFewSamples { samples, least });
    }
    let (start, began_in_contact) = touch(force, options)?;
    let direction = direction(&position[start..], &force[start..])?;
    let force = &force[start..samples];
    let times = &times[start..samples];
    let zero = position[start] + direction * -force[0] / options.machine_stiffness;
    let deformation: Vec<f64> = position[start..samples]
        .iter()
        .zip(force)
        .map(|(x, f)| direction * (x - zero) - f / options.machine_stiffness)
        .collect();
    let head = force.len().min(100);
    let force_noise = second_difference_noise(&force[..head]);
    let position_noise = second_difference_noise(&deformation[..head]);

    let walk = follow(
        times,
        &deformation,
        force,
        (force_noise, position_noise),
        options,
    );
    let end = walk.end;
    if end + 1 < LEAST_SAMPLES {
        return Err(CompressionError::NoLoading {
            samples: end + 1,
            time: times[0],
            least: LEAST_SAMPLES,
        });
    }
    let point = |index: usize| CurvePoint {
        index,
        time: times[index],
        deformation: deformation[index],
        force: force[index],
    };
    let energy = (1..=end)
        .map(|i| 0.5 * (force[i] + force[i - 1]) * (deformation[i] - deformation[i - 1]))
        .sum();
    Ok(CompressionCurve {
        began_in_contact,
        force_noise,
        loading_end: point(end),
        ended_by: walk.ended_by,
        bioyield: walk.bioyield.map(point),
        softening: walk.softening.map(point),
        rupture: match walk.ended_by {
            LoadingEnd::Hold => None,
            _ => rupture(force, options.rupture).map(point),
        },
        stiffness: walk.stiffness,
        stiffness_end: walk.stiffness_end,
        energy,
        times: times.to_vec(),
        force: force.to_vec(),
        deformation,
    })
}

/// First and last sample of the range that laws are fitted to, within the loading.
pub fn fitted_range(curve: &CompressionCurve, range: FitRange) -> (usize, usize) {
    let end = curve.loading_end.index;
    let last = match range {
        FitRange::LargestStiffness => curve.stiffness_end,
        FitRange::PartOfYield(part) => first_from(&curve.force, end, part * curve.force[end]),
        FitRange::Deformation(most) => first_from(&curve.deformation, end, most),
    };
    let certain = (TOUCH * curve.force_noise).max(CERTAIN * curve.force[last]);
    (first_from(&curve.force, last, certain), last)
}

/// First sample that reaches a value, `end` at the latest.
fn first_from(values: &[f64], end: usize, value: f64) -> usize {
    let found = values[..=end].iter().position(|v| *v >= value);
    found.unwrap_or(end)
}

/// The first sample of the curve, and whether it is in contact already.
fn touch(force: &[f64], options: &CompressionOptions) -> Result<(usize, bool), CompressionError> {
    let noise = second_difference_noise(&force[..force.len().min(100)]);
    let largest = force.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let threshold = options.touch_force.unwrap_or(TOUCH * noise).max(0.0);
    let touched = |i: usize| force[i..].iter().take(5).all(|f| *f > threshold);
    let first = (0..force.len()).find(|&i| touched(i));
    match first {
        Some(0) => Ok((0, true)),
        // The sample before still belongs to the rise.
        Some(first) => Ok((first - 1, false)),
        None => Err(CompressionError::NoTouch { largest, threshold }),
    }
}

/// 1 where the position increases while the force rises, −1 where it falls.
fn direction(position: &[f64], force: &[f64]) -> Result<f64, CompressionError> {
    let largest = force.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let quarter = force[0] + 0.25 * (largest - force[0]);
    let reached = force.iter().position(|f| *f >= quarter).unwrap_or(0);
    let travel = position[reached.max(1)] - position[0];
    let (first, last) = (force[0], force[force.len() - 1]);
    let low = position.iter().copied().fold(f64::INFINITY, f64::min);
    let high = position.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let stands = high - low <= 2.0 * TOUCH * second_difference_noise(position);
    if stands && last < 0.99 * first {
        return Err(CompressionError::Held { first, last });
    }
    if travel == 0.0 || !travel.is_finite() {
        return Err(CompressionError::NoMotion);
    }
    Ok(travel.signum())
}

/// Standard deviation of white noise, from the median of the second differences.
pub fn second_difference_noise(values: &[f64]) -> f64 {
    let mut differences: Vec<f64> = values
        .windows(3)
        .map(|w| (w[0] - 2.0 * w[1] + w[2]).abs())
        .collect();
    if differences.is_empty() {
        return 0.0;
    }
    differences.sort_by(f64::total_cmp);
    // Median of |x| of a normal variable: 0.6745 σ; variance of 1, −2, 1: 6.
    differences[differences.len() / 2] / (0.6745 * 6.0_f64.sqrt())
}

/// What following the curve from touch gives.
struct Walk {
    end: usize,
    ended_by: LoadingEnd,
    bioyield: Option<usize>,
    softening: Option<usize>,
    stiffness: Slope,
    stiffness_end: usize,
}

fn follow(
    times: &[f64],
    deformation: &[f64],
    force: &[f64],
    (force_noise, position_noise): (f64, f64),
    options: &CompressionOptions,
) -> Walk {
    let mut walk = Walk {
        end: force.len() - 1,
        ended_by: LoadingEnd::RecordingEnd,
        bioyield: None,
        softening: None,
        stiffness: Slope {
            value: 0.0,
            sd: 0.0,
        },
        stiffness_end: 0,
    };
    let mut window = Window::new(deformation, force);
    let mut recent = Window::new(deformation, force);
    // The samples of the largest deformation and force so far.
    let (mut furthest, mut strongest) = (0, 0);
    for i in 1..force.len() {
        if deformation[i] > deformation[furthest] {
            furthest = i;
        }
        if force[i] > force[strongest] {
            strongest = i;
        }
        let back = deformation[furthest] - deformation[i];
        if back > (5.0 * position_noise).max(REVERSAL * deformation[furthest]) {
            (walk.end, walk.ended_by) = (furthest.min(strongest), LoadingEnd::Reversal);
            break;
        }
        if held(
            times,
            deformation,
            force,
            (furthest, strongest, i),
            force_noise,
            position_noise,
        ) {
            (walk.end, walk.ended_by) = (strongest, LoadingEnd::Hold);
            break;
        }
        // A preload hides how much of the deformation came before the first sample.
        let judged = force[strongest] - force[0] > (JUDGED * force_noise).max(PRELOADS * force[0]);
        if judged && force[i] < options.rupture * force[strongest] {
            (walk.end, walk.ended_by) = (strongest, LoadingEnd::Rupture);
            walk.bioyield = Some(strongest);
            break;
        }
        let length = options.yield_window * deformation[furthest];
        recent.advance(i, SHORTEST_WINDOW, |first| {
            deformation[i] - deformation[first] > length
        });
        let low = (1.0 - options.stiffness_window) * force[strongest];
        window.advance(i, SHORTEST_WINDOW, |first| force[first] < low);
        // Long windows need no judgement at every sample.
        if judged && i.is_multiple_of(1 + window.count() / JUDGEMENTS) {
            judge_stiffness(&mut walk, &window, i);
        }
        if !judged || !i.is_multiple_of(1 + recent.count() / JUDGEMENTS) {
            continue;
        }
        // In a window where a rise would drown in noise nothing can be judged.
        let usual = walk.stiffness.value * recent.length();
        if usual < SEEN * force_noise {
            continue;
        }
        let slope = recent.slope().map_or(f64::INFINITY, |slope| slope.value);
        if walk.softening.is_none() && slope < options.softening * walk.stiffness.value {
            walk.softening = Some(recent.middle());
        }
        if walk.stiffness.value > 0.0 && slope <= 0.0 {
            (walk.end, walk.ended_by) = (strongest, LoadingEnd::Bioyield);
            walk.bioyield = Some(strongest);
            break;
        }
    }
    walk.softening = walk.softening.filter(|index| *index <= walk.end);
    walk.stiffness_end = walk.stiffness_end.min(walk.end);
    if walk.stiffness_end == 0 {
        walk.stiffness_end = walk.end;
    }
    walk
}

/// Whether the machine stands at sample `i` while the force falls.
///
/// At the rate of the loading before, the position would have moved by [`STOPPED`] times what it
/// has since the largest force.
fn held(
    times: &[f64],
    deformation: &[f64],
    force: &[f64],
    (furthest, strongest, i): (usize, usize, usize),
    force_noise: f64,
    position_noise: f64,
) -> bool {
    let fallen = force[strongest] - force[i];
    if i < strongest + SHORTEST_RUN
        || fallen < (TOUCH * force_noise).max(CERTAIN * force[strongest])
    {
        return false;
    }
    let rate = deformation[strongest] / (times[strongest] - times[0]);
    let expected = rate * (times[i] - times[strongest]);
    let moved = deformation[furthest] - deformation[strongest];
    expected > (STOPPED * moved).max(2.0 * STOPPED * position_noise)
}

/// Takes the local stiffness at sample `i` into account.
fn judge_stiffness(walk: &mut Walk, window: &Window, i: usize) {
    let Some(slope) = window.slope() else {
        return;
    };
    if slope.value > walk.stiffness.value && slope.value > 5.0 * slope.sd {
        (walk.stiffness, walk.stiffness_end) = (slope, i);
        // Only a softening after the largest stiffness is one.
        walk.softening = None;
    }
}

/// The largest force before the first sudden fall.
fn rupture(force: &[f64], part: f64) -> Option<usize> {
    let mut strongest = 0;
    for i in 1..force.len() {
        if force[i] > force[strongest] {
            strongest = i;
        }
        if force[i] < part * force[strongest] && force[strongest] > 2.0 * force[0].abs() {
            return Some(strongest);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A Hertzian curve with a sudden yield at `yield_at`, and what follows it.
    fn recording(after: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
        let n = 600;
        let times: Vec<f64> = (0..n).map(|i| f64::from(i) * 0.01).collect();
        let deformation: Vec<f64> = times.iter().map(|t| 1e-3 * (t - 0.5)).collect();
        let law = |d: f64| 2e5 * d.max(0.0).powf(1.5);
        let force = deformation.iter().map(|&d| {
            if d < 3e-3 {
                law(d)
            } else {
                law(3e-3) + after(d - 3e-3)
            }
        });
        let force = force.collect();
        // The jaw position falls while closing.
        let position = deformation.iter().map(|d| 0.04 - d).collect();
        (times, position, force)
    }

    #[test]
    fn closed_form_yield_of_a_hertzian_curve() {
        let (times, position, force) = recording(|d| -2e3 * d);
        let curve =
            compression_curve(&times, &position, &force, &CompressionOptions::default()).unwrap();
        let at = curve.bioyield.unwrap();
        assert!(!curve.began_in_contact);
        assert_eq!(curve.ended_by, LoadingEnd::Bioyield);
        assert!((at.time - 3.5).abs() < 0.011, "{at:?}");
        // The chord over the last 30 % of the force, F/k = d^1.5.
        let first = 3e-3 * 0.7_f64.powf(2.0 / 3.0);
        let chord = 2e5 * (3e-3_f64.powf(1.5) - first.powf(1.5)) / (3e-3 - first);
        assert!((curve.stiffness.value / chord - 1.0).abs() < 0.01);
        // ∫ k d^1.5 = 0.4 k d^2.5.
        let energy = 0.4 * 2e5 * 3e-3_f64.powf(2.5);
        assert!((curve.energy / energy - 1.0).abs() < 0.01);
    }

    #[test]
    fn conserves_results_whatever_follows_the_yield() {
        let options = CompressionOptions::default();
        let of = |after: fn(f64) -> f64| {
            let (times, position, force) = recording(after);
            compression_curve(&times, &position, &force, &options).unwrap()
        };
        let quiet = of(|d| if d < 4e-4 { -2e3 * d } else { -0.8 });
        let wild = of(|d| {
            if d < 4e-4 {
                -2e3 * d
            } else {
                40.0 * (d * 4e4).sin()
            }
        });
        let numbers = |c: &CompressionCurve| {
            let values = [c.stiffness.value, c.energy, c.loading_end.force];
            let ranges = [
                fitted_range(c, FitRange::LargestStiffness),
                fitted_range(c, FitRange::PartOfYield(0.5)),
            ];
            (values.map(f64::to_bits), ranges, c.softening)
        };
        assert_eq!(numbers(&quiet), numbers(&wild));
        assert_eq!(quiet.bioyield, wild.bioyield);
    }

    /// A ramp that ends at 3 mm, and a hold in which half of the force relaxes: no rupture.
    #[test]
    fn closed_form_loading_ends_where_the_position_is_held() {
        let (times, position, force) = recording(|_| 0.0);
        let position: Vec<f64> = position.iter().map(|x| x.max(0.04 - 3e-3)).collect();
        let force: Vec<f64> = times
            .iter()
            .zip(&force)
            .map(|(t, f)| f * (0.5 + 0.5 * (-(t - 3.5).max(0.0) / 0.4).exp()))
            .collect();
        let options = CompressionOptions::default();
        let curve = compression_curve(&times, &position, &force, &options).unwrap();
        assert_eq!(curve.ended_by, LoadingEnd::Hold);
        assert!((curve.loading_end.time - 3.5).abs() < 0.011);
        assert_eq!(curve.bioyield, None);
        // The same fall at an unchanged rate is a rupture.
        let moving: Vec<f64> = times.iter().map(|t| 0.04 - 1e-3 * (t - 0.5)).collect();
        let curve = compression_curve(&times, &moving, &force, &options).unwrap();
        assert!(curve.bioyield.is_some() && curve.ended_by != LoadingEnd::Hold);
    }

    #[test]
    fn closed_form_machine_in_series() {
        let (times, position, force) = recording(|d| -2e3 * d);
        let rigid = CompressionOptions::default();
        let curve = compression_curve(&times, &position, &force, &rigid).unwrap();
        let machine = 1e4;
        // What the jaw of a machine of that stiffness shows.
        let shown: Vec<f64> = position
            .iter()
            .zip(&force)
            .map(|(x, f)| x - f / machine)
            .collect();
        let soft = CompressionOptions {
            machine_stiffness: machine,
            ..rigid
        };
        let corrected = compression_curve(&times, &shown, &force, &soft).unwrap();
        assert!((corrected.stiffness.value / curve.stiffness.value - 1.0).abs() < 1e-9);
    }

    #[test]
    fn rejects_what_is_no_compression() {
        let options = CompressionOptions::default();
        let (times, position, force) = recording(|d| -2e3 * d);
        let pulled: Vec<f64> = force.iter().map(|f| -f).collect();
        let refused = compression_curve(&times, &position, &pulled, &options).unwrap_err();
        assert!(refused.to_string().contains("sign = -1"), "{refused}");
        let still = vec![0.0; times.len()];
        let refused = compression_curve(&times, &still, &force, &options).unwrap_err();
        assert_eq!(refused, CompressionError::NoMotion);
        let falling: Vec<f64> = times.iter().map(|t| 20.0 + 5.0 * (-t).exp()).collect();
        let refused = compression_curve(&times, &still, &falling, &options).unwrap_err();
        assert!(
            refused.to_string().contains("kind = \"relaxation\""),
            "{refused}"
        );
        let few = compression_curve(&times[..5], &position[..5], &force[..5], &options);
        assert!(few.unwrap_err().to_string().starts_with("5 samples"));
    }
}
