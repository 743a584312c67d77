//! `windfall plan`: power and precision against R, and what is refused.

#![allow(clippy::unwrap_used)]

use crate::on_table::{self, close};
use serde_json::Value;

/// Words of a line; quoted ones hold blanks.
fn words(line: &str) -> Vec<&str> {
    let parts = line.split('\'').enumerate();
    let words = parts.flat_map(|(place, part)| match place % 2 {
        0 => part.split_whitespace().collect(),
        _ => vec![part],
    });
    words.collect()
}

fn json(table: &str, line: &str) -> Value {
    on_table::json(table, &words(&format!("plan {line}")))
}

fn row(line: &str) -> Value {
    json("", line)["rows"][0].clone()
}

/// Twelve fruit of two varieties with four impacts each; deviations that no seed made.
fn impacts() -> String {
    let mut text = "fruit,variety,V,k\n".to_owned();
    for fruit in 0..12 {
        for (place, v) in [0.1, 0.3, 0.5, 0.7].iter().enumerate() {
            let own = 0.15 * f64::from((fruit * 7) % 12 - 5) / 5.0;
            let error = 0.08 * (f64::from(fruit * 4) + place as f64 * 2.7).sin();
            let variety = if fruit % 2 == 0 { "Fuji" } else { "Gala" };
            let k = 1.0 - 0.3 * v + 0.1 * f64::from(fruit % 2) + own + error;
            text += &format!("f{fruit},{variety},{v},{k:.4}\n");
        }
    }
    text
}

/// Expected: R 4.2.2, `power.t.test(…, strict = TRUE)`, `power.anova.test`'s formula by mpmath
/// (R's `pf` is off by 1e-9), noncentral t in `pt` for slopes (over `dchisq` by `integrate` where x
/// is drawn), and `integrate` over the two
/// variances for Welch's test.
#[test]
fn reference_power_of_r() {
    for (line, expected) in [
        ("mean --sd 1.2 --difference 2 --fruit 6", 0.898771623846),
        ("mean --sd 1.2 --difference -2 --fruit 6", 0.898771623846),
        (
            "difference --sd 1.5 --difference 1 --fruit 20 --pooled",
            0.537786846676,
        ),
        (
            "difference --sd 1.5 --difference 1 --fruit 20 --pooled --one-sided",
            0.664786359001,
        ),
        (
            "difference --sd 1,2 --difference 1.5 --fruit 10 --ratio 1.5",
            0.655580258075,
        ),
        (
            "difference --sd 12,15 --difference 8 --fruit 25 --ratio 2 --one-sided",
            0.794736410465,
        ),
        (
            "difference --sd 1 --difference 0.8 --fruit 15 --same-fruit",
            0.821310538725,
        ),
        (
            "difference --between 0.2 --within 0.1 --impacts 8 --difference 0.15 --fruit 30",
            0.803106235388,
        ),
        (
            "difference --between 0.2 --within 0.1 --impacts 2 --difference 0.05 --fruit 12 --same-fruit",
            0.391628148265,
        ),
        (
            "difference --between 0.2 --within 0.1 --impacts 2 --difference 0.05 --fruit 12 --same-fruit \
             --effect-sd 0.05",
            0.293389465876,
        ),
        (
            "groups --means 1,2,3 --sd 3 --fruit 12 --confidence 0.99",
            0.101210040467,
        ),
        (
            "groups --means 0,0.05,0.1 --between 0.2 --within 0.1 --impacts 2 --fruit 8 --same-fruit",
            0.680630601741,
        ),
        (
            "slope --slope 0.02 --spread-x 8 --sd 0.3 --fruit 20",
            0.578473344269,
        ),
        (
            "slope --slope -0.4 --x 0.1,0.3,0.5 --same-fruit --impacts 6 --between 0.2 --within 0.1 --fruit 5",
            0.929391380826,
        ),
        (
            "slope --slope 0.4 --x 0.1,0.3,0.5 --same-fruit --impacts 6 --between 0.2 --within 0.1 --fruit 5 \
             --effect-sd 0.3",
            0.416854179017,
        ),
    ] {
        let found = row(line)["power"]["value"].as_f64().unwrap();
        assert!(
            (found - expected).abs() < 1e-9,
            "{line}: {found} {expected}"
        );
    }
}

