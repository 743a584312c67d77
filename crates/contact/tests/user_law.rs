//! Laws that the user writes: against built-in laws, differences and closed
//! forms; what is refused, and in which words.

use windfall_contact::error::Error;
use windfall_contact::expression::parse_law_among;
use windfall_contact::law::{ContactForce, ContactLaw};
use windfall_contact::laws::define_law::define_law;
use windfall_contact::laws::force_table::ForceTable;
use windfall_contact::laws::kind::{Law, LawKind};
use windfall_contact::laws::user::{UserForce, UserLaw, UserLawDefinition, UserParameter};
use windfall_contact::with_law;
use windfall_numerics::real::Lanes;

/// `name unit start [default]`
pub(crate) fn parameter(text: &str) -> UserParameter {
    let mut words = text.split('|').map(str::trim);
    let mut word = || words.next().unwrap_or_default();
    let (name, unit, start, default) = (word(), word(), word(), word());
    UserParameter {
        name: name.into(),
        unit: unit.into(),
        meaning: String::new(),
        lower: 0.0,
        upper: f64::INFINITY,
        start: start.parse().ok(),
        default: default.parse().ok(),
    }
}

fn definition(formula: &str, parameters: &[&str]) -> UserLawDefinition {
    UserLawDefinition {
        name: "mine".into(),
        force: UserForce::Formula(formula.into()),
        parameters: parameters.iter().map(|text| parameter(text)).collect(),
    }
}

fn defined(formula: &str, parameters: &[&str]) -> LawKind {
    define_law(&definition(formula, parameters)).unwrap_or_else(|error| panic!("{error}"))
}

fn user(law: &Law) -> UserLaw {
    match law {
        Law::User(law) => *law,
        other => panic!("{other:?} is no user's law"),
    }
}

/// Everything a law returns: force, by d, by v, by parameters.
fn numbers<const N: usize>(law: &impl ContactLaw<N>, d: f64, v: f64) -> Vec<f64> {
    let ContactForce {
        force,
        by_displacement,
        by_rate,
        by_parameter,
        ..
    } = law.evaluate(d, v, 0.0);
    let mut all = vec![force, by_displacement, by_rate];
    all.extend(by_parameter);
    all
}

const STATES: [(f64, f64); 8] = [
    (1e-30, 0.4),
    (1e-9, 0.4),
    (1.3e-6, 0.52),
    (3.7e-5, -0.3),
    (2.1e-4, 0.01),
    (6.3e-4, -0.011),
    (1.17e-3, 0.2),
    (2.9e-3, -1.4),
];

const KUWABARA_KONO: (&str, [&str; 2]) = (
    "F = k*x^1.5 + c*sqrt(x)*v",
    ["k | N/m^1.5 | 4e5", "c | N s/m^1.5 | 600"],
);

#[test]
fn reference_the_same_numbers_as_built_in_laws() {
    let power = [
        "k | N/m^n | 4e5",
        "n | 1 | | 1.5",
        "c | N s/m^(p+1) | 600",
        "p | 1 | | 0.5",
    ];
    let cases: [(&str, &[&str], LawKind, &[f64]); 5] = [
        (
            KUWABARA_KONO.0,
            &KUWABARA_KONO.1,
            LawKind::KuwabaraKono,
            &[753_599.0, 1524.0],
        ),
        (
            "k*x^n + c*x^p*v",
            &power,
            LawKind::PowerLaw,
            &[3e5, 1.37, 900.0, 0.61],
        ),
        (
            "k*x + c*v",
            &["k | N/m | 3e4", "c | N s/m | 40"],
            LawKind::KelvinVoigt,
            &[3e4, 40.0],
        ),
        (
            "k*x^n*(1 + lambda/k*v)",
            &[
                "k | N/m^n | 4e5",
                "lambda | N s/m^(n+1) | 4e5",
                "n | 1 | | 1.5",
            ],
            LawKind::HuntCrossley,
            &[4e5, 3.1e5, 1.4],
        ),
        (
            "k*x*sqrt(x)",
            &["k | N/m^1.5 | 4e5"],
            LawKind::Hertz,
            &[2e5],
        ),
    ];
    for (formula, parameters, kind, values) in cases {
        let own = defined(formula, parameters)
            .with_parameters(values)
            .unwrap();
        let built_in = kind.with_parameters(values).unwrap();
        for (d, v) in STATES {
            let expected = with_law!(&built_in, law => numbers(law, d, v));
            let found = numbers(&user(&own), d, v);
            for (i, (found, expected)) in found.iter().zip(&expected).enumerate() {
                let error = (found - expected).abs();
                assert!(
                    error <= 1e-13 * expected.abs(),
                    "{formula} at {d}, {v}, number {i}: {found} against {expected}"
                );
            }
        }
    }
}

