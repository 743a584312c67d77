//! How grave a finding is: which codes say that a number must not be used, which that it is to
//! be doubted, and which only tell how it came about.

use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::sync::LazyLock;

/// How grave a finding is, the gravest first.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, utoipa::ToSchema,
)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// A number must not be used: it is biased, or no estimate. An impact with such a finding does
    /// not count.
    Wrong,
    /// A number may be off, or says less than it seems to: look before you use it.
    Doubtful,
    /// Good to know; no number suffers from it.
    Note,
}

impl Severity {
    /// The word for it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Wrong => "wrong",
            Self::Doubtful => "doubtful",
            Self::Note => "note",
        }
    }

    /// Severity of the findings of a code. One that is not known here is to be doubted.
    pub fn of(code: &str) -> Self {
        known(code).unwrap_or(Self::Doubtful)
    }
}

/// Severity of the findings of a code, where the code is known.
fn known(code: &str) -> Option<Severity> {
    static KNOWN: LazyLock<HashMap<&str, Severity>> = LazyLock::new(|| {
        let lists = [
            (WRONG, Severity::Wrong),
            (DOUBTFUL, Severity::Doubtful),
            (NOTES, Severity::Note),
        ];
        let all = lists
            .iter()
            .flat_map(|(codes, own)| codes.iter().map(|code| (*code, *own)));
        all.collect()
    });
    KNOWN.get(code).copied()
}

/// Codes of findings that say: do not use the number.
#[rustfmt::skip]
const WRONG: &[&str] = &[
    // Recordings and contacts
    "no-time", "dead-channel", "time-backwards", "clipped", "illegal-transitions", "shaking",
    "contact-at-start", "gap-in-contact",
    // Fits
    "no-convergence", "at-bound", "prior-contradicted", "prior-excludes-data", "singular",
    // Which impacts count
    "impossible-restitution", "negative-absorbed-energy", "impulse-contradicts-momentum",
    "impossible-velocity", "undetermined", "contradicts-others", "bench-gain",
    // Laws and their use, populations
    "undefined-beyond", "gains-energy", "no-maximum",
    // Drops and calibration
    "no_bounce", "not_valid", "bounce_clipped", "force_scale",
    "restitution_out_of_range", "waveform-not-converged", "waveform-contradicts", "surface-off",
    "other-height-off",
    // Compressions, relaxation, taps
    "loading_reversed", "fit_not_converged", "tap_clipped",
    // Tables
    "no_convergence", "not-positive",
    // Scenes
    "variant-failed", "fell-out", "sensor-silent", "energy-account", "engine-account",
];

/// Codes of findings that say: look before you use the number.
#[rustfmt::skip]
const DOUBTFUL: &[&str] = &[
    // Recordings
    "cut-off", "assumed", "odd-file", "cell", "missing-samples", "decimal-or-thousands",
    "infinite", "spike", "irregular-sampling",
    // Contacts and channels
    "reversed", "several-contacts", "ringing", "contact-at-end", "short-baseline", "zero-shift",
    "flight-held-back", "drift-unknown", "window-from-motion", "noise-at-floor", "glitch",
    "late-channel", "motion-mismatch", "impulse-mismatch",
    "filtered", "high-threshold", "few-samples", "accelerometer-disagrees", "energy-mismatch",
    "angle-disagrees", "no-mass",
    // Fits
    "bounds-hold", "prior-outweighed", "mostly-prior", "noise-contradicted", "correlated",
    "weak-direction", "structured-residuals", "misfit", "bench-left-out", "mass-left-out",
    "open-interval", "failed-replicates", "divergences", "not-mixed",
    "intervals-asymptotic",
    // Which impacts count
    "bench-delay", "law-misfit", "bench-far", "law-velocity-trend", "order-trend", "joint-scatter",
    "time-of-day-unread", "bench-cause", "same-recording", "mean-and-median-differ",
    // Laws and their use
    "outside-card-range", "beyond-table", "does-not-rise", "force-at-touch", "pulls-beyond",
    "jumps-on-reloading",
    // Populations
    "few-fruit", "correlation-at-bound", "collinear-covariate", "not-followed", "not-normal",
    "fruit-left-out",
    // Drops and bounces
    "drop-cut-short", "drop-left-out", "odd-impact", "coarse-stopwatch", "no_second_impact",
    "force_reversed", "begins_in_contact", "ends_in_contact", "ends_in_ringing",
    "static_level_drifts", "still_ringing", "slow_sampling", "ringing_not_one_mode",
    "plate_rings_otherwise", "restitutions_disagree", "weak_rebound",
    // Calibration
    "one-of-a-family", "weakly-determined", "scatter", "outside-range", "targets-out-of-reach",
    "waveform-misfit", "waveform-drops-differ", "waveform-weak", "waveform-left-out",
    // Compressions and relaxation
    "began_in_contact", "law_misses_curve", "damping_not_told", "rate_uneven",
    "ramp_not_recorded", "ramp_long", "hold_short", "model_misses_hold", "element_not_told",
    "elements_differ",
    // Taps
    "begins_in_tap", "tap_too_short", "no_peak", "no_first_mode", "few_taps", "taps_disagree",
    "one_orientation", "taps_scatter", "faint_mode",
    // Repeated impacts
    "no-reference", "few-references", "fruit-alone", "not-tested", "fruit-differ",
    "spread-unknown", "change-then-none", "impact-alone",
    // Tables
    "missing", "ungrouped", "empty", "aliased", "whole-plots-left-out", "codes", "lack-of-fit",
    "saturated", "extrapolated", "exact-fit", "ill-conditioned", "collinear", "decides-alone",
    "influential", "outlying", "selected", "residuals", "not-estimable", "no-cross-validation",
    "not-hierarchical", "not-unique", "undesirable", "repeated-specimens", "shared-specimens",
    "unequal-variances", "index", "flat_criterion", "several_maxima", "higher_without_scatter",
    "higher_elsewhere", "profile_open", "low-resolution", "no-whole-plot-error",
    "no-error-within-plots", "blocks-not-orthogonal", "settings-merged", "not-reached",
    "over-budget", "low-coverage", "no-variance-between", "few-fruit-behind-plan", "simulations-failed",
    "no-optimum",
    // Scenes
    "law-range", "mesh-open", "mesh-branching", "mesh-winding", "bruise-range", "one-replicate",
    "law-certain", "no-room", "many-blows", "engine-classes", "engine-spread", "engine-annuli",
    "engine-rolling",
];