/// Expected: R 4.2.2, `qt`, `qchisq`, `lgamma`; Welch's by `integrate` and `uniroot`.
#[test]
fn reference_half_widths_of_r() {
    for (line, expected) in [
        ("mean --sd 12 --fruit 10", 8.34958234679),
        ("mean --sd 12 --fruit 10 --assurance 0.9", 10.9647787985),
        ("slope --spread-x 8 --sd 0.3 --fruit 5", 0.06890198366),
        ("slope --spread-x 8 --sd 0.3 --fruit 30", 0.01451672111),
        (
            "slope --spread-x 8 --sd 0.3 --fruit 30 --assurance 0.9",
            0.01818095596,
        ),
        ("difference --sd 1,2 --fruit 10 --ratio 1.5", 1.24621021977),
        (
            "difference --sd 1,2 --fruit 10 --ratio 1.5 --assurance 0.9",
            1.49532651973,
        ),
    ] {
        close(&row(line)["half_width"], expected, 1e-9);
    }
}

/// Expected: `ceiling(power.t.test(power = 0.8, …, strict = TRUE)$n)` in R 4.2.2, and by hand
/// the costs.
#[test]
fn reference_smallest_studies_and_the_cheapest() {
    let line = "difference --difference 0.15 --between 0.2 --within 0.1 --impacts 1,2,4,8 \
                --power 0.8 --cost-fruit 2.5 --cost-impact 0.2";
    let found = json("", line);
    let rows = found["rows"].as_array().unwrap();
    let expected = [
        (1, 36, 194.4),
        (2, 33, 191.4),
        (4, 31, 204.6),
        (8, 30, 246.0),
    ];
    for (row, (impacts, fruit, cost)) in rows.iter().zip(expected) {
        assert_eq!(
            (&row["impacts"], &row["fruit"]),
            (&impacts.into(), &fruit.into())
        );
        close(&row["cost"], cost, 1e-12);
        assert_eq!(row["best"], impacts == 2);
        // one fruit less is not enough
        let less = format!(
            "{} --fruit {}",
            line.replace("1,2,4,8", &impacts.to_string()),
            fruit - 1
        );
        assert_eq!(json("", &less)["rows"][0]["reached"], false);
    }
    // the smallest effect that the study finds is found with that power
    let detectable = rows[3]["detectable"].as_f64().unwrap();
    let again = line
        .replace("0.15", &detectable.to_string())
        .replace("1,2,4,8", "8 --fruit 30");
    close(&json("", &again)["rows"][0]["power"]["value"], 0.8, 1e-9);
    let welch = row("difference --sd 1,2 --fruit 10 --ratio 1.5")["detectable"]
        .as_f64()
        .unwrap();
    let again = format!("difference --sd 1,2 --fruit 10 --ratio 1.5 --difference {welch}");
    close(&row(&again)["power"]["value"], 0.8, 1e-9);
}

#[test]
fn closed_form_budgets() {
    let line = "difference --difference 0.15 --between 0.2 --within 0.1 --impacts 1,2,4,8 \
                --budget 100 --cost-fruit 2.5 --cost-impact 0.2";
    let found = json("", line);
    let rows = found["rows"].as_array().unwrap();
    // 2 n (2.5 + 0.2 m) ≤ 100
    let fruit: Vec<u64> = rows
        .iter()
        .map(|row| row["fruit"].as_u64().unwrap())
        .collect();
    assert_eq!(fruit, [18, 17, 15, 12]);
    let best: Vec<bool> = rows
        .iter()
        .map(|row| row["best"].as_bool().unwrap())
        .collect();
    assert_eq!(best, [false, true, false, false]);
    let poor = json("", &format!("{line} --power 0.8"));
    assert_eq!(poor["findings"][0]["code"], "over-budget");
    let found = json("", "mean --sd 1 --fruit 50,60 --cost-fruit 4 --budget 100");
    let text = found["findings"][0]["message"].as_str().unwrap();
    assert_eq!(
        text,
        "the budget pays for none of the studies tried: the cheapest costs 200.0"
    );
    let (_, csv, _) = on_table::run("", &words(&format!("plan {line} --format csv")));
    assert!(csv.starts_with("impacts,fruit,fruit_in_all,"), "{csv}");
    assert_eq!(csv.lines().count(), 5);
}