/// Formulas with every function, and values of their parameters.
const FORMULAS: [(&str, &[&str]); 9] = [
    (
        "k*x^1.25/(1 + x/d) + c*x^0.25*v",
        &["k|N/m^1.25|1e5", "d|m|2e-3", "c|N s/m^1.25|80"],
    ),
    (
        "k*x^2.75*exp(-x/d) + b*tanh(v/w)*x",
        &["k|N/m^2.75|3e9", "d|m|3e-3", "b|N/m|900", "w|m/s|0.2"],
    ),
    (
        "a*log(1 + x/d)*(1 + atan(v/w)/4)",
        &["a|N|50", "d|m|1e-3", "w|m/s|0.5"],
    ),
    ("k*sin(x/d) + k*cos(x/d)*x/d", &["k|N|30", "d|m|8e-3"]),
    (
        "k*tan(x/d)*(1 + 0.2*v/w)^2",
        &["k|N|30", "d|m|8e-3", "w|m/s|3"],
    ),
    (
        "k*x^1.5 + k2*max(x - d, 0)^1.3",
        &["k|N/m^1.5|1e5", "k2|N/m^1.3|2e5", "d|m|5e-4"],
    ),
    (
        "min(k*x, F0 + k2*x) + c*x*abs(v)^1.5",
        &["k|N/m|3e4", "F0|N|8", "k2|N/m|1e4", "c|N s^1.5/m^2.5|2e4"],
    ),
    (
        "k*x^1.5*(1 + a*v^2)^n - c*x^-0.25*x*v*-1",
        &[
            "k|N/m^1.5|1e5",
            "a|s^2/m^2|0.4",
            "n|1|0.3",
            "c|N s/m^1.75|80",
        ],
    ),
    ("k*(x/d)^(1 + m*x/d)", &["k|N|30", "d|m|1e-3", "m|1|0.2"]),
];

#[test]
fn derivative_of_formulas_by_every_argument() {
    for (formula, parameters) in FORMULAS {
        let kind = defined(formula, parameters);
        let count = parameters.len();
        let start: Vec<f64> = kind
            .describe()
            .parameters
            .iter()
            .map(|p| p.typical)
            .collect();
        let mut seen = vec![false; 2 + count];
        for (d, v) in &STATES[2..] {
            let mut at = vec![*d, *v];
            at.extend(&start);
            let force = |at: &[f64]| {
                kind.with_parameters(&at[2..])
                    .unwrap()
                    .force(at[0], at[1], 0.0)
            };
            let all = numbers(&user(&kind.with_parameters(&start).unwrap()), *d, *v);
            let scale = (0..at.len())
                .map(|i| (all[1 + i] * at[i]).abs())
                .fold(all[0].abs(), f64::max);
            for i in 0..at.len() {
                let step = 1e-4 * at[i].abs();
                let odd = |h: f64| {
                    let (mut up, mut down) = (at.clone(), at.clone());
                    up[i] += h;
                    down[i] -= h;
                    force(&up) - force(&down)
                };
                let numeric = (8.0 * odd(step) - odd(2.0 * step)) / (12.0 * step);
                let error = ((all[1 + i] - numeric) * at[i]).abs();
                assert!(
                    error < 2e-10 * scale,
                    "{formula} at {d}, {v}, argument {i}: {} against {numeric}",
                    all[1 + i]
                );
                seen[i] |= all[1 + i] != 0.0;
            }
            assert!((all[0] - force(&at)).abs() == 0.0);
        }
        assert!(
            seen.iter().enumerate().all(|(i, seen)| *seen || i == 1),
            "{formula}: {seen:?}"
        );
    }
}

