//! `windfall fit` and `windfall report` for campaigns of every kind.

pub mod any_text;
pub mod explain;
pub mod figures;
pub mod fit_any;
pub mod impacts;
pub mod items;
mod listed;
pub mod methods;
pub mod run;
pub mod schema_of_template;
pub mod stored_card;
