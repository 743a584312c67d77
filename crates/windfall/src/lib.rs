//! Files, campaign directories, the store of results and the workflows of
//! windfall.
//!
//! Only this crate opens files, reads clocks and knows file formats. A front end
//! parses arguments, calls one workflow and displays what it returns.

pub mod any_outcome;
pub mod campaign;
pub mod campaign_kind;
pub mod column_role;
pub mod curve;
pub mod envelope;
pub mod error;
pub mod evaluate;
pub mod extract_recording;
pub mod file_campaign;
pub mod fit_impact;
pub mod fit_key;
pub mod fit_mass;
pub mod fit_outcome;
pub mod item_campaign;
pub mod named;
pub mod on_threads;
pub mod option_value;
pub mod outcome;
pub mod provenance;
pub mod read_campaign;
pub mod read_channels;
pub mod read_contact;
pub mod read_csv;
pub mod read_files;
pub mod read_fit;
pub mod read_recording;
pub mod read_rig;
pub mod read_tables;
pub mod recording_digests;
pub mod request_event;
pub mod request_fit;
pub mod request_instrument;
pub mod request_open;
pub mod request_recording;
pub mod request_recordings;
pub mod scan_decimated;
pub mod scan_time;
pub mod scan_value;
pub mod simulate_campaign;
pub mod simulate_example;
pub mod store;
pub mod store_documents;
pub mod store_file;
pub mod summary;
pub mod text_number;
pub mod toml_source;
pub mod workflow_card;
pub mod workflow_fit;
pub mod workflow_fit_any;
pub mod workflow_inspect;
pub mod workflow_new;
pub mod workflow_simulate;
pub mod write_any;
pub mod write_csv;
pub mod write_findings;
pub mod write_groups;
pub mod write_inspection;
pub mod write_simulated;
pub mod write_simulation;
pub mod write_table;
pub mod write_text;