#[test]
fn repeats_lanes_are_single_numbers() {
    for (formula, parameters) in FORMULAS {
        let kind = defined(formula, parameters);
        let start: Vec<f64> = kind
            .describe()
            .parameters
            .iter()
            .map(|p| p.typical)
            .collect();
        let law = user(&kind.with_parameters(&start).unwrap());
        let take = |from: usize| {
            let states = [0, 1, 2, 3].map(|i| STATES[from + i]);
            (Lanes(states.map(|s| s.0)), Lanes(states.map(|s| s.1)))
        };
        for from in [0, 4] {
            let (d, v) = take(from);
            let wide = law.evaluate(d, v, Lanes::splat(0.0));
            for lane in 0..4 {
                let one = law.evaluate(d.0[lane], v.0[lane], 0.0);
                assert_eq!(
                    one.force.to_bits(),
                    wide.force.0[lane].to_bits(),
                    "{formula}"
                );
                assert_eq!(
                    one.by_displacement.to_bits(),
                    wide.by_displacement.0[lane].to_bits(),
                    "{formula}"
                );
                for i in 0..parameters.len() {
                    let (one, wide) = (one.by_parameter[i], wide.by_parameter[i].0[lane]);
                    assert_eq!(one.to_bits(), wide.to_bits(), "{formula}");
                }
            }
        }
    }
}

#[test]
fn closed_form_start_powers_and_kinks() {
    let start = |formula: &str, parameters: &[&str]| {
        let kind = defined(formula, parameters);
        let values: Vec<f64> = kind
            .describe()
            .parameters
            .iter()
            .map(|p| p.typical)
            .collect();
        let law = user(&kind.with_parameters(&values).unwrap());
        (law.start_power(), law.kink())
    };
    let none = f64::INFINITY;
    assert_eq!(start("k*x + c*v", &["k|N/m|1", "c|N s/m|1"]), (1, none));
    assert_eq!(start("k*x^2", &["k|N/m^2|1"]), (1, none));
    assert_eq!(start(KUWABARA_KONO.0, &KUWABARA_KONO.1), (2, none));
    assert_eq!(
        start("k*x^1.5 + c*x^0.25*v", &["k|N/m^1.5|1", "c|N s/m^1.25|1"]),
        (4, none)
    );
    assert_eq!(start("k*x^n", &["k|N/m^n|1", "n|1|1.5"]), (2, none));
    assert_eq!(start("k*x^n", &["k|N/m^n|1", "n|1|2"]), (1, none));
    // (x²)^0.75 starts like x^1.5, the root of 1 + x is smooth.
    assert_eq!(start("k*(x*x)^0.75", &["k|N/m^1.5|1"]), (2, none));
    assert_eq!(start("k*x*sqrt(1 + x/d)", &["k|N/m|1", "d|m|1"]), (1, none));
    let kink = start(
        "k*x + k2*max(x - d, 0)",
        &["k|N/m|1", "k2|N/m|1", "d|m|3e-4"],
    );
    assert_eq!(kink, (1, 3e-4));
    let kink = start(
        "if(x < 2*d, k*x, k*x + k*(x - 2*d))",
        &["k|N/m|1", "d|m|3e-4"],
    );
    assert_eq!(kink, (1, 6e-4));
}

#[test]
fn closed_form_values_of_formulas() {
    let cases: [(&str, f64, f64, f64); 8] = [
        ("k*(2 + 3*4 - 6/3)*x", 0.5, 0.0, 6.0),
        ("k*-2^2*-x", 0.5, 0.0, 2.0),
        ("k*2^3^0.5*x", 0.5, 0.0, 3.321_997_085_484_0 / 2.0),
        ("k*max(x, min(0.25, 3))", 0.5, 0.0, 0.5),
        ("k*if(x >= 0.5, x, 0.5)", 0.5, 0.0, 0.5),
        ("k*exp(log(4)/2)*x", 0.5, 0.0, 1.0),
        ("k*abs(-x)*2e0", 0.5, 0.0, 1.0),
        ("k * cos(pi/3) *\n x", 0.5, 0.0, 0.25),
    ];
    for (formula, x, v, expected) in cases {
        // Units are those of k alone here.
        let unit = if formula.contains("0.25") || formula.contains(">=") {
            "1"
        } else {
            "k"
        };
        let formula = match unit {
            "1" => formula.replace('x', "(x/d)").replace("ma(x/d)", "max"),
            _ => formula.replace("x", "x/d").replace("ex/dp", "exp"),
        };
        let kind = defined(&formula, &["k|N|1", "d|m|1"]);
        let force = kind.with_parameters(&[1.0, 1.0]).unwrap().force(x, v, 0.0);
        assert!((force - expected).abs() < 1e-12, "{formula}: {force}");
    }
}

