//! A model of one impact to compare with samples.

use crate::rig::impact_event::ImpactEvent;

/// How the columns of the Jacobian come from the motion's lanes.
#[derive(Clone, Copy, Debug)]
pub struct Columns<const P: usize> {
    /// Lane of the motion that each column reads; 0 for none.
    pub lanes: [usize; P],
    /// ∂t₀ of each column; s per unit of the column.
    pub onset: [f64; P],
    /// ∂(displacement offset) of each column; m per unit of the column.
    pub offset: [f64; P],
}

/// A model to compare with samples: an impact with its clock.
#[derive(Clone, Copy, Debug)]
pub struct Model<L, const N: usize, const W: usize, const P: usize> {
    /// The impact.
    pub event: ImpactEvent<L, N, W>,
    /// First touch on the clock of the samples; s.
    pub onset: f64,
    /// Added to the model's displacement; m.
    pub offset: f64,
    /// Columns of the Jacobian.
    pub columns: Columns<P>,
    /// How a force sample near first touch is understood.
    pub sampling: Sampling,
}

/// What a force sample near first touch is.
///
/// A force that begins like √t makes the cost of instantaneous samples rugged
/// in the onset: each sample that the onset passes leaves a cusp. A mean over
/// the sampling interval, which is what a converter and its filter deliver,
/// does not. The two differ for the samples within two intervals of the onset.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Sampling {
    /// The force at the instant of the sample.
    #[default]
    Instantaneous,
    /// Its mean over one sampling interval.
    Averaged,
}
