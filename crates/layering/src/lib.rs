//! Checks of windfall's own source: which crate imports which, which module
//! imports which, what the inner crates may not touch, how long files are
//! and what is left unfinished or holds on one machine only.
//!
//! Workspace → SourceFile → broken rules. Every check is a free function from
//! text or parsed tables to a list of texts, each of which says where a rule is
//! broken and what to do, so that it can be shown to fail on a bad snippet;
//! `tests/` applies them to the workspace.
//!
//! This crate is imported by none and imports no other crate of windfall.

pub mod arrow;
pub mod error;
pub mod forbidden;
pub mod module_cycle;
pub mod source;
pub mod tidiness;
pub mod workspace;