/// Half a population's numbers by hand: σ² of a mean of logarithms, and the error of the SD by
/// R (see the unit test).
#[test]
fn repeats_simulations_for_any_number_of_threads() {
    let line = "model t.csv --formula 'k ~ V + variety + (1 | fruit)' --term variety --fruit 12,24 \
                --simulations 200";
    let one = json(&impacts(), &format!("{line} --threads 1"));
    let two = json(&impacts(), &format!("{line} --threads 2"));
    assert_eq!(one, two);
    assert_ne!(
        one["rows"],
        json(&impacts(), &format!("{line} --seed 2"))["rows"]
    );
    // the order of the columns of a term means nothing
    let term =
        "model t.csv --formula 'k ~ V * variety + (1 | fruit)' --fruit 12 --simulations 50 --term";
    assert_eq!(
        json(&impacts(), &format!("{term} V:variety"))["rows"],
        json(&impacts(), &format!("{term} variety:V"))["rows"]
    );
    let power = &one["rows"][0]["power"];
    assert!(power["low"].as_f64().unwrap() < power["value"].as_f64().unwrap());
}

/// What the table shows is what `windfall regress` says of it, and an effect as large as the
/// detectable one is found with that power by the closed form.
#[test]
fn closed_form_of_what_was_achieved() {
    let formula = "'k ~ V + variety + (1 | fruit)'";
    let found = json(
        &impacts(),
        &format!("achieved t.csv --formula {formula} --means variety"),
    );
    let regress = format!("regress t.csv --formula {formula} --means variety --adjust none");
    let regress = on_table::json(&impacts(), &words(&regress));
    for (own, term) in found["estimates"]
        .as_array()
        .unwrap()
        .iter()
        .zip(regress["terms"].as_array().unwrap())
    {
        assert_eq!(own["name"], term["term"]);
        close(
            &own["half_width"],
            0.5 * (term["high"].as_f64().unwrap() - term["low"].as_f64().unwrap()),
            1e-12,
        );
    }
    let variety = &found["estimates"][2];
    assert_eq!(variety["name"], "variety[Gala]");
    let sd = variety["se"].as_f64().unwrap() * 3f64.sqrt();
    // six fruit in each group: se = sd √(2/6), and 10 degrees of freedom
    let line = format!(
        "difference --sd {sd} --pooled --fruit 6 --difference {}",
        variety["detectable"]
    );
    close(&row(&line)["power"]["value"], 0.8, 1e-6);
    // half of twelve fruit: 6 - 2 degrees of freedom; qt(0.975, 4) and qt(0.975, 22) of R
    let se = variety["se"].as_f64().unwrap();
    let half = 2.776445105198 * se * 2f64.sqrt();
    close(&variety["half_width_with_half"], half, 1e-6);
    let twice = 2.073873067904 * se / 2f64.sqrt();
    close(&variety["half_width_with_twice"], twice, 1e-6);
    let difference = found["estimates"].as_array().unwrap().last().unwrap();
    close(
        &difference["half_width"],
        variety["half_width"].as_f64().unwrap(),
        1e-9,
    );
    // no power of what was found (Hoenig and Heisey 2001)
    assert!(found.get("observed_power").is_none());
}

/// A curve of half-widths begins at a quarter of the fruit that are needed.
#[test]
fn conserves_the_wanted_half_width_in_the_curve() {
    let found = json("", "mean --sd 12 --half-width 1");
    let needed = found["rows"][0]["fruit"].as_u64().unwrap();
    assert_eq!(found["curve"][0]["fruit"], needed / 4);
}

/// Missing words are those that the options name.
#[test]
fn conserves_the_reading_of_a_table_of_scatter() {
    let line = "mean --from t.csv --formula 'k ~ V + (1 | fruit)' --fruit 6 --impacts 3";
    let table = impacts() + "f0,Fuji,0.9,lost\n";
    let found = json(&table, &format!("{line} --missing lost"));
    assert_eq!(found["rows"], json(&impacts(), line)["rows"]);
}

