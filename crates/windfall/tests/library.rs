//! Published values and models that come with windfall.

#![allow(clippy::unwrap_used)]

use windfall_cards::library::show::{LibraryRequest, show_library};
use windfall_cards::library::values::library;
use windfall_contact::expression::parse_law;

fn ask(name: &str, at: &str) -> LibraryRequest {
    LibraryRequest {
        name: Some(name.to_owned()),
        at: Some(at.to_owned()),
        ..LibraryRequest::default()
    }
}

/// Expected: the equations of the apple study's Table 3, evaluated apart from
/// windfall in double precision.
#[test]
fn reference_regressions_of_the_apple_study() {
    let places = [
        "V=0.1 m/s, R=31 mm, t=6 ms",
        "V=0.34, R=0.05, t=0.006",
        "V=0.7 m/s, R=70 mm, t=4 ms",
    ];
    let expected = [
        (
            "golden-delicious-regression",
            [881407.7356476, 812712.562592, 631512.6979040002],
            [2460.9505637, 2171.074317, 916.2492550000002],
        ),
        (
            "red-delicious-regression",
            [1061565.2140000002, 975799.2796, 772909.778],
            [2993.6132831, 2694.43942764, 1398.5074697999999],
        ),
    ];
    for (name, k, c) in expected {
        for (place, (k, c)) in places.iter().zip(k.into_iter().zip(c)) {
            let outcome = show_library(&ask(name, place)).unwrap();
            let evaluated = &outcome.evaluated[0];
            for (found, expected) in evaluated.values.iter().zip([k, c]) {
                let error = (found.value / expected - 1.0).abs();
                assert!(error < 1e-10, "{name} {place} {}: {error:e}", found.name);
            }
            assert!(evaluated.warnings.is_empty(), "{evaluated:?}");
            let law = parse_law(evaluated.law.as_ref().unwrap()).unwrap();
            assert!(law.complete().is_ok());
        }
    }
}

/// Every entry has source, place and values or models; names are unique; every
/// law is complete and has the values that stand beside it.
#[test]
fn closed_form_entries_are_whole() {
    let entries = library().unwrap();
    let mut names: Vec<&str> = entries.iter().map(|entry| entry.name.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), entries.len());
    for entry in &entries {
        let name = &entry.name;
        assert!(
            !entry.citation.is_empty() && !entry.place.is_empty(),
            "{name}"
        );
        assert!(
            ["full text", "abstract"].contains(&entry.seen.as_str()),
            "{name}"
        );
        assert!(entry.values.is_empty() != entry.models.is_empty(), "{name}");
        let Some(law) = &entry.law else { continue };
        let law = parse_law(law).unwrap();
        if !entry.models.is_empty() {
            continue;
        }
        law.complete().unwrap();
        let parameters = law.kind.describe().parameters;
        for value in &entry.values {
            let place = parameters.iter().position(|p| p.name == value.quantity);
            let held = law.values[place.unwrap()].unwrap();
            assert_eq!(held, value.value, "{name} {}", value.quantity);
        }
    }
}

/// 0.868 N mm^-1.91 is 0.868 × 1000^1.91 N m^-1.91.
#[test]
fn closed_form_values_are_si() {
    let entries = library().unwrap();
    let cherry = entries.iter().find(|e| e.name == "cerasus-humilis-2023");
    let k = &cherry.unwrap().values[0];
    assert!((k.value / 466143.5992 - 1.0).abs() < 1e-9, "{}", k.value);
    let golden = entries.iter().find(|e| e.name == "golden-delicious-mean");
    let k = &golden.unwrap().values[0];
    assert!((k.deviation.unwrap() / (0.26 * 899166.2) - 1.0).abs() < 1e-12);
    assert_eq!(k.unit, "N/m^1.5");
}

#[test]
fn rejects_what_is_not_in_the_library() {
    let of = |request: &LibraryRequest| show_library(request).unwrap_err().to_string();
    let name = "red-delicious-regression";
    for (request, expected) in [
        (
            LibraryRequest {
                name: Some("jonagold-203".to_owned()),
                ..LibraryRequest::default()
            },
            "did you mean",
        ),
        (
            LibraryRequest {
                fruit: Some("durian".to_owned()),
                ..LibraryRequest::default()
            },
            "nothing is known of \"durian\"; bodies: Cerasus humilis, apple",
        ),
        (
            ask(name, "V=0.3, R=50 mm"),
            "also needs t (contact time, s)",
        ),
        (
            ask(name, "V=0.3 s, R=50 mm, t=5 ms"),
            "a velocity in m/s was expected",
        ),
        (
            ask(name, "V=0.3, V=0.4, R=50 mm, t=5 ms"),
            "V is given twice",
        ),
        (ask(name, "V=0.3, r=50 mm, t=5 ms"), "no variable \"r\""),
        (ask(name, "V"), "expected NAME=VALUE"),
        (
            ask("jonagold-2003", "V=0.3"),
            "none of these entries is a regression",
        ),
    ] {
        let message = of(&request);
        assert!(message.contains(expected), "{message}");
    }
}

/// Outside what was measured the equations give nonsense, and this is said.
#[test]
fn rejects_a_negative_damping_as_a_law() {
    let request = ask("red-delicious-regression", "V=0.9, R=0.05, t=0.001");
    let outcome = show_library(&request).unwrap();
    let evaluated = &outcome.evaluated[0];
    assert_eq!(evaluated.law, None);
    assert_eq!(evaluated.warnings.len(), 3, "{:?}", evaluated.warnings);
}
