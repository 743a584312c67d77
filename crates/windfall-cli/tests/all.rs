//! The tests of this crate as one program, which is built and linked once.

#![allow(clippy::unwrap_used)]

mod bench;
mod bounces;
mod calibrate;
mod command_line;
mod compare;
mod counted;
mod design;
mod detail;
mod drop;
mod drop_eccentric;
mod faults;
mod figures;
mod fit_campaign;
mod fit_recording;
mod gather;
mod guide;
mod http;
mod identification;
mod inputs;
mod joint;
mod kinds;
mod known;
mod library;
mod means;
mod messages;
mod on_table;
mod outputs;
mod page_quantities;
mod plan;
mod regress;
mod relaxation;
mod report;
mod revision;
mod scene;
mod serve;
mod several_contacts;
mod stopped_runs;
mod surface_blocks;
mod surface_random;
mod table_figures;
mod tables;
mod user_laws;
mod variances;
mod velocities;