/// One fruit of each level: fruit and levels are one.
#[test]
fn rejects_a_campaign_that_tells_no_variance() {
    let mut table = "fruit,g,V,k\n".to_owned();
    for (fruit, g) in ["a", "b", "c"].iter().enumerate() {
        for (v, error) in [(1, 0.1), (2, -0.2), (3, 0.15)] {
            table += &format!(
                "f{fruit},{g},{v},{}\n",
                v as f64 * 2.0 + error * (fruit + 1) as f64
            );
        }
    }
    let line = words("plan achieved t.csv --formula 'k ~ V + g + (1 | fruit)'");
    let (status, _, told) = on_table::run(&table, &line);
    assert_eq!(status, Some(2), "{told}");
    assert!(told.contains("variances cannot be told apart"), "{told}");
}

/// Without means there are the coefficients of `windfall regress` alone.
#[test]
fn conserves_what_was_achieved_without_means() {
    let formula = "'k ~ V + (1 | fruit)'";
    let found = json(&impacts(), &format!("achieved t.csv --formula {formula}"));
    let regress = format!("regress t.csv --formula {formula}");
    let regress = on_table::json(&impacts(), &words(&regress));
    let (own, terms) = (
        found["estimates"].as_array().unwrap(),
        regress["terms"].as_array().unwrap(),
    );
    assert_eq!(own.len(), terms.len());
    for (own, term) in own.iter().zip(terms) {
        assert_eq!(own["kind"], "coefficient");
        assert_eq!(own["se"], term["se"]);
    }
}

/// Values of x that every so many fruit have equally often: R 4.2.2, noncentral t in `pt`, with
/// Sxx = n · 8.25 of ten fruit, 2 · 82.5 of twenty.
#[test]
fn conserves_the_values_of_x() {
    let line = "slope --slope 0.3 --x 1,2,3,4,5,6,7,8,9,10 --sd 1";
    assert_eq!(row(&format!("{line} --power 0.6"))["fruit"], 10);
    assert_eq!(row(&format!("{line} --power 0.8"))["fruit"], 20);
    assert_eq!(
        row(&format!("{line} --power 0.8 --fruit 5..60"))["fruit"],
        20
    );
    let listed = json("", &format!("{line} --fruit 5..35"));
    let fruit = listed["rows"].as_array().unwrap().iter();
    let fruit: Vec<u64> = fruit.map(|row| row["fruit"].as_u64().unwrap()).collect();
    assert_eq!(fruit, [10, 20, 30]);
    let paid = row(&format!("{line} --cost-fruit 1 --budget 39"));
    assert_eq!(paid["fruit"], 30);
}

/// Scatter from a table is that of its mixed model.
#[test]
fn conserves_the_scatter_of_a_table() {
    let found = json(
        &impacts(),
        "difference --from t.csv --formula 'k ~ V + variety + (1 | fruit)' --difference 0.1 --fruit 10 --impacts 4",
    );
    let regress = on_table::json(
        &impacts(),
        &words("regress t.csv --formula 'k ~ V + variety + (1 | fruit)'"),
    );
    let sd = |place: usize| regress["variances"][place]["value"].as_f64().unwrap();
    let stated = format!(
        "difference --between {} --within {} --difference 0.1 --fruit 10 --impacts 4",
        sd(0),
        sd(1)
    );
    close(
        &found["rows"][0]["power"]["value"],
        row(&stated)["power"]["value"].as_f64().unwrap(),
        1e-12,
    );
}

