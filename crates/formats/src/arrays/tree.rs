//! Trees of named arrays, and the channels in them.

use crate::contents::{ChannelContents, Note};
use std::collections::BTreeMap;

/// An array of numbers in a file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Array {
    /// Path from the root.
    pub path: Vec<String>,
    /// Suffix of the name, such as " (real)".
    pub part: &'static str,
    /// Its dimensions in the order the user sees.
    pub extents: Vec<Extent>,
    /// How its numbers are stored.
    pub stored_as: String,
    /// Its value if it is a scalar.
    pub value: Option<f64>,
    /// Its first numbers along the first of two dimensions.
    pub beginning: Vec<f64>,
    pub unit: Option<String>,
    pub properties: Vec<(String, String)>,
}

/// One dimension of an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Extent {
    /// Number of elements along it.
    pub length: u64,
    /// Distance between neighbours in storage order.
    pub step: u64,
}

/// A named scalar that may give the sampling rate of arrays beside or below it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Scalar {
    /// Path to its level; for an attribute, to its owner.
    pub level: Vec<String>,
    pub name: String,
    pub value: f64,
}

/// Numbers inspected to recognise a column of times.
pub(crate) const BEGINNING: u64 = 64;

/// What was found in a file, in file order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tree {
    pub arrays: Vec<Array>,
    /// Scalars from attributes; arrays of one element need not be repeated here.
    pub scalars: Vec<Scalar>,
    /// Texts: path and value.
    pub texts: Vec<(Vec<String>, String)>,
    /// What is left out, by reason.
    pub left_out: BTreeMap<String, Vec<String>>,
    pub notes: Vec<Note>,
}

/// The samples of one channel within an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Series {
    pub array: usize,
    /// First element in storage order.
    pub start: u64,
    /// Elements from one sample to the next.
    pub step: u64,
    /// Number of samples.
    pub length: u64,
}

/// The channels of a file.
#[derive(Clone, Debug, Default)]
pub(crate) struct Listing {
    pub channels: Vec<ChannelContents>,
    pub series: Vec<Series>,
    pub properties: Vec<(String, String)>,
    pub notes: Vec<Note>,
}

impl Tree {
    /// Records that something is left out.
    pub fn leave_out(&mut self, path: &[String], why: &str) {
        let name = path.join("/");
        self.left_out.entry(why.to_owned()).or_default().push(name);
    }
}

/// Dimensions in column-major order, as in MATLAB.
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

/// Dimensions in row-major order, as in C and HDF5.
pub(crate) fn last_fastest(lengths: &[u64]) -> Vec<Extent> {
    let reversed: Vec<u64> = lengths.iter().rev().copied().collect();
    let mut extents = first_fastest(&reversed);
    extents.reverse();
    extents
}

/// Number of elements; `u64::MAX` on overflow.
pub(crate) fn count(extents: &[Extent]) -> u64 {
    extents
        .iter()
        .try_fold(1_u64, |n, e| n.checked_mul(e.length))
        // A zero among huge factors still gives zero.
        .unwrap_or_else(|| match extents.iter().any(|e| e.length == 0) {
            true => 0,
            false => u64::MAX,
        })
}
