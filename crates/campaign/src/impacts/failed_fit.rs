//! What is told of an impact that was cut out of its recording but could not be fitted.

use crate::result::fit_outcome::told;
use std::error::Error as _;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::text::number::plain;
use windfall_identify::error::Error as IdentifyError;
use windfall_signal::Finding;
use windfall_signal::impact::Impact;

/// The contact, and the findings on the signals.
pub fn found_before(impact: &Impact, findings: &[Finding]) -> Vec<FindingOutcome> {
    let message = format!(
        "from {:.6} s to {:.6} s{}",
        impact.onset,
        impact.end,
        impact.measured.peak_force.map_or_else(String::new, |peak| {
            format!(", with a largest force of {} N", plain(peak))
        })
    );
    let contact = FindingOutcome::new("contact", message);
    std::iter::once(contact)
        .chain(findings.iter().map(told))
        .collect()
}

/// The message of an error; where the bodies do not separate, the likeliest cause in place of
/// the law, whose values nobody has chosen.
pub fn why_it_failed(error: &Error, impact: &Impact, findings: &[Finding]) -> String {
    let source = error.source().and_then(|own| own.downcast_ref());
    let Some(IdentifyError::EndlessContact { duration }) = source else {
        return error.to_string();
    };
    format!(
        "no impact of a free body fits: with the law that is nearest to the signals, the bodies \
         are still in contact after {duration} s. {}",
        cause(impact, findings)
    )
}

/// What makes a contact that no free body has, likeliest first.
fn cause(impact: &Impact, findings: &[Finding]) -> &'static str {
    let has = |codes: &[&str]| findings.iter().any(|own| codes.contains(&own.code()));
    if has(&["contact-at-start", "contact-at-end"]) {
        "Likeliest cause: a static load, as of something that stands, hangs or rests on the \
         sensor where the recording begins or ends. If it holds an impact as well, cut that out \
         with from_s and to_s in impacts.csv"
    } else if has(&["shaking", "ringing"]) {
        "Likeliest cause: push and pull, as by a hand or a shaker, without free flight before \
         and after. If the recording holds an impact as well, cut that out with from_s and to_s \
         in impacts.csv"
    } else if has(&["short-baseline", "local-baseline", "zero-shift"]) {
        "Likeliest cause: a zero that does not stay. Set `baseline = \"drift\"` in [contact], or \
         cut the recording with from_s and to_s in impacts.csv"
    } else if impact.measured.impact_velocity.is_none() {
        "Likeliest cause: a push without free flight before it, or a static load; else the mass, \
         or a driving acceleration, in [rig]"
    } else {
        "Likeliest cause: the mass, or a driving acceleration, in [rig]; or a push without free \
         flight before it"
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_signal::impact::Measured;

    #[test]
    fn reference_the_likeliest_cause_is_named() {
        let impact = Impact {
            displacement: None,
            rate: None,
            force: None,
            acceleration: None,
            onset: 0.0,
            end: 12.0,
            measured: Measured::default(),
        };
        let endless =
            || Error::identify("hertz", IdentifyError::EndlessContact { duration: 10.24 });
        let told = |findings: &[Finding]| why_it_failed(&endless(), &impact, findings);
        let standing = Finding::ContactAtStart { time: 0.0 };
        assert!(told(std::slice::from_ref(&standing)).contains("static load, as of something"));
        let drifting = Finding::ShortBaseline {
            channel: "F".to_owned(),
            samples: 0,
            before: 300,
        };
        assert!(told(std::slice::from_ref(&drifting)).contains("`baseline = \"drift\"`"));
        assert!(told(&[drifting, standing]).contains("static load"));
        assert!(told(&[]).contains("without free flight"));
        // Others say themselves what is wrong.
        let other = Error::identify(
            "hertz",
            IdentifyError::UnorderedTimes {
                index: 1,
                time: 0.0,
                before: 1.0,
            },
        );
        assert_eq!(why_it_failed(&other, &impact, &[]), other.to_string());
        let before = found_before(&impact, &[]);
        assert_eq!(before[0].message, "from 0.000000 s to 12.000000 s");
    }
}
