//! The HTTP interface, by subject.

pub(crate) mod campaigns;
pub(crate) mod changes;
pub(crate) mod events;
pub(crate) mod files;
pub(crate) mod jobs;
pub(crate) mod live;
pub(crate) mod recordings;
pub(crate) mod scenes;
pub(crate) mod tables;
