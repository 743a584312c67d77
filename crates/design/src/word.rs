//! Products of two-level factors: generators, defining relation, aliases.
//!
//! Factors are A, B, C … without I, the identity; after Z follow a, b, c … without i.

use crate::error::DesignError;
use std::collections::BTreeMap;
use std::fmt;

/// Most factors that have a letter.
pub const MOST_LETTERS: usize = 50;

/// Most generators: the defining relation has 2^p − 1 words.
pub const MOST_GENERATORS: usize = 16;

const LETTERS: &[u8; MOST_LETTERS] = b"ABCDEFGHJKLMNOPQRSTUVWXYZabcdefghjklmnopqrstuvwxyz";

/// Letter of a factor; '?' beyond [`MOST_LETTERS`].
pub fn letter(factor: usize) -> char {
    LETTERS.get(factor).map_or('?', |byte| char::from(*byte))
}

/// A product of factors with its sign.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Word {
    /// One bit per factor, the lowest for A.
    pub letters: u64,
    /// Whether the product is taken with a minus.
    pub negative: bool,
}

impl Word {
    /// The positive product of some factors.
    pub fn of(letters: u64) -> Self {
        Self {
            letters,
            negative: false,
        }
    }

    /// The product of two words; squares of factors are 1.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        Self {
            letters: self.letters ^ other.letters,
            negative: self.negative ^ other.negative,
        }
    }

    /// Number of letters.
    pub fn length(self) -> usize {
        self.letters.count_ones() as usize
    }

    /// Value at a point of ±1 levels.
    pub fn value(self, coded: &[f64]) -> f64 {
        let factors = coded.iter().enumerate();
        let product: f64 = factors
            .filter(|(place, _)| self.letters >> place & 1 == 1)
            .map(|(_, value)| value)
            .product();
        if self.negative { -product } else { product }
    }

    /// Order of words: shorter first, then by the alphabet.
    fn rank(self) -> (usize, u64) {
        (self.length(), self.letters.reverse_bits() ^ u64::MAX)
    }
}

impl fmt::Display for Word {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.negative {
            f.write_str("-")?;
        }
        if self.letters == 0 {
            return f.write_str("I");
        }
        (0..64)
            .filter(|place| self.letters >> place & 1 == 1)
            .try_for_each(|place| write!(f, "{}", letter(place)))
    }
}

/// A factor that is set to a product of others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Generator {
    /// The factor.
    pub factor: usize,
    /// The product.
    pub word: Word,
}

impl fmt::Display for Generator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", letter(self.factor), self.word)
    }
}

/// Generators and what follows from them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fraction {
    /// Number of factors, k.
    pub factors: usize,
    /// The generators, p; none for the full factorial.
    pub generators: Vec<Generator>,
    /// Words that equal I, all 2^p − 1, shortest first.
    pub defining: Vec<Word>,
}

impl Fraction {
    /// Length of the shortest defining word; `None` for the full factorial.
    pub fn resolution(&self) -> Option<usize> {
        self.defining.first().map(|word| word.length())
    }

    /// Number of runs, 2^(k − p).
    pub fn runs(&self) -> f64 {
        2_f64.powi(self.factors as i32 - self.generators.len() as i32)
    }

    /// Factors that are not generated.
    pub fn base(&self) -> Vec<usize> {
        let generated = |factor: &usize| self.generators.iter().any(|g| g.factor == *factor);
        (0..self.factors).filter(|f| !generated(f)).collect()
    }

    /// A word written with base factors only.
    pub fn in_base(&self, word: Word) -> Word {
        let involved = self.generators.iter();
        let involved = involved.filter(|g| word.letters >> g.factor & 1 == 1);
        let own = |g: &Generator| Word::of(1 << g.factor);
        involved.fold(word, |word, g| word.times(own(g)).times(g.word))
    }
}

/// An effect and what cannot be told from it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AliasChain {
    /// The effect of lowest order; I for what is constant.
    pub effect: Word,
    /// The others, with the sign they are aliased with.
    pub aliases: Vec<Word>,
}

impl fmt::Display for AliasChain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.effect)?;
        self.aliases
            .iter()
            .try_for_each(|word| write!(f, " = {word}"))
    }
}

