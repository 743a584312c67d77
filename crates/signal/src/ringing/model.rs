//! Free ringing of a plate after an impact, as a damped cosine.

use crate::tap::damped_mode::{ModeStart, Transformed, fit_modes, mode_samples};
use crate::tap::spectrum::transform;
use crate::uncertain::Uncertain;
use std::f64::consts::{PI, TAU};

/// Free ringing of a plate:
///
/// ```text
/// F(t) = amplitude · exp(−λ (t − from)) · cos(2π (t − from) / period − phase)
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ringing {
    /// Begin of the stretch that was fitted; s.
    pub from: f64,
    /// Its end; s.
    pub to: f64,
    /// Damped period, T_d; s.
    pub period: Uncertain,
    /// Damping ratio, ζ; 1.
    pub damping_ratio: Uncertain,
    /// Amplitude at `from`; N.
    pub amplitude: f64,
    /// Phase at `from`; rad.
    pub phase: f64,
    /// Residual over noise, root mean square; near 1 for a single mode.
    pub misfit: f64,
}

/// Decay of the amplitude, λ = ζ ω_n; 1/s.
pub fn decay_rate(period: f64, damping_ratio: f64) -> f64 {
    TAU / period * damping_ratio / (1.0 - damping_ratio * damping_ratio).sqrt()
}

/// Force of the ringing at a time, before or after the stretch too; N.
pub fn ringing_at(ringing: &Ringing, time: f64) -> f64 {
    let t = time - ringing.from;
    let decay = decay_rate(ringing.period.value, ringing.damping_ratio.value);
    ringing.amplitude * (-decay * t).exp() * (TAU * t / ringing.period.value - ringing.phase).cos()
}

/// Amplitude of the ringing at a time; N.
pub fn amplitude_at(ringing: &Ringing, time: f64) -> f64 {
    let decay = decay_rate(ringing.period.value, ringing.damping_ratio.value);
    ringing.amplitude * (-decay * (time - ringing.from)).exp()
}

/// Fits a damped cosine to a stretch of free ringing.
///
/// * `from`, `interval`: time of the first sample, and between samples; s
/// * `values`: force from its static level; N
/// * `noise`: standard deviation of a sample; N
/// * `period`, `decay`: what they are about; s, 1/s
///
/// `None` if nothing oscillates there.
///
/// # Numerics
/// Least squares in the frequency domain ([`crate::tap::damped_mode`]): a constant
/// that is left in the force has no effect. Standard uncertainties are those of
/// the fit with the variance of its own residuals; frequency and decay of a
/// damped cosine hardly correlate.
pub fn fit_ringing(
    from: f64,
    interval: f64,
    values: &[f64],
    noise: f64,
    (period, decay): (f64, f64),
) -> Option<Ringing> {
    let spectrum = transform(values, values.len());
    let transformed = Transformed {
        values: &spectrum,
        samples: values.len(),
        interval,
    };
    let start = ModeStart {
        frequency: 1.0 / period,
        width: decay / PI,
    };
    let mode = *fit_modes(&transformed, &[start])
        .first()
        .filter(|mode| mode.converged && mode.amplitude > 0.0)?;
    let fitted: Vec<f64> = mode_samples(&mode, interval, values.len()).collect();
    let rest: Vec<f64> = values.iter().zip(&fitted).map(|(y, f)| y - f).collect();
    let n = rest.len() as f64;
    let mean = rest.iter().sum::<f64>() / n;
    let square: f64 = rest.iter().map(|r| (r - mean).powi(2)).sum();
    // ζ = λ/√(λ² + ω_d²) with Q = ω_d/2λ.
    let below = 1.0 + 4.0 * mode.quality * mode.quality;
    let damping_ratio = Uncertain::new(
        1.0 / below.sqrt(),
        4.0 * mode.quality * mode.quality_sd / below.powf(1.5),
    );
    Some(Ringing {
        from,
        to: from + (n - 1.0) * interval,
        period: Uncertain::new(
            1.0 / mode.frequency,
            mode.frequency_sd / mode.frequency.powi(2),
        ),
        damping_ratio,
        amplitude: mode.amplitude,
        phase: mode.phase,
        misfit: (square / (n - 5.0).max(1.0)).sqrt() / noise,
    })
}
