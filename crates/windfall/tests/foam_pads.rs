//! A real campaign: a cart on an incline against foam pads, read in place.
//!
//! The recordings are somebody else's and are not part of this repository: the
//! folder comes from `WINDFALL_DATA` (default `../shared/data` beside the
//! workspace). Without it the test says what it leaves out.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::Path;
use windfall_campaign::impacts::run::fit_campaign;
use windfall_campaign::pipeline::request::FitRequest;
use windfall_campaign::result::outcome::ImpactOutcome;

/// The shipped campaign with the folder written out; nothing else changed.
fn campaign_in(scratch: &Path, data: &Path) {
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/foam_pads");
    for name in ["specimens.csv", "impacts.csv"] {
        std::fs::copy(example.join(name), scratch.join(name)).unwrap();
    }
    let toml = std::fs::read_to_string(example.join("campaign.toml")).unwrap();
    let data = data.canonicalize().unwrap();
    let toml = toml.replace("${WINDFALL_DATA}", data.to_str().unwrap());
    std::fs::write(scratch.join("campaign.toml"), toml).unwrap();
}

#[test]
fn recovers_cart_and_pads_from_real_recordings() {
    if windfall_test_data::find("impact/foam_pads").is_none() {
        return;
    }
    let data = windfall_test_data::recordings();
    windfall_files::confined::also_read(vec![data.clone()]);
    let scratch = tempfile::tempdir().unwrap();
    campaign_in(scratch.path(), &data);
    let request = FitRequest {
        laws: vec!["kelvin-voigt".to_owned(), "hertz".to_owned()],
        ..FitRequest::default()
    };
    let outcome = fit_campaign(scratch.path(), &request, &windfall_files::progress::quiet).unwrap();
    assert!(outcome.failed.is_empty(), "{:?}", outcome.failed);
    assert_eq!((outcome.impacts.len(), outcome.groups.len()), (20, 4));

    // The authors' note on the data: the cart is near 0.5 kg.
    let mass = outcome.effective_mass;
    assert!(
        mass.impacts >= 8 && (mass.value - 0.5).abs() < 0.05,
        "{mass:?}"
    );
    assert!(mass.sd > 0.0 && mass.sd < 0.05, "{mass:?}");

    // The linear law by arithmetic alone: half a period of contact, π √(m/k),
    // is the measured duration to a tenth (thresholds cut a little off) on the
    // thick pads, which stay linear. The thin ones stiffen: the law misses their
    // force by many times its noise, which must be said.
    let linear = |impact: &&ImpactOutcome| impact.law == "kelvin-voigt";
    for impact in outcome.impacts.iter().filter(linear) {
        let k = impact.parameters.get("k").unwrap().value;
        let duration = impact.derived.get("contact_duration").unwrap().unwrap();
        let ratio = duration / (std::f64::consts::PI * (mass.value / k).sqrt());
        let misfit = impact
            .findings
            .iter()
            .any(|finding| finding.code == "misfit");
        let thick = impact.specimen == "pad-40";
        assert!(
            if thick {
                (ratio - 1.0).abs() < 0.1
            } else {
                misfit
            },
            "{}: {ratio}",
            impact.id
        );
    }
}