#[test]
fn rejects_what_is_no_law_in_the_users_terms() {
    let k = "k|N/m^1.5|4e5";
    let cases: [(&str, &[&str], &str); 26] = [
        (
            "k*x^1.5 +",
            &[k],
            "found the end (line 1, column 10 of `k*x^1.5 +`)",
        ),
        (
            "k*x^1.5 c",
            &[k],
            "expected an operator (+ - * / ^) or the end of the formula, found \"c\" (line 1, column 9",
        ),
        (
            "k*(x^1.5",
            &[k],
            "expected an operator or \")\", found the end",
        ),
        (
            "k*x^1.5\n + kk*x",
            &[k],
            "unknown name \"kk\" (line 2, column 4 of ` + kk*x`): known here are x, v, pi, k, sqrt",
        ),
        (
            "k*sqr(x)",
            &[k],
            "unknown name \"sqr\" (line 1, column 3 of `k*sqr(x)`): did you mean sqrt?",
        ),
        ("k*min(x)", &[k], "min takes 2 argument(s) but has 1"),
        (
            "k*x^1.5",
            &[k, "c|1|1"],
            "parameter \"c\" is declared but not used",
        ),
        ("k*x^1.5", &[], "the law has no parameter"),
        (
            "x*v",
            &["x|1|1"],
            "\"x\" cannot be a name here: it already has a meaning",
        ),
        (
            "k*x^1.5*K",
            &[k, "K|1|1"],
            "two parameters are called \"K\"",
        ),
        ("k*x^1.5*2a", &[k, "2a|1|1"], "begins with a letter"),
        (
            "k*x",
            &[k],
            "the term `k*x` is in N/m^0.5, where a force, N, is expected (line 1, column 1 of `k*x`): k would have to be in N/m, not N/m^1.5",
        ),
        (
            "k*x^1.5 + c*x^0.5*v",
            &[k, "c|N s/m|1"],
            "the term `c*x^0.5*v` is in N m^0.5, where a force, N, is expected (line 1, column 11 of `k*x^1.5 + c*x^0.5*v`): c would have to be in N s/m^1.5, not N s/m",
        ),
        (
            "k*x^1.5*exp(x)",
            &[k],
            "the term `x` is in m, where a plain number is expected",
        ),
        (
            "k*x^1.5*(1 + v)",
            &[k],
            "the term `v` is in m s^-1, where no unit (1), the unit of `1`, is expected",
        ),
        (
            "k*x^1.5",
            &["k|N/mm^1.5|1"],
            "the unit of parameter \"k\" is \"N/mm^1.5\": write the SI unit",
        ),
        (
            "k*x^1.5",
            &["k|N/blah|1"],
            "the unit of parameter \"k\": unknown unit \"blah\"",
        ),
        (
            "k*log(x/d)",
            &["k|N|1", "d|m|1e-3"],
            "no finite value at first touch (x = 0): `log(x/d)` is not defined (the logarithm of zero) (line 1, column 3",
        ),
        (
            "k*x^-0.5",
            &["k|N m^0.5|1"],
            "`x^-0.5` divides by zero (a negative power of zero)",
        ),
        ("c*v/x", &["c|N s|1"], "`c*v/x` divides by zero"),
        (
            "k*x^1.5 - c*sqrt(x)",
            &[k, "c|N/m^0.5|1e3"],
            "the force pulls the bodies together while loading",
        ),
        (
            "k*x^1.5*sqrt(1 - x/d)",
            &[k, "d|m|1e-4"],
            "`sqrt(1 - x/d)` is not defined (the root of a negative number) at x = ",
        ),
        (
            "if(x > d, k*x^1.5, 0.5*k*x^1.5)",
            &[k, "d|m|1e-4"],
            "the force jumps from",
        ),
        (
            "if(v > 0, k*x^1.5, 0.5*k*x^1.5)",
            &[k],
            "the force jumps from",
        ),
        (
            "k*if(x, 1, 2)",
            &[k],
            "expected a comparison (> >= < <=), found \",\"",
        ),
        ("k*x^1,5", &[k], "found \",\" (line 1, column 6"),
    ];
    for (formula, parameters, expected) in cases {
        let error = define_law(&definition(formula, parameters)).unwrap_err();
        let message = error.to_string();
        assert!(message.contains(expected), "{formula}: {message}");
        assert!(message.starts_with("law \"mine\": "), "{message}");
    }
}

