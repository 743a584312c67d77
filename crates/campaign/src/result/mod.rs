//! Results of fits as they are stored and shown.

pub mod bench;
pub mod counted;
pub mod fit_outcome;
pub mod given;
pub mod interval_outcome;
pub mod joint;
pub mod outcome;
pub mod quantity;
pub mod stacked;
pub mod summary;
pub mod trend;
pub mod trend_findings;
