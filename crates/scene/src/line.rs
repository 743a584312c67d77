//! Numbers that lie within one line of a processor's memory, so that it fetches one and not
//! two.

use std::ops::{Deref, DerefMut};

/// A whole line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(64))]
pub(crate) struct Line(pub [f64; 8]);

/// Half a line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub(crate) struct HalfLine(pub [f64; 4]);

impl Line {
    pub(crate) const ZERO: Self = Self([0.0; 8]);
}

macro_rules! numbers {
    ($of:ident, $count:literal) => {
        impl Deref for $of {
            type Target = [f64; $count];

            #[inline(always)]
            fn deref(&self) -> &Self::Target {
                &self.0
            }
        }

        impl DerefMut for $of {
            #[inline(always)]
            fn deref_mut(&mut self) -> &mut Self::Target {
                &mut self.0
            }
        }
    };
}

numbers!(Line, 8);
numbers!(HalfLine, 4);
