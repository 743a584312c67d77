//! What campaign.toml, specimens.csv and impacts.csv say.

pub mod bench;
pub mod channels;
pub mod conditioning;
pub mod contact;
pub mod edit_table;
pub mod file;
pub mod files;
pub mod fit;
pub mod kind;
pub mod known;
pub mod model;
pub mod open_options;
pub mod read;
pub mod response;
pub mod rig;
pub mod rig_given;
pub mod schema;
pub mod shared;
pub mod tables;
pub mod template;
