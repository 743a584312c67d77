//! windfall for other programs.
