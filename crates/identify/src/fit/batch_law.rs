//! Force laws evaluated for several impacts at once, each with parameters of its
//! own.

use crate::fit::estimator::FreeLaw;
use windfall_contact::law::{ContactForce, ContactLaw};
use windfall_contact::laws::any_law::{AnyLaw, LARGEST_PARAMETERS};
use windfall_contact::laws::kuwabara_kono::KuwabaraKono;
use windfall_contact::laws::user::UserLaw;
use windfall_numerics::real::{Lanes, Real};
use windfall_numerics::real_vector::LANES;

/// Impacts integrated side by side.
pub const IMPACTS: usize = 2 * LANES;

/// One number per impact.
pub type PerImpact = Lanes<IMPACTS>;

/// A law with parameters of its own in each lane, without history.
pub trait PackedLaw<const N: usize>: Copy {
    /// Force and derivatives of each lane's law at its displacement and rate: the
    /// same operations as [`ContactLaw::evaluate`], in the same order.
    fn evaluate<R: Real<Plain = PerImpact>>(&self, displacement: R, rate: R) -> ContactForce<R, N>;
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
    fn evaluate<R: Real<Plain = PerImpact>>(&self, d: R, v: R) -> ContactForce<R, 2> {
        let [k, c] = d.with_each_plain([self.k, self.c]);
        let root = d.sqrt();
        ContactForce {
            force: root * (d * k + v * c),
            by_displacement: root * ((v / d) * (c * 0.5) + k * 1.5),
            by_rate: root * c,
            by_parameter: [d * root, root * v],
            by_peak: d.constant(0.0),
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
    fn evaluate<R: Real<Plain = PerImpact>>(&self, d: R, v: R) -> ContactForce<R, N> {
        let (plain, rate) = (d.plain(), v.plain());
        let mut force = PerImpact::ZERO;
        let mut by_displacement = PerImpact::ZERO;
        let mut by_rate = PerImpact::ZERO;
        let mut by_parameter = [PerImpact::ZERO; N];
        for (lane, law) in self.0.iter().enumerate() {
            let one = law.evaluate(plain.0[lane], rate.0[lane], 0.0);
            force.0[lane] = one.force;
            by_displacement.0[lane] = one.by_displacement;
            by_rate.0[lane] = one.by_rate;
            for (to, by) in by_parameter.iter_mut().zip(one.by_parameter) {
                to.0[lane] = by;
            }
        }
        ContactForce {
            force: d.with_plain(force),
            by_displacement: d.with_plain(by_displacement),
            by_rate: d.with_plain(by_rate),
            by_parameter: d.with_each_plain(by_parameter),
            by_peak: d.constant(0.0),
        }
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
        let d = Lanes([1e-30, 1e-4, 7e-4, 2e-3, 3e-3, 1e-3, 5e-5, 1e-6]);
        let v = Lanes([0.4, 0.3, -0.1, -0.3, 0.0, -0.2, 0.1, 1.0]);
        let packed = KuwabaraKono::packed(&laws).evaluate(d, v);
        let singly = OneByOne(laws).evaluate(d, v);
        assert_eq!(packed.force, singly.force);
        assert_eq!(packed.by_displacement, singly.by_displacement);
        assert_eq!(packed.by_rate, singly.by_rate);
        assert_eq!(packed.by_parameter, singly.by_parameter);
        assert!(packed.force.0[1] > 0.0);
    }
}
