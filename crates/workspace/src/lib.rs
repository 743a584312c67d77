//! A directory of campaigns as the page shows and edits it.

pub mod campaign_files;
pub mod campaign_view;
pub mod edit_campaign;
pub mod equal_command;
pub mod kept_work;
pub mod live_cache;
pub mod live_fit;
pub mod measured_view;
pub mod recording_outline;
pub mod recording_stretches;
pub mod results_table;
pub mod rig_form;
pub mod scene_runs;
pub mod table_origin;
pub mod undo;
pub mod workspace;