/// Reads a generator, such as `D=ABC` or `E=-AB`.
pub fn parse_generator(text: &str, names: &[&str]) -> Result<Generator, DesignError> {
    let owned = || text.trim().to_owned();
    let syntax = || DesignError::GeneratorSyntax { text: owned() };
    let place = |letter: char| {
        let found = (0..names.len().min(MOST_LETTERS)).find(|f| self::letter(*f) == letter);
        found.ok_or_else(|| DesignError::GeneratorLetter {
            text: owned(),
            letter,
            known: known_letters(names),
        })
    };
    let (left, right) = text.split_once('=').ok_or_else(syntax)?;
    let mut left = left.trim().chars();
    let (Some(factor), None) = (left.next(), left.next()) else {
        return Err(syntax());
    };
    let factor = place(factor)?;
    let right = right.trim();
    let unsigned = right.trim_start_matches(['-', '+', '−']);
    let sign: &str = &right[..right.len() - unsigned.len()];
    let negative = matches!(sign, "-" | "−");
    if sign.chars().count() > 1 || unsigned.is_empty() {
        return Err(syntax());
    }
    let mut word = Word {
        letters: 0,
        negative,
    };
    for letter in unsigned.chars().filter(|c| !matches!(c, ' ' | '*')) {
        if !letter.is_ascii_alphabetic() {
            return Err(syntax());
        }
        let bit = 1 << place(letter)?;
        if word.letters & bit != 0 {
            return Err(DesignError::GeneratorRepeats {
                text: owned(),
                letter,
            });
        }
        word.letters |= bit;
    }
    Ok(Generator { factor, word })
}

/// "A (k), B (e)".
fn known_letters(names: &[&str]) -> String {
    let known = names.iter().enumerate();
    let known = known.map(|(place, name)| format!("{} ({name})", letter(place)));
    known.collect::<Vec<_>>().join(", ")
}

/// What follows from generators.
///
/// # Errors
/// [`DesignError::GeneratorChain`], [`DesignError::GeneratorsTooMany`];
/// [`DesignError::FactorsAliased`] below resolution III.
pub fn fraction_of(generators: &[Generator], factors: usize) -> Result<Fraction, DesignError> {
    if factors > MOST_LETTERS {
        let (kind, most, found) = ("two-level", MOST_LETTERS, factors);
        return Err(DesignError::FactorsTooMany { kind, most, found });
    }
    if generators.len() > MOST_GENERATORS {
        return Err(DesignError::GeneratorsTooMany {
            generators: generators.len(),
            most: MOST_GENERATORS,
        });
    }
    check_chain(generators)?;
    // All products of the words that are I.
    let mut defining = vec![Word::default()];
    for generator in generators {
        let word = Word::of(1 << generator.factor).times(generator.word);
        let more: Vec<Word> = defining.iter().map(|known| known.times(word)).collect();
        defining.extend(more);
    }
    defining.remove(0);
    defining.sort_by_key(|word| word.rank());
    if let Some(word) = defining.first().filter(|word| word.length() < 3) {
        return Err(DesignError::FactorsAliased {
            word: word.to_string(),
            resolution: word.length(),
        });
    }
    Ok(Fraction {
        factors,
        generators: generators.to_vec(),
        defining,
    })
}

fn check_chain(generators: &[Generator]) -> Result<(), DesignError> {
    let mut generated = 0_u64;
    let chain = |generator: &Generator, factor: usize| DesignError::GeneratorChain {
        text: generator.to_string(),
        letter: letter(factor),
    };
    for generator in generators {
        let bit = 1 << generator.factor;
        if generated & bit != 0 {
            return Err(chain(generator, generator.factor));
        }
        generated |= bit;
    }
    for generator in generators {
        let wrong = generator.word.letters & generated;
        if wrong != 0 {
            return Err(chain(generator, wrong.trailing_zeros() as usize));
        }
    }
    Ok(())
}

/// Chains of two or more aliased effects of up to `order` factors.
pub fn aliases(fraction: &Fraction, order: usize) -> Vec<AliasChain> {
    // Effects with the same column in base factors are aliased.
    let mut columns: BTreeMap<u64, Vec<Word>> = BTreeMap::new();
    let mut effects = vec![Word::default()];
    extend_effects(&mut effects, fraction.factors, order);
    effects.sort_by_key(|word| word.rank());
    for effect in effects {
        let column = fraction.in_base(effect);
        let signed = Word {
            letters: effect.letters,
            negative: column.negative,
        };
        columns.entry(column.letters).or_default().push(signed);
    }
    let mut chains: Vec<AliasChain> = columns
        .into_values()
        .filter(|words| words.len() > 1)
        .map(|words| chain_of(&words))
        .collect();
    chains.sort_by_key(|chain| chain.effect.rank());
    chains
}

/// The first word without sign; the others with the sign relative to it.
fn chain_of(words: &[Word]) -> AliasChain {
    let first = words[0];
    let relative = |word: &Word| Word {
        letters: word.letters,
        negative: word.negative ^ first.negative,
    };
    AliasChain {
        effect: relative(&first),
        aliases: words[1..].iter().map(relative).collect(),
    }
}

