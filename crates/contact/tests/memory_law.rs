//! Laws of the user that remember their largest displacement: against built-in laws and
//! differences; what is refused, and in which words.

use crate::user_law::parameter;
use windfall_contact::expression::parse_law_among;
use windfall_contact::law::ContactLaw;
use windfall_contact::laws::any_law::AnyLaw;
use windfall_contact::laws::define_law::define_law;
use windfall_contact::laws::kind::{Law, LawKind};
use windfall_contact::laws::user::{UserForce, UserLawDefinition};

fn definition(force: &str, unloading: &str, parameters: &[&str]) -> UserLawDefinition {
    UserLawDefinition {
        name: "mine".into(),
        force: UserForce::WithMemory {
            force: force.into(),
            unloading: unloading.into(),
        },
        parameters: parameters.iter().map(|text| parameter(text)).collect(),
    }
}

fn defined(force: &str, unloading: &str, parameters: &[&str]) -> LawKind {
    let found = define_law(&definition(force, unloading, parameters));
    found.unwrap_or_else(|error| panic!("{error}"))
}

fn refused(force: &str, unloading: &str, parameters: &[&str]) -> String {
    let found = define_law(&definition(force, unloading, parameters));
    found.expect_err(unloading).to_string()
}

const LINEAR: [&str; 2] = ["k1|N/m|15000|", "k2|N/m|40000|"];
const YIELD: (&str, &str, [&str; 4]) = (
    "if(x < d, k*x^1.5, k*d^1.5 + 1.5*k*d^0.5*h*(x - d)) + c*x^0.5*v",
    "k*(x - x_max + (F_max/k)^(2/3))*sqrt(abs(x - x_max + (F_max/k)^(2/3))) \
     + c*sqrt(abs(x - x_max + (F_max/k)^(2/3)))*v",
    [
        "k|N/m^1.5|7e5|",
        "c|N s/m^1.5|1500|",
        "d|m|4e-4|",
        "h|1|0.5|",
    ],
);

/// d, v, largest displacement: loading, unloading, reloading, loading beyond.
fn states() -> Vec<[f64; 3]> {
    let mut states = Vec::new();
    for d in [3.7e-5, 2.1e-4, 6.3e-4, 1.17e-3] {
        for v in [0.52, 0.03, -0.38] {
            states.extend([0.0, 1.9e-4, 6.1e-4, 1.6e-3].map(|peak| [d, v, peak]));
        }
    }
    states
}

fn numbers(law: Law, [d, v, peak]: [f64; 3], count: usize) -> Vec<f64> {
    let found = AnyLaw(law).evaluate(d, v, peak);
    let mut all = vec![
        found.force,
        found.by_displacement,
        found.by_rate,
        found.by_peak,
    ];
    all.extend(&found.by_parameter[..count]);
    all
}

#[test]
fn reference_walton_braun_written_as_formulas() {
    let kind = defined("k1*x", "F_max + k2*(x - x_max)", &LINEAR);
    let mine = kind.with_parameters(&[15_000.0, 40_000.0]).unwrap();
    let theirs = parse_law_among("walton-braun(k1=15000, k2=40000)", &[]).unwrap();
    let theirs = theirs.complete().unwrap();
    assert!(AnyLaw(mine).history() && AnyLaw(mine).start_power() == 1);
    for state in states() {
        let (own, built) = (numbers(mine, state, 2), numbers(theirs, state, 2));
        for (a, b) in own.iter().zip(&built) {
            assert!(
                (a - b).abs() <= 1e-12 * b.abs().max(1e-12),
                "{state:?}: {own:?} {built:?}"
            );
        }
    }
    // Nothing to say of it.
    let LawKind::User(user) = kind else {
        panic!("{kind:?}")
    };
    assert_eq!(user.findings(), []);
    assert!(
        user.description()
            .formula
            .contains("below the largest displacement x_max so far")
    );
}

