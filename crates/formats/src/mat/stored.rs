//! Where the numbers of an array are in a MAT file.

use crate::arrays::tree::Tree;
use crate::mat::flow::Region;
use crate::number::Number;

/// The numbers of one array.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stored {
    /// The variable that they are in.
    pub region: Region,
    /// First byte, within the (decompressed) bytes of the region.
    pub at: u64,
    /// How each is stored.
    pub number: Number,
    /// How many.
    pub count: u64,
    /// Order of bytes.
    pub big_endian: bool,
    /// Whether nothing follows in the variable.
    pub closes: bool,
}

/// What a MAT file holds, with the places of the arrays in its tree.
#[derive(Debug, Default)]
pub(crate) struct MatTree {
    /// Arrays and texts.
    pub tree: Tree,
    /// Where the numbers of each array are.
    pub stored: Vec<Stored>,
}
