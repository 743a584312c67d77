//! Force laws evaluated for several impacts at once, each with parameters of its
//! own.

use crate::fit::estimator::FreeLaw;
use crate::samples::PACK;
use windfall_contact::law::{ContactForce, ContactLaw};
use windfall_contact::laws::any_law::{AnyLaw, LARGEST_PARAMETERS};
use windfall_contact::laws::kuwabara_kono::KuwabaraKono;
use windfall_contact::laws::user::UserLaw;
use windfall_numerics::real::{Lanes, Real};

/// Impacts integrated side by side.
pub const IMPACTS: usize = PACK;

/// One number per impact.
pub type PerImpact = Lanes<IMPACTS>;

/// A law with parameters of its own in each lane, without history.
pub trait PackedLaw<const N: usize>: Copy {
    /// Force and derivatives of each lane's law at its displacement and rate: the
    /// same operations as [`ContactLaw::evaluate`], in the same order.
    fn evaluate(&self, displacement: PerImpact, rate: PerImpact) -> ContactForce<PerImpact, N>;
}

/// A law that a batch of impacts can be fitted with.
pub trait BatchLaw<const N: usize>: FreeLaw<N> {
    /// The laws of several impacts together.
    type Packed: PackedLaw<N>;

    /// One law per lane.
    fn packed(laws: &[Self; IMPACTS]) -> Self::Packed;
}

/// [`KuwabaraKono`] laws, one per lane.
#[derive(Clone, Copy, Debug)]
pub struct PackedKuwabaraKono {
    k: PerImpact,
    c: PerImpact,
}

impl PackedLaw<2> for PackedKuwabaraKono {
    #[inline(always)]
    fn evaluate(&self, d: PerImpact, v: PerImpact) -> ContactForce<PerImpact, 2> {
        let root = d.sqrt();
        ContactForce {
            force: root * (d * self.k + v * self.c),
            by_displacement: root * ((v / d) * (self.c * 0.5) + self.k * 1.5),
            by_rate: root * self.c,
            by_parameter: [d * root, root * v],
            by_peak: PerImpact::ZERO,
        }
    }
}

impl BatchLaw<2> for KuwabaraKono {
    type Packed = PackedKuwabaraKono;

    #[inline(always)]
    fn packed(laws: &[Self; IMPACTS]) -> Self::Packed {
        PackedKuwabaraKono {
            k: Lanes(laws.map(|law| law.k)),
            c: Lanes(laws.map(|law| law.c)),
        }
    }
}

/// Laws that are evaluated one after the other.
#[derive(Clone, Copy, Debug)]
pub struct OneByOne<L>([L; IMPACTS]);

impl<L: ContactLaw<N>, const N: usize> PackedLaw<N> for OneByOne<L> {
    #[inline(always)]
    fn evaluate(&self, d: PerImpact, v: PerImpact) -> ContactForce<PerImpact, N> {
        let mut out = ContactForce {
            force: PerImpact::ZERO,
            by_displacement: PerImpact::ZERO,
            by_rate: PerImpact::ZERO,
            by_parameter: [PerImpact::ZERO; N],
            by_peak: PerImpact::ZERO,
        };
        for (lane, law) in self.0.iter().enumerate() {
            let one = law.evaluate(d.0[lane], v.0[lane], 0.0);
            out.force.0[lane] = one.force;
            out.by_displacement.0[lane] = one.by_displacement;
            out.by_rate.0[lane] = one.by_rate;
            for (out, by) in out.by_parameter.iter_mut().zip(one.by_parameter) {
                out.0[lane] = by;
            }
        }
        out
    }
}

impl BatchLaw<LARGEST_PARAMETERS> for AnyLaw {
    type Packed = OneByOne<Self>;

    fn packed(laws: &[Self; IMPACTS]) -> Self::Packed {
        OneByOne(*laws)
    }
}

impl BatchLaw<LARGEST_PARAMETERS> for UserLaw {
    type Packed = OneByOne<Self>;

    fn packed(laws: &[Self; IMPACTS]) -> Self::Packed {
        OneByOne(*laws)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The packed law against the law of each lane, to the bit.
    #[test]
    fn repeats_the_law_of_each_lane() {
        let laws: [KuwabaraKono; IMPACTS] =
            std::array::from_fn(|i| KuwabaraKono::from([1e5 + 3e4 * i as f64, 100.0 * i as f64]));
        let d = Lanes([1e-30, 1e-4, 7e-4, 2e-3]);
        let v = Lanes([0.4, 0.3, -0.1, -0.3]);
        let packed = KuwabaraKono::packed(&laws).evaluate(d, v);
        let singly = OneByOne(laws).evaluate(d, v);
        assert_eq!(packed.force, singly.force);
        assert_eq!(packed.by_displacement, singly.by_displacement);
        assert_eq!(packed.by_rate, singly.by_rate);
        assert_eq!(packed.by_parameter, singly.by_parameter);
        assert!(packed.force.0[1] > 0.0);
    }
}
