//! The laws of contacts, and what they say of many at once; compiled once for each law.

use crate::contacts::react::{Normal, normal_of};
use windfall_contact::for_each_law;
use windfall_contact::law::ContactLaw;
use windfall_contact::laws::kind as laws;
use windfall_contact::laws::kind::Law;
use windfall_contact::laws::user::UserLaw;
use windfall_numerics::real::Lanes;
use windfall_numerics::real_vector::{EIGHT, EightLanes, EightNumbers, with_eight_lanes};

/// Eight numbers as they are kept.
pub(crate) type Eight = Lanes<EIGHT>;

/// Displacement (m), its rate (m/s) and the largest so far (m) of eight contacts.
pub(crate) type Given = [Eight; 3];

/// Laws of contacts, of one kind.
pub(crate) trait LawColumn: Send + Sync {
    /// Takes in one more; whether it is of the kind.
    fn push(&mut self, law: &Law) -> bool;
    /// One of them.
    fn at(&self, contact: usize) -> Law;
    /// Takes out one; the last takes its place.
    fn swap_remove(&mut self, contact: usize);
    /// What the law of each contact says.
    ///
    /// * `median`: the law of all, if they have the same but for a factor
    /// * `first`: the first group of eight
    /// * `given`: of each group
    /// * `found`: as long
    fn normal(
        &self,
        median: Option<&Law>,
        first: usize,
        given: &[Given],
        found: &mut [Normal<Eight>],
    );
}

/// A column for laws of the kind, with room for so many.
pub(crate) fn law_column(law: &Law, room: usize) -> Box<dyn LawColumn> {
    macro_rules! of {
        (() $($variant:ident in $module:ident,)*) => {
            match law {
                $(Law::$variant(_) => Box::new(Column::<laws::$variant, _>(Vec::with_capacity(room))),)*
                Law::User(_) => Box::new(Column::<UserLaw, _>(Vec::with_capacity(room))),
            }
        };
    }
    for_each_law! { (of) () }
}

struct Column<L, const N: usize>(Vec<L>);

impl<L: ContactLaw<N> + Variant, const N: usize> LawColumn for Column<L, N> {
    fn push(&mut self, law: &Law) -> bool {
        let own = L::of(law);
        self.0.extend(own);
        own.is_some()
    }

    fn at(&self, contact: usize) -> Law {
        self.0[contact].law()
    }

    fn swap_remove(&mut self, contact: usize) {
        self.0.swap_remove(contact);
    }

    fn normal(
        &self,
        median: Option<&Law>,
        first: usize,
        given: &[Given],
        found: &mut [Normal<Eight>],
    ) {
        match median.and_then(L::of) {
            Some(law) => with_eight_lanes(OfOne::<L, N> { law, given, found }),
            None => self.of_each(first, given, found),
        }
    }
}

impl<L: ContactLaw<N>, const N: usize> Column<L, N> {
    fn of_each(&self, first: usize, given: &[Given], found: &mut [Normal<Eight>]) {
        for (group, (given, found)) in given.iter().zip(found).enumerate() {
            let own = self.0[(first + group) * EIGHT..].iter().take(EIGHT);
            for (lane, law) in own.enumerate() {
                let [d, v, peak] = given.map(|each| each.0[lane]);
                let own = normal_of(law, d, v, peak);
                found.force.0[lane] = own.force;
                found.damping.0[lane] = own.damping;
                found.stiffness.0[lane] = own.stiffness;
            }
        }
    }
}

/// One law for all contacts.
struct OfOne<'a, L, const N: usize> {
    law: L,
    given: &'a [Given],
    found: &'a mut [Normal<Eight>],
}

impl<L: ContactLaw<N>, const N: usize> EightLanes for OfOne<'_, L, N> {
    type Output = ();

    #[inline(always)]
    fn run<R: EightNumbers>(self, zero: R) {
        for (given, found) in self.given.iter().zip(self.found) {
            let [d, v, peak] = zero.with_each_plain(*given);
            let own = normal_of(&self.law, d, v, peak);
            *found = Normal {
                force: own.force.plain(),
                damping: own.damping.plain(),
                stiffness: own.stiffness.plain(),
            };
        }
    }
}

/// A law that is one of the registry's variants.
trait Variant: Copy {
    fn of(law: &Law) -> Option<Self>;
    fn law(self) -> Law;
}

macro_rules! variants {
    (() $($variant:ident in $module:ident,)*) => {
        $(variants! { $variant: laws::$variant })*
    };
    ($variant:ident: $type:ty) => {
        impl Variant for $type {
            fn of(law: &Law) -> Option<Self> {
                match law {
                    Law::$variant(own) => Some(*own),
                    _ => None,
                }
            }

            fn law(self) -> Law {
                Law::$variant(self)
            }
        }
    };
}

for_each_law! { (variants) () }
variants! { User: UserLaw }
