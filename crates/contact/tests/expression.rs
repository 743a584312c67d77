//! Law expressions and the registry: what is read, and what is said about what
//! cannot be.

use windfall_contact::error::Error;
use windfall_contact::expression::{LawExpression, parse_law, typical};
use windfall_contact::laws::kind::LawKind;
use windfall_numerics::unit::quantity::parse_unit;

/// Byte offset in the expression of what is wrong, if it has a place.
fn offset_of(error: &Error) -> Option<usize> {
    match error {
        Error::UnknownLaw { place, .. } | Error::OutOfBounds { place, .. } => {
            place.as_ref().map(|place| place.offset)
        }
        Error::UnknownParameter { place, .. }
        | Error::RepeatedParameter { place, .. }
        | Error::BadValue { place, .. }
        | Error::UnknownExponent { place, .. }
        | Error::Syntax { place, .. } => Some(place.offset),
        _ => None,
    }
}

/// The names and parameters of the design, which scripts rely on.
#[test]
fn reference_names_of_the_design() {
    let design = [
        ("hertz", "k"),
        ("kelvin-voigt", "k c"),
        ("kuwabara-kono", "k c"),
        ("power-law", "k n c p"),
        ("hunt-crossley", "k lambda n"),
        ("lankarani-nikravesh", "k n restitution impact_velocity"),
        ("flores", "k n restitution impact_velocity"),
        ("herbert-mcwhannell", "k n restitution impact_velocity"),
        ("tsuji", "k restitution mass"),
        ("adams-impact", "k e c d"),
        ("walton-braun", "k1 k2"),
        ("thornton", "E_star R_star yield_pressure"),
    ];
    assert_eq!(design.len(), LawKind::ALL.len());
    for (kind, (name, parameters)) in LawKind::ALL.into_iter().zip(design) {
        let names: Vec<_> = kind.describe().parameters.iter().map(|p| p.name).collect();
        assert_eq!((kind.name(), names.join(" ").as_str()), (name, parameters));
    }
}

/// Every description is complete, every unit can be read and fits the formula's
/// exponents, and every typical value is within its bounds.
#[test]
fn reference_descriptions_are_complete() {
    for kind in LawKind::ALL {
        let about = kind.describe();
        for text in [about.formula, about.first_touch, about.source] {
            assert!(text.len() > 10, "{}: {text:?}", about.name);
        }
        let law = typical(kind).complete().unwrap();
        for (index, parameter) in about.parameters.iter().enumerate() {
            assert!(!parameter.meaning.is_empty());
            assert!(parameter.lower < parameter.typical && parameter.typical < parameter.upper);
            assert!(
                parse_unit(&law.unit_of(index)).is_ok(),
                "{}",
                law.unit_of(index)
            );
        }
    }
}

#[test]
fn closed_form_values_with_units() {
    let cases: [(&str, &str); 14] = [
        (
            "adams-impact(k=\"0.868 N/mm^1.91\", e=1.91, c=\"5.56e-4 N s/mm\", d=\"0.001 mm\")",
            "adams-impact(k=466143.59924937907, e=1.91, c=0.556, d=1e-6)",
        ),
        (
            "kuwabara-kono(k=753599, c=1524)",
            "kuwabara-kono(k=753599, c=1524)",
        ),
        ("kuwabara-kono", "kuwabara-kono"),
        ("kuwabara-kono()", "kuwabara-kono"),
        (" Kuwabara_Kono ( c = 1524 , ) ", "kuwabara-kono(c=1524)"),
        ("HERTZ(k='24 N/mm^1.5')", "hertz(k=758946.6384404111)"),
        ("hertz(k=2 N/(m m^0.5))", "hertz(k=2)"),
        (
            "hunt-crossley(lambda=\"2 N s/m^3\", n=2)",
            "hunt-crossley(lambda=2, n=2)",
        ),
        (
            "hunt-crossley(lambda=\"2 N s/m^2.5\")",
            "hunt-crossley(lambda=2)",
        ),
        (
            "power-law(p=0.25, c=\"3 N s/m^1.25\")",
            "power-law(c=3, p=0.25)",
        ),
        (
            "flores(restitution=\"70 %\", impact_velocity=\"50 cm/s\")",
            "flores(restitution=0.7, impact_velocity=0.5)",
        ),
        ("tsuji(mass=\"200 g\")", "tsuji(mass=0.2)"),
        ("adams-impact(k=5)", "adams-impact(k=5)"),
        (
            "thornton(e_star=\"5 MPa\", R_star=\"4 cm\", yield_pressure=\"3 bar\")",
            "thornton(E_star=5000000, R_star=0.04, yield_pressure=300000)",
        ),
    ];
    for (text, expected) in cases {
        let law = parse_law(text).unwrap_or_else(|error| panic!("{error}"));
        let expected = parse_law(expected).unwrap();
        assert_eq!(law.kind, expected.kind, "{text}");
        for (value, expected) in law.values.iter().zip(&expected.values) {
            let (value, expected) = (value.unwrap_or(-1.0), expected.unwrap_or(-1.0));
            assert!(
                (value - expected).abs() <= 1e-15 * expected.abs(),
                "{text}: {value}"
            );
        }
    }
}