#[test]
fn rejects_bounds_names_and_too_many_parameters() {
    let with = |change: &dyn Fn(&mut UserLawDefinition)| {
        let mut own = definition("k*x^1.5", &["k|N/m^1.5|4e5"]);
        change(&mut own);
        define_law(&own).unwrap_err().to_string()
    };
    let start = with(&|own| own.parameters[0].upper = 1e5);
    assert!(
        start.contains(
            "its start 400000 is outside its bounds, 0 to 100000: move the start or the bound"
        ),
        "{start}"
    );
    let empty = with(&|own| (own.parameters[0].lower, own.parameters[0].upper) = (2.0, 1.0));
    assert!(
        empty.contains("its lower bound 2 is not below its upper bound 1"),
        "{empty}"
    );
    let name = with(&|own| own.name = "Hunt_Crossley".into());
    assert!(name.contains("a built-in law has this name"), "{name}");
    let name = with(&|own| own.name = "my law".into());
    assert!(name.contains("letters, digits and - only"), "{name}");
    let many: Vec<String> = (0..7).map(|i| format!("a{i}|N/m|1")).collect();
    let sum: Vec<String> = (0..7).map(|i| format!("a{i}*x")).collect();
    let many: Vec<&str> = many.iter().map(String::as_str).collect();
    let error = define_law(&definition(&sum.join("+"), &many))
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("the law has 7 parameters; at most 6"),
        "{error}"
    );
    let deep = format!("k*x^1.5*{}1{}", "(".repeat(200), ")".repeat(200));
    let error = define_law(&definition(&deep, &["k|N/m^1.5|1"])).unwrap_err();
    assert!(error.to_string().contains("fewer parentheses"), "{error}");
    let long: Vec<String> = (0..90).map(|i| format!("sin(x/d*{i}.5)")).collect();
    let long = format!("k*x^1.5*({})", long.join("*"));
    let error = define_law(&definition(&long, &["k|N/m^1.5|1", "d|m|1"])).unwrap_err();
    assert!(matches!(error, Error::UserLaw { .. }));
}

#[test]
fn closed_form_findings() {
    let codes = |formula: &str, parameters: &[&str]| {
        let LawKind::User(kind) = defined(formula, parameters) else {
            panic!("no user's law");
        };
        kind.findings().iter().map(|f| f.code()).collect::<Vec<_>>()
    };
    assert!(codes(KUWABARA_KONO.0, &KUWABARA_KONO.1).is_empty());
    let fixed = codes("k*x^n", &["k|N/m^1.5|4e5", "n|1||1.5"]);
    assert_eq!(fixed, ["unit-of-one-exponent"]);
    assert_eq!(
        codes("k*x + F0", &["k|N/m|1e4", "F0|N|3"]),
        ["force-at-touch"]
    );
    assert_eq!(codes("c*x*v*v", &["c|N s^2/m^3|1"]), ["does-not-rise"]);
    let locking = codes("k*x/(1 - x/d)", &["k|N/m|1e4", "d|m|5e-3"]);
    assert!(locking.contains(&"pulls-beyond"), "{locking:?}");
    let rate = codes(
        "k*x^1.5*(1 + 0.1*max(v/w, 0))",
        &["k|N/m^1.5|4e5", "w|m/s|1"],
    );
    assert_eq!(rate, ["kink-not-located"]);
}

#[test]
fn repeats_equal_definitions_are_one_law() {
    let (one, two) = (
        defined(KUWABARA_KONO.0, &KUWABARA_KONO.1),
        defined(KUWABARA_KONO.0, &KUWABARA_KONO.1),
    );
    assert_eq!(one, two);
    let other = defined("k*x^1.5 + 2*c*sqrt(x)*v", &KUWABARA_KONO.1);
    assert_ne!(one, other);
    assert_ne!(format!("{one:?}"), format!("{other:?}"));
    let law = parse_law_among("Mine(k=\"1 N/mm^1.5\", c=3)", &[one]).unwrap();
    assert_eq!(law.values[0].unwrap(), 31_622.776_601_683_792);
    assert_eq!(law.to_string(), "mine(k=31622.776601683792, c=3)");
    let unknown = parse_law_among("mines(k=1)", &[one])
        .unwrap_err()
        .to_string();
    assert!(unknown.contains("did you mean mine"), "{unknown}");
    let outside = parse_law_among("mine(k=-1, c=3)", &[one])
        .unwrap_err()
        .to_string();
    assert!(outside.contains("out of bounds"), "{outside}");
}