/// Each derivative, that by the largest displacement too, against differences of the force.
#[test]
fn derivative_of_yield_with_elastic_unloading() {
    let kind = defined(YIELD.0, YIELD.1, &YIELD.2);
    let values = [753_599.0, 1524.0, 3.1e-4, 0.4];
    let law = |values: &[f64]| kind.with_parameters(values).unwrap();
    let mut seen = [0.0_f64; 8];
    for state in states() {
        let found = numbers(law(&values), state, 4);
        let force = |values: &[f64], state: [f64; 3]| numbers(law(values), state, 0)[0];
        let by_state = |i: usize| {
            let step = 1e-6 * state[i].abs();
            let (mut more, mut less) = (state, state);
            (more[i], less[i]) = (state[i] + step, state[i] - step);
            (force(&values, more) - force(&values, less)) / (2.0 * step)
        };
        let by_value = |i: usize| {
            let step = 1e-6 * values[i];
            let (mut more, mut less) = (values, values);
            (more[i], less[i]) = (values[i] + step, values[i] - step);
            (force(&more, state) - force(&less, state)) / (2.0 * step)
        };
        let peak = if state[2] > 0.0 { by_state(2) } else { 0.0 };
        let mut expected = vec![found[0], by_state(0), by_state(1), peak];
        expected.extend((0..4).map(by_value));
        // What a millionth of the force is, over each step.
        let [d, v, top] = state.map(f64::abs);
        let steps = [
            1.0,
            d,
            v,
            top.max(d),
            values[0],
            values[1],
            values[2],
            values[3],
        ];
        let rounding = steps.map(|step| found[0].abs() / step);
        for (i, (own, other)) in found.iter().zip(&expected).enumerate() {
            assert!(
                (own - other).abs() < 1e-5 * other.abs() + 1e-5 * rounding[i],
                "{state:?} {i}: {own} {other}"
            );
            seen[i] = seen[i].max(own.abs());
        }
    }
    assert!(seen.iter().all(|largest| *largest > 0.0), "{seen:?}");
}

#[test]
fn rejects_a_state_that_jumps() {
    // Where unloading begins.
    let told = refused("k1*x", "k1*x_max + k2*x", &LINEAR);
    for part in [
        "unloading: the force jumps from ",
        "where unloading begins",
        "F_max",
    ] {
        assert!(told.contains(part), "{told}");
    }
    // Where the largest displacement passes a limit: twice the stiffness from 0.1 mm on.
    let steps = "F_max + k2*(x - x_max)*if(x_max > d, 2, 1)";
    let limited = [LINEAR[0], LINEAR[1], "d|m|1e-4|"];
    let told = refused("k1*x", steps, &limited);
    assert!(
        told.contains("jumps") && told.contains("x_max = 1.000000e-4 m"),
        "{told}"
    );
    assert!(told.contains("changes its piece"), "{told}");
    // Within unloading.
    let told = refused(
        "k1*x",
        "F_max + k2*(x - x_max) - if(x < 0.5*x_max, 0.3*F_max, 0)",
        &LINEAR,
    );
    assert!(told.contains("changes its piece"), "{told}");
}

#[test]
fn rejects_unloading_that_cannot_be_used() {
    let told = refused(
        "k1*x",
        "k2*(x - x_max + F_max/k2)^1.5*m",
        &["k1|N/m|15000|", "k2|N/m|4e4|", "m|1/m^0.5|1|"],
    );
    assert!(told.contains("unloading: "), "{told}");
    let broken = ["k1|N/m|15000|", "k2|N/m^1.5|4e6|"];
    let told = refused("k1*x", "k2*(x - x_max + (F_max/k2)^(2/3))^1.5", &broken);
    assert!(
        told.contains("not finite at x = ") && told.contains("sqrt(abs(x - d))"),
        "{told}"
    );
    let told = refused("k1*x", "F_max + k2*(x - x_mx)", &LINEAR);
    assert!(
        told.contains("\"x_mx\"") && told.contains("did you mean x_max"),
        "{told}"
    );
    let told = refused("k1*x + 0*x_max", "F_max + k2*(x - x_max)", &LINEAR);
    assert!(told.contains("unknown name \"x_max\""), "{told}");
    let told = refused("k1*x", "F_max + k2*x*(x - x_max)", &LINEAR);
    assert!(
        told.contains("unloading: the term `k2*x*(x - x_max)` is in N m"),
        "{told}"
    );
    let told = refused("k1*x", "F_max + k1*(x - x_max)", &LINEAR);
    assert!(told.contains("\"k2\" is declared but not used"), "{told}");
    let told = refused("F_max*x/d", "F_max*x/d", &["F_max|N|10|", "d|m|1e-3|"]);
    assert!(told.contains("\"F_max\" cannot be a name"), "{told}");
}

#[test]
fn findings_of_damping_that_differs_and_of_energy_that_is_gained() {
    let codes = |kind: LawKind| match kind {
        LawKind::User(user) => user
            .findings()
            .iter()
            .map(|own| own.code())
            .collect::<Vec<_>>(),
        other => panic!("{other:?}"),
    };
    let kind = defined(YIELD.0, YIELD.1, &YIELD.2);
    assert!(
        codes(kind).contains(&"jumps-on-reloading"),
        "{:?}",
        codes(kind)
    );
    let soft = ["k1|N/m|15000|", "k2|N/m|9000|"];
    let kind = defined("k1*x", "F_max + k2*(x - x_max)", &soft);
    assert_eq!(codes(kind), ["gains-energy"]);
}
