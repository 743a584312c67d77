//! Numbers, quantities and tables as text, and the text of TOML files with its places.

pub mod cell_quantity;
pub mod column_guess;
pub mod column_role;
pub mod column_title;
pub mod columns;
pub mod file_quantity;
pub mod file_schema;
pub mod number;
pub mod quote;
pub mod result_schema;
pub mod spanned;
pub mod statistic;
pub mod table;
pub mod toml_places;
pub mod toml_source;
