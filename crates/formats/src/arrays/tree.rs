//! Arrays of numbers under names in a tree, as MAT and HDF5 files hold them, and
//! the channels in them.

use crate::contents::{ChannelContents, Note};
use std::collections::BTreeMap;

/// An array of numbers in a file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Array {
    /// Names from the root to it.
    pub path: Vec<String>,
    /// What is appended to the name: " (real)".
    pub part: &'static str,
    /// Its extents as a user sees them.
    pub extents: Vec<Extent>,
    /// How its numbers are stored.
    pub stored_as: String,
    /// Its value, if it is one number.
    pub value: Option<f64>,
    /// Its first numbers along the first extent, if it has two.
    pub beginning: Vec<f64>,
    /// The unit that the file gives.
    pub unit: Option<String>,
    /// Other things that the file says of it.
    pub properties: Vec<(String, String)>,
}

/// One extent of an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Extent {
    /// Number of elements along it.
    pub length: u64,
    /// Elements in the order of storage from one to the next.
    pub step: u64,
}

/// One number with a name that may say how fast the arrays beside it or below
/// were sampled.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Scalar {
    /// Names from the root to where it stands; for an attribute, to its owner.
    pub level: Vec<String>,
    /// Its own name.
    pub name: String,
    /// The number.
    pub value: f64,
}

/// Numbers from which a column of times is told.
pub(crate) const BEGINNING: u64 = 64;

/// What was found in a file, in its order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tree {
    /// Arrays of numbers.
    pub arrays: Vec<Array>,
    /// Numbers of attributes; those of arrays of one element need not be listed.
    pub scalars: Vec<Scalar>,
    /// Texts: names from the root, and the text.
    pub texts: Vec<(Vec<String>, String)>,
    /// What is no numbers, by the reason why it is left out.
    pub left_out: BTreeMap<String, Vec<String>>,
    /// Other notes.
    pub notes: Vec<Note>,
}

/// The samples of one channel within an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Series {
    /// Position of the array.
    pub array: usize,
    /// Its first sample, in elements in the order of storage.
    pub start: u64,
    /// Elements from one sample to the next.
    pub step: u64,
    /// Number of samples.
    pub length: u64,
}

/// The channels of a file.
#[derive(Clone, Debug, Default)]
pub(crate) struct Listing {
    /// What a user sees of them.
    pub channels: Vec<ChannelContents>,
    /// Where the samples of each are.
    pub series: Vec<Series>,
    /// Numbers and texts of the file.
    pub properties: Vec<(String, String)>,
    /// What a user must know.
    pub notes: Vec<Note>,
}

impl Tree {
    /// Notes that something is no channel.
    pub fn leave_out(&mut self, path: &[String], why: &str) {
        let name = path.join("/");
        self.left_out.entry(why.to_owned()).or_default().push(name);
    }
}

/// Extents whose first runs fastest in storage, as MATLAB stores.
pub(crate) fn first_fastest(lengths: &[u64]) -> Vec<Extent> {
    let mut step = 1_u64;
    lengths
        .iter()
        .map(|&length| {
            let extent = Extent { length, step };
            step = step.saturating_mul(length.max(1));
            extent
        })
        .collect()
}

/// Extents whose last runs fastest in storage, as C and HDF5 store.
pub(crate) fn last_fastest(lengths: &[u64]) -> Vec<Extent> {
    let reversed: Vec<u64> = lengths.iter().rev().copied().collect();
    let mut extents = first_fastest(&reversed);
    extents.reverse();
    extents
}

/// Number of elements; `u64::MAX` where they cannot be counted.
pub(crate) fn count(extents: &[Extent]) -> u64 {
    extents
        .iter()
        .try_fold(1_u64, |n, e| n.checked_mul(e.length))
        // A zero among numbers too large is still nothing.
        .unwrap_or_else(|| match extents.iter().any(|e| e.length == 0) {
            true => 0,
            false => u64::MAX,
        })
}