/// The response at the optimum is known as a linear model says: here at the centre of a design
/// with three centre runs, whose leverage is 1/3 for the quadratic model of two factors.
#[test]
fn closed_form_precision_of_a_surface() {
    let a = 2f64.sqrt();
    let mut design = "A,B\n".to_owned();
    for (x, y) in [
        (1.0, 1.0),
        (1.0, -1.0),
        (-1.0, 1.0),
        (-1.0, -1.0),
        (a, 0.0),
        (-a, 0.0),
        (0.0, a),
        (0.0, -a),
    ] {
        design += &format!("{x},{y}\n");
    }
    design += "0,0\n0,0\n0,0\n";
    let line = "surface t.csv --factor A --factor B --range A=-1..1 --range B=-1..1 --sd 2 --fruit 2 \
                --coefficients 'A^2=-1,B^2=-1'";
    let found = json(&design, line);
    // t(0.975, 16) · 2 √(1/6) · c4(16), R 4.2.2
    close(&found["rows"][0]["half_width"], 1.70407763676, 1e-9);
    assert_eq!(found["rows"][0]["fruit_in_all"], 22);
    // an optimum of curvature -1 lies at half the slope, whose error is SD/√(8 + 8), as long as the
    // curvature is well known: 1.96 · 0.05/2 for an SD of 0.2; 1000 draws tell it to about 5 %
    let found = json(&design, &line.replace("--sd 2", "--sd 0.2"));
    let moved = found["rows"][0]["also"][0]["value"].as_f64().unwrap();
    assert!((moved / 0.049 - 1.0).abs() < 0.1, "{moved}");
    assert_eq!(found["rows"][0]["also"][2]["value"], 0.0);
    // an optimum at A = 5: the response is that at the centre, and there is no place
    let found = json(&design, &line.replace("'A^2=-1", "'A=10,A^2=-1"));
    assert_eq!(found["findings"][0]["code"], "no-optimum");
    assert_eq!(
        found["half_width_of"],
        "half-width of the response at the centre"
    );
    let about = found["about"][0].as_str().unwrap();
    assert!(about.contains("centre, 0 at A 0, B 0"), "{about}");
    assert_eq!(found["rows"][0]["also"], Value::Array(Vec::new()));
    close(&found["rows"][0]["half_width"], 1.70407763676, 1e-9);
}

/// Orthogonal blocks leave the leverage of the centre as it is, and take a degree of freedom.
#[test]
fn closed_form_precision_of_a_surface_in_blocks() {
    let mut design = "block,A,B\n".to_owned();
    for (x, y) in [(1, 1), (1, -1), (-1, 1), (-1, -1), (0, 0), (0, 0)] {
        design += &format!("1,{x},{y}\n");
    }
    let a = 2f64.sqrt();
    for (x, y) in [
        (a, 0.0),
        (-a, 0.0),
        (0.0, a),
        (0.0, -a),
        (0.0, 0.0),
        (0.0, 0.0),
    ] {
        design += &format!("2,{x},{y}\n");
    }
    let line = "surface t.csv --factor A --factor B --range A=-1..1 --range B=-1..1 --sd 2 --fruit 1 \
                --coefficients 'A^2=-1,B^2=-1'";
    let found = json(&design, line);
    assert_eq!(found["rows"][0]["df"], 5.0);
    // t(0.975, 5) · 2 √(1/4) · c4(5), R 4.2.2
    close(&found["rows"][0]["half_width"], 2.4459930909349, 1e-9);
    assert_eq!(found["findings"][0]["code"], "blocks");
    let without = json(&design.replace("block", "round"), line);
    assert_eq!(without["rows"][0]["df"], 6.0);
    let plots = json(&design.replace("block", "whole_plot"), line);
    assert_eq!(plots["findings"][0]["code"], "whole-plots-left-out");
}

