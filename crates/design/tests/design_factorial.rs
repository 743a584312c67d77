//! Two-level designs: orthogonal columns, aliases that are true of the columns,
//! blocks.

#![allow(clippy::unwrap_used)]

use proptest::prelude::*;
use windfall_design::catalogue::{catalogued, sizes};
use windfall_design::error::DesignError;
use windfall_design::factorial::{FactorialOptions, two_level};
use windfall_design::kind::{Design, Factor, Point};
use windfall_design::plackett_burman::plackett_burman;
use windfall_design::word::{Generator, Word, aliases, fraction_of};

fn factors(count: usize) -> Vec<Factor> {
    let name = |i: usize| Factor::between(&format!("x{i}"), "", 0.0, 1.0).unwrap();
    (0..count).map(name).collect()
}

/// X'X of intercept and main effects is n times the identity.
fn orthogonal(design: &Design) -> bool {
    let count = design.factors.len();
    let column = |run: &[f64], place: usize| if place == 0 { 1.0 } else { run[place - 1] };
    let n = design.runs.len() as f64;
    (0..=count).all(|i| {
        (0..=count).all(|j| {
            let runs = design.runs.iter();
            let sum: f64 = runs
                .map(|r| column(&r.coded, i) * column(&r.coded, j))
                .sum();
            sum == if i == j { n } else { 0.0 }
        })
    })
}

#[test]
fn closed_form_orthogonal_columns() {
    for (count, runs) in sizes() {
        let generators = catalogued(count, runs).unwrap();
        let options = FactorialOptions::default();
        let design = two_level(factors(count), &generators, &options).unwrap();
        assert_eq!(design.runs.len(), runs);
        assert!(orthogonal(&design), "{count} factors in {runs} runs");
    }
    for count in [7, 11, 19, 23, 27, 31] {
        let design = plackett_burman(factors(count), None, 0).unwrap();
        assert_eq!(design.runs.len(), count + 1);
        assert!(orthogonal(&design), "{count} factors");
    }
}

/// Blocks of a 2^(6-1) are of one size, no main effect differs between them, and
/// all points of the fraction are there once.
#[test]
fn closed_form_blocks_keep_main_effects() {
    for blocks in [2, 4, 8] {
        let options = FactorialOptions {
            blocks,
            centre: 1,
            ..Default::default()
        };
        let generators = catalogued(6, 32).unwrap();
        let design = two_level(factors(6), &generators, &options).unwrap();
        for block in 1..=blocks {
            let runs: Vec<_> = design
                .runs
                .iter()
                .filter(|run| run.block == block)
                .collect();
            assert_eq!(runs.len(), 32 / blocks + 1);
            for factor in 0..6 {
                assert_eq!(runs.iter().map(|run| run.coded[factor]).sum::<f64>(), 0.0);
            }
        }
    }
}

proptest! {
    /// Whatever the generators: effects of one chain have the same column, with
    /// their sign, and defining words are constant.
    #[test]
    fn closed_form_aliases_are_true_of_the_columns(
        words in prop::collection::vec((1_u64..32, any::<bool>()), 1..4),
    ) {
        let generators: Vec<Generator> = words
            .iter()
            .enumerate()
            .map(|(place, (letters, negative))| Generator {
                factor: 5 + place,
                word: Word { letters: *letters, negative: *negative },
            })
            .collect();
        let count = 5 + generators.len();
        // Below resolution III there is no design: that is tested elsewhere.
        let Ok(fraction) = fraction_of(&generators, count) else {
            return Ok(());
        };
        let design = two_level(factors(count), &generators, &FactorialOptions::default()).unwrap();
        prop_assert_eq!(design.runs.len(), 32);
        for run in &design.runs {
            for word in &fraction.defining {
                prop_assert_eq!(word.value(&run.coded), 1.0);
            }
        }
        let chains = aliases(&fraction, 3);
        for chain in &chains {
            for run in &design.runs {
                for alias in &chain.aliases {
                    prop_assert_eq!(alias.value(&run.coded), chain.effect.value(&run.coded));
                }
            }
        }
        // No two chains have the same column, so no alias is missed.
        let product = |a: Word, b: Word| -> f64 {
            design.runs.iter().map(|r| a.value(&r.coded) * b.value(&r.coded)).sum()
        };
        for (place, first) in chains.iter().enumerate() {
            for second in &chains[place + 1..] {
                prop_assert_eq!(product(first.effect, second.effect), 0.0);
            }
        }
        // Nor is one that stands in no chain.
        let chained = |letters: u64| {
            let words = chains.iter().flat_map(|chain| chain.aliases.iter().chain([&chain.effect]));
            words.into_iter().any(|word| word.letters == letters)
        };
        for letters in (0..count).flat_map(|a| (a..count).map(move |b| 1 << a | 1_u64 << b)) {
            for chain in chains.iter().filter(|_| !chained(letters)) {
                let effect = Word { letters, negative: false };
                prop_assert_eq!(product(effect, chain.effect), 0.0);
            }
        }
    }
}

/// The centre of numbers is met at each combination of categories, in each block.
#[test]
fn closed_form_centres_of_every_category() {
    let names = |names: &[&str]| -> Vec<String> { names.iter().map(|n| n.to_string()).collect() };
    let factors = vec![
        Factor::between("v", "m/s", 0.3, 0.6).unwrap(),
        Factor::of_categories("variety", &names(&["Fuji", "Gala"])).unwrap(),
        Factor::between("R", "mm", 25.0, 40.0).unwrap(),
        Factor::of_categories("pad", &names(&["none", "foam"])).unwrap(),
    ];
    let options = FactorialOptions {
        centre: 2,
        blocks: 2,
        ..Default::default()
    };
    let design = two_level(factors, &[], &options).unwrap();
    assert_eq!(design.runs.len(), 16 + 2 * 2 * 4);
    for block in [1, 2] {
        for categories in [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]] {
            let own = design.runs.iter().filter(|run| {
                let same = [run.coded[1], run.coded[3]] == categories;
                run.block == block && same && run.point == Point::Centre
            });
            let own: Vec<_> = own.collect();
            assert_eq!(own.len(), 2);
            assert!(
                own.iter()
                    .all(|run| (run.coded[0], run.coded[2]) == (0.0, 0.0))
            );
        }
    }
    let alone = vec![Factor::of_categories("pad", &names(&["none", "foam"])).unwrap()];
    let error = two_level(
        alone,
        &[],
        &FactorialOptions {
            centre: 1,
            ..Default::default()
        },
    );
    assert!(matches!(error, Err(DesignError::Categories { .. })));
}