/// Adds all effects of 1 to `order` factors.
fn extend_effects(effects: &mut Vec<Word>, factors: usize, order: usize) {
    let mut last: Vec<(u64, usize)> = vec![(0, 0)];
    for _ in 0..order.min(factors) {
        let longer = last.iter().flat_map(|&(letters, next)| {
            (next..factors).map(move |factor| (letters | 1 << factor, factor + 1))
        });
        last = longer.collect();
        let words = last.iter().map(|&(letters, _)| Word {
            letters,
            negative: false,
        });
        effects.extend(words);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMES: [&str; 7] = ["a", "b", "c", "d", "e", "f", "g"];

    fn fraction(texts: &[&str], factors: usize) -> Fraction {
        let generators: Vec<Generator> = texts
            .iter()
            .map(|text| parse_generator(text, &NAMES[..factors]).unwrap())
            .collect();
        fraction_of(&generators, factors).unwrap()
    }

    fn words<T: ToString>(items: &[T]) -> Vec<String> {
        items.iter().map(T::to_string).collect()
    }

    /// Montgomery, Design and Analysis of Experiments, section 8.3: the quarter
    /// of five factors with D = AB, E = AC.
    #[test]
    fn reference_quarter_of_five_factors() {
        let found = fraction(&["D=AB", "E=AC"], 5);
        assert_eq!(words(&found.defining), ["ABD", "ACE", "BCDE"]);
        assert_eq!((found.resolution(), found.runs()), (Some(3), 8.0));
        assert_eq!(
            words(&aliases(&found, 2)),
            [
                "A = BD = CE",
                "B = AD",
                "C = AE",
                "D = AB",
                "E = AC",
                "BC = DE",
                "BE = CD"
            ]
        );
    }

    /// The saturated sixteenth of seven factors (Montgomery, section 8.5): each
    /// main effect is aliased with three two-factor interactions.
    #[test]
    fn reference_sixteenth_of_seven_factors() {
        let found = fraction(&["D=AB", "E=AC", "F=BC", "G=ABC"], 7);
        assert_eq!(found.defining.len(), 15);
        let of_length = |n: usize| found.defining.iter().filter(|w| w.length() == n).count();
        assert_eq!((3..8).map(of_length).collect::<Vec<_>>(), [7, 7, 0, 0, 1]);
        let chains = words(&aliases(&found, 2));
        assert_eq!(chains[0], "A = BD = CE = FG");
        assert_eq!(chains[6], "G = AF = BE = CD");
        assert_eq!(chains.len(), 7);
    }

    /// Signs: with D = −ABC, D is aliased with −ABC and AB with −CD.
    #[test]
    fn closed_form_signs_of_the_other_half() {
        let found = fraction(&["D = -ABC"], 4);
        assert_eq!(words(&found.defining), ["-ABCD"]);
        let chains = words(&aliases(&found, 3));
        assert_eq!(chains[0], "A = -BCD");
        assert_eq!(chains[4], "AB = -CD");
    }

    #[test]
    fn closed_form_letters_leave_out_i() {
        assert_eq!((letter(7), letter(8), letter(24)), ('H', 'J', 'Z'));
        assert_eq!((letter(25), letter(49)), ('a', 'z'));
        assert!((0..MOST_LETTERS).all(|f| !matches!(letter(f), 'I' | 'i')));
    }

    #[test]
    fn rejects_generators_that_make_no_fraction() {
        let parse = |text: &str| parse_generator(text, &NAMES[..4]);
        for text in ["D", "D=", "DE=AB", "D=--AB", "D=A+B", "=AB"] {
            let error = parse(text).unwrap_err();
            assert_eq!(error, DesignError::GeneratorSyntax { text: text.into() });
        }
        for (text, letter) in [("E=AB", 'E'), ("D=AE", 'E'), ("D=AI", 'I')] {
            let found = parse(text).unwrap_err();
            assert!(matches!(found, DesignError::GeneratorLetter { letter: l, .. } if l == letter));
        }
        let twice = parse("D=ABA").unwrap_err();
        assert!(matches!(
            twice,
            DesignError::GeneratorRepeats { letter: 'A', .. }
        ));
        let make = |texts: &[&str]| {
            let generators: Vec<_> = texts.iter().map(|text| parse(text).unwrap()).collect();
            fraction_of(&generators, 4).unwrap_err()
        };
        assert!(matches!(
            make(&["D=AB", "D=AC"]),
            DesignError::GeneratorChain { letter: 'D', .. }
        ));
        assert!(matches!(
            make(&["D=AD"]),
            DesignError::GeneratorChain { letter: 'D', .. }
        ));
        assert!(matches!(
            make(&["C=AB", "D=AC"]),
            DesignError::GeneratorChain { letter: 'C', .. }
        ));
        assert!(matches!(
            make(&["D=A"]),
            DesignError::FactorsAliased { resolution: 2, .. }
        ));
        assert!(matches!(
            make(&["C=AB", "D=AB"]),
            DesignError::FactorsAliased { resolution: 2, .. }
        ));
    }
}
