//! Contact-force laws of fruit from impact recordings, with calibrated uncertainty.
//!
//! One `use` brings in what another program needs: the workflows, what they are asked for
//! and what they return. Numbers are SI; texts carry their unit.
//!
//! ```
//! use windfall::prelude::*;
//!
//! // One recording of a carriage that struck a fruit, without a campaign around it.
//! let recording = RecordingRequest {
//!     rig: "carriage".into(),
//!     mass: Some("0.2 kg".into()),
//!     sampling_rate: Some("20 kHz".into()),
//!     channels: vec![
//!         "force=force_V:11 mV/N".into(),
//!         "position=position_V:100 V/m".into(),
//!     ],
//!     ..RecordingRequest::default()
//! };
//! let request = FitRequest {
//!     laws: vec!["kuwabara-kono".into()],
//!     ..FitRequest::default()
//! };
//! let outcome = fit_recording("examples/impact.csv".as_ref(), &recording, &request, &quiet)?;
//! let k = outcome.impacts[0].parameters.get("k").unwrap();
//! let (low, high) = k.interval().unwrap();
//! assert!(low < 753_599.0 && 753_599.0 < high);
//!
//! // The fitted law in an event that was not measured.
//! let law = parse_law(&format!("kuwabara-kono(k={}, c=1524)", k.value))?.complete()?;
//! let impact = simulate_impact(&law, 0.3, 0.8, 0.0, EndRule::ForceZero)?;
//! assert!(impact.restitution < 1.0 && impact.peak_force > 0.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Two cargo features, both on by default, bring most of the crates below windfall: `png`
//! draws figures as PNG beside SVG, `sampler` draws posteriors. Without them windfall says
//! what is missing when it is asked for.

/// What another program needs.
pub mod prelude {
    pub use windfall_campaign::impacts::run::{fit_campaign, fit_recording};
    pub use windfall_campaign::pipeline::request::{FitRequest, Reuse};
    pub use windfall_campaign::recording::request::RecordingRequest;
    pub use windfall_campaign::result::outcome::{CampaignOutcome, ImpactOutcome};
    pub use windfall_cards::law_card::LawCard;
    pub use windfall_cards::read_card::read_card;
    pub use windfall_contact::expression::parse_law;
    pub use windfall_contact::law::{ContactLaw, EndRule};
    pub use windfall_contact::laws::kind::{Law, LawKind};
    pub use windfall_files::error::Error;
    pub use windfall_files::found::{EstimateOutcome, FailureOutcome, FindingOutcome};
    pub use windfall_files::progress::quiet;
    pub use windfall_identify::rig::simulate::simulate_impact;
    pub use windfall_measure::any_outcome::AnyOutcome;
    pub use windfall_report::fit_any::fit_any;
}