#[test]
fn closed_form_defaults_of_exponents() {
    let law = parse_law("power-law(k=2, c=3)").unwrap();
    assert_eq!(law.values, [Some(2.0), None, Some(3.0), None]);
    assert_eq!(law.complete().unwrap().parameters(), [2.0, 1.5, 3.0, 0.5]);
    let units: Vec<_> = (0..4).map(|i| law.complete().unwrap().unit_of(i)).collect();
    assert_eq!(units, ["N/m^1.5", "1", "N s/m^1.5", "1"]);
    let adams = parse_law("adams-impact(k=2, e=1.91, c=1, d=1e-3)").unwrap();
    assert_eq!(adams.complete().unwrap().unit_of(0), "N/m^1.91");
    let hunt = parse_law("hunt-crossley(k=2, lambda=1, n=1.91)").unwrap();
    assert_eq!(hunt.complete().unwrap().unit_of(1), "N s/m^2.91");
    assert_eq!(LawKind::AdamsImpact.describe().unit_of(0, &[]), None);
}

/// What is printed reads back to the same bits.
#[test]
fn repeats_through_text() {
    let numbers: [f64; 7] = [
        1e-9,
        1.0 / 3.0,
        0.1,
        753_599.0,
        1e12,
        123_456_789.123_456_78,
        1e30,
    ];
    for kind in LawKind::ALL {
        let parameters = kind.describe().parameters;
        for (turn, _) in numbers.iter().enumerate() {
            let values = parameters.iter().enumerate().map(|(index, parameter)| {
                let number = numbers[(turn + index) % numbers.len()];
                let given = (turn + index) % 3 != 0;
                given.then(|| number.clamp(parameter.lower, parameter.upper))
            });
            let law = LawExpression {
                kind,
                values: values.collect(),
            };
            assert_eq!(parse_law(&law.to_string()).unwrap(), law, "{law}");
        }
        let law = typical(kind).complete().unwrap();
        assert_eq!(LawExpression::from(law), typical(kind));
    }
}