#[test]
fn rejects_what_cannot_be_planned() {
    for (line, said) in [
        (
            "mean --half-width 3",
            "--sd: how much the measurements scatter is not known",
        ),
        ("mean --sd 0 --half-width 3", "--sd: 0 must be above zero"),
        ("mean --sd -1 --half-width 3", "--sd: -1 must be above zero"),
        (
            "mean --sd NaN --half-width 3",
            "--sd: NaN is no finite number",
        ),
        ("mean --sd x --half-width 3", "--sd: \"x\" is no number"),
        (
            "mean --between 1 --half-width 3",
            "--within: the standard deviation between the impacts",
        ),
        (
            "mean --within 1 --half-width 3",
            "--between: the standard deviation between fruit",
        ),
        (
            "mean --sd 1 --half-width 0",
            "--half-width: 0 must be above zero",
        ),
        ("mean --sd 1", "--fruit: say what is wanted"),
        (
            "mean --sd 1 --power 0.8",
            "--difference: the effect that is to be found is not stated",
        ),
        (
            "mean --sd 1 --power 0.8 --difference 0",
            "--difference: 0 is no effect",
        ),
        (
            "mean --sd 1 --power 1 --difference 1",
            "--power: 1 is not between 0 and 1",
        ),
        (
            "mean --sd 1 --power 0.04 --difference 1",
            "--power: 0.04 is no more than the level",
        ),
        (
            "mean --sd 1 --power 0.8 --difference 0.001",
            "no study that was tried tells so much: 1000 fruit with 1 impact each reach 0.05011",
        ),
        (
            "mean --sd 1 --half-width 0.01 --most-fruit 50",
            "50 fruit with 1 impact each reach 0.2828",
        ),
        (
            "difference --sd 1 --difference 1 --fruit 1",
            "--fruit: 1 fruit in each group cannot tell",
        ),
        (
            "difference --sd 1 --difference 1 --fruit 9..2",
            "runs backwards",
        ),
        (
            "difference --sd 1 --difference 1 --fruit 4 --impacts 0",
            "--impacts: \"0\" is no whole number",
        ),
        (
            "difference --sd 1 --difference 1 --fruit 4 --impacts 2",
            "--impacts: 2 impacts on each fruit need two",
        ),
        (
            "difference --sd 1,2,3 --difference 1 --fruit 4",
            "at most 2 are used",
        ),
        (
            "difference --sd 1,2 --pooled --difference 1 --fruit 4",
            "--pooled: one variance",
        ),
        (
            "difference --sd 1 --difference inf --fruit 4",
            "--difference: inf is no finite number",
        ),
        (
            "difference --sd 1e-200 --difference 1e200 --fruit 4",
            "too large or too small to calculate",
        ),
        (
            "difference --sd 1 --ratio 0 --difference 1 --fruit 4",
            "--ratio: 0 must be above zero",
        ),
        (
            "mean --sd 1 --fruit 4 --assurance 2",
            "--assurance: 2 is not between 0 and 1",
        ),
        (
            "mean --sd 1 --budget 10",
            "--budget: a budget needs costs above zero",
        ),
        (
            "mean --sd 1 --budget 10 --cost-fruit 0",
            "--budget: a budget needs costs above zero",
        ),
        (
            "mean --sd 1 --budget 10 --cost-fruit -1",
            "--cost-fruit: -1 must not be below zero",
        ),
        (
            "mean --sd 1 --budget 1 --cost-fruit 1",
            "--budget: the smallest study, 2 fruit with 1 impact each, costs 2.000",
        ),
        (
            "groups --means 2 --sd 1 --fruit 4",
            "one mean cannot differ",
        ),
        ("groups --means 2,2 --sd 1 --fruit 4", "all means are equal"),
        (
            "groups --means 1,2 --sd 1 --fruit 4 --one-sided",
            "--one-sided: an F test",
        ),
        ("slope --slope 1 --sd 1 --fruit 9", "--x: give the values"),
        (
            "slope --slope 1 --x 2,2 --sd 1 --fruit 9",
            "x has one value",
        ),
        (
            "slope --x 1,2,3,4,5,6,7,8,9,10 --sd 1 --fruit 24",
            "--fruit: 24 fruit cannot have the 10 values of --x equally often: 20 and 30 are the",
        ),
        (
            "slope --x 1,2,3,4 --sd 1 --fruit 5..7",
            "--fruit: 5 fruit cannot have the 4 values of --x equally often: 4 and 8 are the",
        ),
        (
            "slope --x 1,2,3,4 --sd 1 --fruit 3",
            "--fruit: 3 fruit cannot tell how much fruit differ: at least 4 are needed",
        ),
        (
            "slope --slope 1 --x 1,2 --sd 1 --fruit 9 --same-fruit",
            "--sd: with --same-fruit",
        ),
        (
            "slope --slope 1 --x 1,2 --between 1 --within 1 --fruit 9 --same-fruit --impacts 3",
            "--impacts: 3 impacts on each fruit cannot have the 2 values",
        ),
        (
            "model t.csv --formula 'k ~ V' --fruit 4",
            "--formula: the model does not say which rows are of one fruit",
        ),
        (
            "model t.csv --formula 'k ~ V + (1 | variety/fruit)' --fruit 4",
            "one kind of group can be planned",
        ),
        (
            "model t.csv --formula 'k ~ V + variety + (1 | fruit)' --fruit 4",
            "--term: say which term",
        ),
        (
            "model t.csv --formula 'k ~ V + (1 | fruit)' --term W --fruit 4",
            "no term \"W\"; there is only \"V\"",
        ),
        (
            "model t.csv --formula 'k ~ V + (1 | fruit)' --effect W=1 --fruit 4",
            "no such coefficient",
        ),
        (
            "model t.csv --formula 'k ~ V + (1 | fruit)' --effect V=0 --fruit 4",
            "there is nothing to be found",
        ),
        (
            "model t.csv --formula 'k ~ V + (1 | fruit)' --fruit 1",
            "--fruit: 1 fruit cannot tell",
        ),
        // one fruit of each variety: all differences between fruit may be those of the varieties
        (
            "model t.csv --formula 'k ~ V + variety + (1 | fruit)' --term V --fruit 2",
            "--fruit: 2 fruit cannot tell how much fruit differ: at least 3",
        ),
        (
            "model t.csv --formula 'k ~ V + (1 | fruit)' --fruit 4 --impacts 3",
            "repeated but not divided",
        ),
        (
            "model t.csv --formula 'k ~ V + (1 | fruit)' --fruit 4 --simulations 1",
            "--simulations: 1 is not between",
        ),
        (
            "model t.csv --formula 'k ~ V + (1 | fruit)' --effect V=1e300 --fruit 4",
            "--effect V=1e300: the effect is too large",
        ),
        (
            "model t.csv --formula 'k ~ V + (1 | fruit)' --effect V=1 --effect V=2 --fruit 4",
            "--effect V=2: V is stated twice",
        ),
        (
            "difference --sd 1 --difference 1 --fruit 4 --same-fruit --pooled",
            "--same-fruit",
        ),
        (
            "critical-energy --median 1 --spread 1 --energies 1 --half-width 0.2",
            "--energies 1: too few: one energy",
        ),
        (
            "mean --sd 1 --fruit 4 --figure plan.gif",
            "--figure plan.gif: figures are written as SVG, PNG or PDF",
        ),
        (
            "achieved t.csv --formula 'k ~ V'",
            "--formula: the model does not say",
        ),
        (
            "achieved t.csv --formula 'k ~ V + (1 | fruit)' --power 0.01",
            "--power: 0.01 is no more",
        ),
        (
            "critical-energy --median 0 --spread 1 --energies 1,2 --fruit 4",
            "--median: 0 must be above zero",
        ),
        (
            "critical-energy --median 1 --spread 1 --energies 2,1 --fruit 4",
            "each larger than the one before",
        ),
        (
            "critical-energy --median 1 --spread 1 --energies 1,2 --fruit 4 --power 0.8",
            "--power: an energy has",
        ),
        (
            "surface t.csv --factor V --model V --sd 1 --fruit 4",
            "--coefficients: where the optimum lies",
        ),
        (
            "surface t.csv --factor V --model V --coefficients V=0 --sd 1 --fruit 4",
            "the surface is level",
        ),
        ("population t.csv --parameter k --fruit 4", "t.csv"),
    ] {
        let (status, _, told) = on_table::run(&impacts(), &words(&format!("plan {line}")));
        assert_eq!(status, Some(2), "{line}: {told}");
        assert!(told.contains(said), "{line}: {told}");
    }
}

/// A variance between fruit that the table does not show is said.
#[test]
fn reference_findings_of_a_table_without_variance_between_fruit() {
    let mut table = "fruit,V,k\n".to_owned();
    for fruit in 0..6 {
        for (place, v) in [1, 2, 3].iter().enumerate() {
            let error = f64::from((fruit + 2 * place as i32) % 3 - 1);
            table += &format!("f{fruit},{v},{}\n", 2.0 * f64::from(*v) + error);
        }
    }
    for line in [
        "mean --from t.csv --formula 'k ~ V + (1 | fruit)' --fruit 6 --impacts 3",
        "model t.csv --formula 'k ~ V + (1 | fruit)' --fruit 6 --simulations 50",
    ] {
        let found = json(&table, line);
        let codes = found["findings"]
            .as_array()
            .unwrap()
            .iter()
            .map(|own| &own["code"]);
        let codes: Vec<&Value> = codes.collect();
        assert!(
            codes.contains(&&"no-variance-between".into()),
            "{line}: {codes:?}"
        );
    }
}
