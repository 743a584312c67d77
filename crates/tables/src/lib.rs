//! Statistics of tables: designs, regression, response surfaces, comparison of groups.

mod columns;
pub mod compare;
pub mod design;
pub mod regress;
pub mod surface;