#[test]
fn rejects_with_a_message_that_says_what_to_do() {
    let cases = [
        (
            "herz(k=1)",
            0,
            "unknown law \"herz\" (column 1 of `herz(k=1)`): did you mean hertz?",
        ),
        (
            "kuwabara-cono",
            0,
            "unknown law \"kuwabara-cono\" (column 1 of `kuwabara-cono`): did you mean kuwabara-kono?",
        ),
        (
            "spring(k=1)",
            0,
            "unknown law \"spring\" (column 1 of `spring(k=1)`): the laws are hertz, kelvin-voigt, kuwabara-kono, power-law, hunt-crossley, lankarani-nikravesh, flores, herbert-mcwhannell, tsuji, adams-impact, walton-braun, thornton",
        ),
        (
            "kuwabara-kono(k=1, d=2)",
            19,
            "kuwabara-kono has no parameter \"d\" (column 20 of `kuwabara-kono(k=1, d=2)`): its parameters are k, c",
        ),
        (
            "flores(restitucion=0.5)",
            7,
            "flores has no parameter \"restitucion\" (column 8 of `flores(restitucion=0.5)`): did you mean restitution?",
        ),
        (
            "hertz(k=1, K=2)",
            11,
            "parameter \"k\" of hertz is given twice (column 12 of `hertz(k=1, K=2)`): give it once",
        ),
        (
            "hertz(k=\"3 mm\")",
            9,
            "parameter \"k\" of hertz (column 10 of `hertz(k=\"3 mm\")`): \"3 mm\" is a length (m), but a stiffness in N/m^1.5 was expected: write it like \"1 N/m^1.5\"",
        ),
        (
            "adams-impact(e=1.91, k='0.868 N/mm^1.5')",
            24,
            "parameter \"k\" of adams-impact (column 25 of `adams-impact(e=1.91, k='0.868 N/mm^1.5')`): \"0.868 N/mm^1.5\" is a stiffness (m^-0.5 kg s^-2), but a stiffness in N/m^1.91 was expected: write it like \"1 N/m^1.91\"",
        ),
        (
            "hertz(k=3 Nmm)",
            8,
            "parameter \"k\" of hertz (column 9 of `hertz(k=3 Nmm)`): unknown unit \"Nmm\" in \"3 Nmm\": did you mean \"N mm\" (with a space)?",
        ),
        (
            "adams-impact(k=\"0.868 N/mm^1.91\")",
            16,
            "parameter \"k\" of adams-impact is in N/m^e (column 17 of `adams-impact(k=\"0.868 N/mm^1.91\")`): give e as well",
        ),
        (
            "flores(restitution=1.2)",
            19,
            "restitution = 1.2 of flores is out of bounds (column 20 of `flores(restitution=1.2)`): it must be from 0.001 to 1",
        ),
        (
            "hertz(k=-5)",
            8,
            "k = -5 N/m^1.5 of hertz is out of bounds (column 9 of `hertz(k=-5)`): it must be from 1e-9 to 1e30 N/m^1.5",
        ),
        (
            "hertz(k=1",
            9,
            "expected \",\" or \")\" (column 10 of `hertz(k=1`): a law is written like kuwabara-kono(k=753599, c=\"1524 N s/m^1.5\")",
        ),
        (
            "hertz(k=\"1",
            10,
            "expected a closing quotation mark (column 11 of `hertz(k=\"1`): a law is written like kuwabara-kono(k=753599, c=\"1524 N s/m^1.5\")",
        ),
        (
            "hertz(753599)",
            6,
            "expected a parameter, such as k=753599, or \")\" (column 7 of `hertz(753599)`): a law is written like kuwabara-kono(k=753599, c=\"1524 N s/m^1.5\")",
        ),
        (
            "hertz(k)",
            7,
            "expected \"=\" and a value (column 8 of `hertz(k)`): a law is written like kuwabara-kono(k=753599, c=\"1524 N s/m^1.5\")",
        ),
        (
            "hertz(k=)",
            8,
            "expected a value (column 9 of `hertz(k=)`): a law is written like kuwabara-kono(k=753599, c=\"1524 N s/m^1.5\")",
        ),
        (
            "hertz(k=1) + 2",
            11,
            "expected the end of the expression (column 12 of `hertz(k=1) + 2`): a law is written like kuwabara-kono(k=753599, c=\"1524 N s/m^1.5\")",
        ),
        (
            "hertz k=1",
            6,
            "expected \"(\" or the end of the expression (column 7 of `hertz k=1`): a law is written like kuwabara-kono(k=753599, c=\"1524 N s/m^1.5\")",
        ),
        (
            "",
            0,
            "expected the name of a law (column 1 of ``): a law is written like kuwabara-kono(k=753599, c=\"1524 N s/m^1.5\")",
        ),
    ];
    for (text, offset, message) in cases {
        let error = parse_law(text).unwrap_err();
        assert_eq!(error.to_string(), message, "{text}");
        assert_eq!(offset_of(&error), Some(offset), "{text}");
    }
}

/// Columns count characters, offsets bytes.
#[test]
fn rejects_at_the_right_column_behind_other_letters() {
    let error = parse_law("hertz(k=\"5 N·m^-1.5\", µ=1)").unwrap_err();
    assert!(error.to_string().contains("(column 23 of"), "{error}");
    assert_eq!(offset_of(&error), Some(23));
}

#[test]
fn rejects_incomplete_and_impossible_laws() {
    let complete = |text: &str| parse_law(text).unwrap().complete().unwrap_err().to_string();
    assert_eq!(
        complete("flores(k=2)"),
        "flores needs restitution and impact_velocity: write it like flores(k=753599, n=1.5, restitution=0.5, impact_velocity=0.5)"
    );
    assert_eq!(
        complete("walton-braun(k1=2, k2=1)"),
        "walton-braun with k1 = 2 N/m and k2 = 1 N/m would return more energy than it got: k2 must be at least k1"
    );
    assert_eq!(
        LawKind::Tsuji
            .with_parameters(&[1.0, 0.5])
            .unwrap_err()
            .to_string(),
        "tsuji takes 3 parameters (k, restitution, mass) but was given 2"
    );
    assert!(LawKind::Hertz.with_parameters(&[]).is_err());
    assert!(LawKind::Hertz.with_parameters(&[1.0, 2.0]).is_err());
    for value in [f64::NAN, f64::INFINITY, -1.0, 0.0] {
        assert!(LawKind::Hertz.with_parameters(&[value]).is_err(), "{value}");
    }
}

/// No text may make the reader panic.
#[test]
fn rejects_fragments_without_panic() {
    let whole = "flores(k='5 N/(m m^½)', n=1.5, restitution=\"70 %\", µ=ä)";
    let characters: Vec<char> = whole.chars().collect();
    for start in 0..characters.len() {
        for end in start..=characters.len() {
            let fragment: String = characters[start..end].iter().collect();
            let _ = parse_law(&fragment);
            let _ = parse_law(&format!("flores({fragment}"));
        }
    }
}
