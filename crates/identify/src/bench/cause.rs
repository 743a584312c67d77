//! Which fault of a bench explains what the fits of all its impacts leave, and how large it is.

pub use crate::bench::kind::Cause;
use crate::bench::residuals::{BenchFault, BenchResiduals};
use crate::bench::search::{Found, Search};
use windfall_signal::uncertain::Uncertain;

/// Fewest impacts that say something of their bench.
const FEWEST: usize = 5;
/// An impact whose squares are this many times those of the median has a fault of its own; 1.
const OWN_FAULT: f64 = 4.0;
/// Part of a displacement that the bending of an arm is counted in; 1.
const BENT: f64 = 0.01;
/// Part of a contact that a delay is counted in; 1.
const LATE: f64 = 0.01;

/// A cause with its parameters as the impacts determine them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CauseFound {
    /// The cause.
    pub cause: Cause,
    /// Its fault.
    pub fault: BenchFault,
    /// Gain less 1; 1.
    pub gain: Uncertain,
    /// Delay; s.
    pub delay: Uncertain,
    /// Corner of a filter, or natural frequency; Hz.
    pub frequency: Uncertain,
    /// Damping ratio; 1.
    pub damping: Uncertain,
    /// Bending; m/N.
    pub compliance: Uncertain,
    /// −2 ln of the likelihood, up to a constant, plus twice the number of parameters; 1.
    pub aic: f64,
    /// Impacts that it comes from.
    pub impacts: usize,
}

/// Part of the time between samples, over the contact, by which all impacts alike may be wrong
/// about a frequency; 1. Of 100 campaigns of 200 impacts with simulated sensors at 2 kHz, sampled
/// at 200 kHz, the shift is 0.02.
const BLUR: f64 = 0.05;

/// Impacts without those that no common cause explains as the others.
fn of_one_kind(impacts: &[BenchResiduals]) -> Vec<BenchResiduals> {
    let size = |own: &BenchResiduals| {
        let squares: f64 = own.residuals.iter().map(|r| r * r).sum();
        squares / own.residuals.len() as f64
    };
    let mut sizes: Vec<f64> = impacts.iter().map(size).collect();
    sizes.sort_by(f64::total_cmp);
    let Some(median) = sizes.get(sizes.len() / 2).copied() else {
        return Vec::new();
    };
    let usual = impacts.iter().filter(|own| size(own) <= OWN_FAULT * median);
    usual.cloned().collect()
}

/// Estimates each cause over the impacts of a bench, the likeliest first.
///
/// ```text
/// S(β) = Σᵢ | Pᵢ (rᵢ + dᵢ(β)) |²
/// ```
///
/// with the whitened residuals r of impact i, what a fault β of the bench adds to them, d, and
/// the projection P off what the parameters of the fit explain. Deviations are the larger of
/// what the scatter from impact to impact gives, which a few impacts may decide, and what the size
/// of the residuals does. Empty with fewer than five impacts.
///
/// # Source
/// Golub and Pereyra (1973), SIAM J. Numer. Anal. 10:413 (variable projection).
pub fn likeliest_causes(impacts: &[BenchResiduals], causes: &[Cause]) -> Vec<CauseFound> {
    let impacts = of_one_kind(impacts);
    if impacts.len() < FEWEST {
        return Vec::new();
    }
    let count = impacts.len() as f64;
    let duration = impacts.iter().map(|own| own.duration).sum::<f64>() / count;
    let softness = impacts.iter().map(BenchResiduals::softness).sum::<f64>() / count;
    let solved: Vec<(Cause, Found, BenchFault)> = causes
        .iter()
        .filter_map(|&cause| {
            let mut search = Search {
                impacts: &impacts,
                cause,
                compliance: BENT * softness,
                time: LATE * duration,
            };
            let found = search.solve()?;
            let fault = search.fault(&found.parameters);
            Some((cause, found, fault))
        })
        .collect();
    // The scale of the noise is that of the best description.
    let samples: usize = impacts.iter().map(|own| own.residuals.len()).sum();
    let parameters: usize = impacts.iter().map(|own| own.parameters).sum();
    let freedom = samples.saturating_sub(parameters).max(1) as f64;
    let wider = impacts.iter().map(|own| own.inflation).sum::<f64>() / count;
    let least = solved.iter().map(|own| own.1.cost);
    let scale = least.fold(f64::INFINITY, f64::min) / freedom * wider.max(1.0);
    let interval = impacts.iter().map(BenchResiduals::interval).sum::<f64>() / count;
    let blur = BLUR * interval / duration;
    let mut all: Vec<CauseFound> = solved
        .into_iter()
        .map(|(cause, found, fault)| {
            let sd = |i: usize| match cause.free()[i] {
                true => found.scatter[i].max(scale * found.white[i]).sqrt(),
                false => 0.0,
            };
            let swing = fault
                .response
                .sensor
                .or(fault.response.arm.map(|arm| arm.swing));
            let frequency = fault.response.pole.or(swing.map(|own| own.frequency));
            let frequency = frequency.unwrap_or(0.0);
            let damping = swing.map_or(0.0, |own| own.damping);
            let bending = fault.response.arm.map_or(0.0, |arm| arm.compliance);
            CauseFound {
                cause,
                fault,
                gain: Uncertain::new(fault.gain, sd(0)),
                delay: Uncertain::new(fault.delay, sd(1) * LATE * duration),
                frequency: Uncertain::new(frequency, sd(2).hypot(blur) * frequency),
                damping: Uncertain::new(damping, sd(3) * damping),
                compliance: Uncertain::new(bending, sd(4) * BENT * softness),
                aic: found.cost / scale + 2.0 * cause.parameters() as f64,
                impacts: impacts.len(),
            }
        })
        .collect();
    all.sort_by(|a, b| a.aic.total_cmp(&b.aic));
    all
}
