//! Location of arrays in a MAT file.

use crate::arrays::tree::Tree;
use crate::mat::flow::Region;
use crate::number::Number;

/// Location of the numbers of an array.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stored {
    /// The variable.
    pub region: Region,
    /// Offset in the (decompressed) variable.
    pub at: u64,
    pub number: Number,
    pub count: u64,
    pub big_endian: bool,
    /// Whether the array is the last in its variable.
    pub closes: bool,
}

#[derive(Debug, Default)]
pub(crate) struct MatTree {
    pub tree: Tree,
    /// Location of each array.
    pub stored: Vec<Stored>,
}