/// Codes of findings that tell how a number came about.
#[rustfmt::skip]
const NOTES: &[&str] = &[
    // Recordings and contacts
    "left-out", "contact", "gravity", "local-baseline", "offset-removed", "drift-removed",
    "hum-removed", "bump", "tip-mass",
    // Fits
    "prior-in-means", "priors-not-used", "held", "freed", "uncertain-mass", "uncertain-bench",
    "counted-displacement", "computed-rate", "missing-quantity", "nominal-restitution",
    // Which impacts count
    "excluded", "joint-without-repeats", "rows-left-out",
    // Laws and their use, populations
    "one-level", "answer-not-kept", "velocity-thirds", "kink-not-located",
    "unit-of-one-exponent", "one-impact-each", "no-variation", "constant-covariate", "first-law",
    // Drops and calibration
    "too-few-intervals", "zero-interval", "step-unknown", "depends-on-speed", "speeds-alike",
    "target-chosen", "no-design",
    // Compressions, relaxation, taps, repeated impacts
    "no_yield", "loading_held", "radius_unknown", "hold_ended", "doublet", "mass_unknown",
    "no-margin", "change-within-margin", "no-threshold",
    // Tables
    "not-drawn", "single", "blocks", "random-groups", "transform", "rounded-levels",
    "changed-settings", "averaged", "unpaired", "mixed-model", "no-replicates",
    "not-power-of-two", "spread-not-improved", "settings-rounded",
    // Scenes
    "mesh-sliver", "mesh-double", "changed-scene", "engine-outside",
];

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    /// The guide lists every code of the source (`reference_every_finding_is_explained`); here
    /// each of them has one severity, which the guide states too, and no other code has one.
    #[test]
    fn reference_every_code_of_the_guide_has_its_severity() {
        let guide = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../docs/guide/src/findings.md"
        );
        let guide = std::fs::read_to_string(guide).unwrap();
        let rows = guide.lines().filter_map(|line| line.strip_prefix("| `"));
        let mut codes = BTreeSet::new();
        for row in rows {
            let (code, rest) = row.split_once("` | ").unwrap();
            let told = rest.split(" | ").next().unwrap();
            assert_eq!(known(code).map(Severity::word), Some(told), "{code}");
            codes.insert(code);
        }
        let listed: Vec<&&str> = WRONG.iter().chain(DOUBTFUL).chain(NOTES).collect();
        let once: BTreeSet<&str> = listed.iter().map(|code| **code).collect();
        assert_eq!(listed.len(), once.len(), "a code is listed twice");
        assert_eq!(once, codes);
    }
}