fn table(damping: Option<Vec<f64>>) -> UserLawDefinition {
    UserLawDefinition {
        name: "curve".into(),
        force: UserForce::Table(ForceTable {
            displacement: vec![0.0, 1e-3, 2e-3, 4e-3],
            force: vec![0.0, 5.0, 14.0, 50.0],
            damping,
        }),
        parameters: Vec::new(),
    }
}

#[test]
fn reference_a_table_agrees_with_scipy() {
    // scipy.interpolate.PchipInterpolator([0, 1, 2, 4], [0, 5, 14, 50]) of SciPy 1.17.1:
    // values at 0.3, 1.5 and 3.2.
    let kind = define_law(&table(None)).unwrap();
    assert_eq!(kind.describe().parameters.len(), 1);
    let law = kind.with_parameters(&[1.0]).unwrap();
    for (x, expected) in REFERENCE {
        let force = law.force(x * 1e-3, 0.3, 0.0);
        assert!((force - expected).abs() < 1e-12 * expected, "{x}: {force}");
    }
    // Linear beyond the end, with the slope there.
    let (at, beyond) = (law.force(4e-3, 0.0, 0.0), law.force(5e-3, 0.0, 0.0));
    let slope = numbers(&user(&law), 4e-3, 0.0)[1];
    assert!((beyond - at - slope * 1e-3).abs() < 1e-12 * beyond);
    assert_eq!(user(&law).kind().table_end(), Some(4e-3));
}

/// x in mm, force in N.
const REFERENCE: [(f64, f64); 3] = [
    (0.3, 1.116),
    (1.5, 8.857_142_857_142_858),
    (3.2, 32.637_714_285_714_29),
];

#[test]
fn derivative_of_a_table_by_every_argument() {
    let kind = define_law(&table(Some(vec![2.0, 4.0, 3.0, 3.0]))).unwrap();
    let at = |d: f64, v: f64, scale: f64, damping: f64| {
        kind.with_parameters(&[scale, damping])
            .unwrap()
            .force(d, v, 0.0)
    };
    for d in [2e-4, 1.4e-3, 3.1e-3, 4.4e-3] {
        let v = -0.3;
        let all = numbers(&user(&kind.with_parameters(&[1.2, 0.7]).unwrap()), d, v);
        let odd = |f: &dyn Fn(f64) -> f64, h: f64| (f(h) - f(-h)) / (2.0 * h);
        let numeric = [
            odd(&|h| at(d + h, v, 1.2, 0.7), 1e-8),
            odd(&|h| at(d, v + h, 1.2, 0.7), 1e-4),
            odd(&|h| at(d, v, 1.2 + h, 0.7), 1e-4),
            odd(&|h| at(d, v, 1.2, 0.7 + h), 1e-4),
        ];
        for (i, numeric) in numeric.iter().enumerate() {
            let error = (all[1 + i] - numeric).abs();
            assert!(
                error < 1e-6 * numeric.abs(),
                "{d}, {i}: {} {numeric}",
                all[1 + i]
            );
        }
    }
}

#[test]
fn rejects_tables_that_are_no_force() {
    type Change = fn(&mut ForceTable);
    let cases: [(Change, &str); 6] = [
        (
            |t| t.displacement[2] = 1e-3,
            "row 3 of the table: the displacement does not rise",
        ),
        (|t| t.force[3] = 3.0, "row 4 of the table: the force falls"),
        (
            |t| t.force[0] = 1.0,
            "row 1 of the table: a table begins with displacement 0 and force 0",
        ),
        (
            |t| t.damping = Some(vec![1.0, -1.0, 1.0, 1.0]),
            "row 2 of the table: the damping is negative",
        ),
        (
            |t| t.damping = Some(vec![1.0]),
            "columns have different lengths",
        ),
        (
            |t| t.force[1] = f64::NAN,
            "row 2 of the table: a value is not a finite number",
        ),
    ];
    for (change, expected) in cases {
        let mut own = table(None);
        if let UserForce::Table(table) = &mut own.force {
            change(table);
        }
        let message = define_law(&own).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    }
}
