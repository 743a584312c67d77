//! Campaigns whose impacts have velocities of their own.

use crate::counted::windfall;
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Writes a campaign of impacts with given laws and velocities (m/s), as many impacts on each
/// fruit as it has entries in a row.
pub fn campaign_of(folder: &Path, fruit: &[Vec<(String, f64)>]) {
    let mut impacts = "id,specimen,file\n".to_owned();
    let mut specimens = "id,variety\n".to_owned();
    for (number, own) in fruit.iter().enumerate() {
        specimens += &format!("s{number:02},one\n");
        for (place, (law, velocity)) in own.iter().enumerate() {
            let id = format!("i{number:02}-{place}");
            let seed = 100 * number + place;
            let line = format!(
                "simulate pendulum --law {law} --velocity {velocity}m/s --specimens 1 \
                 --seed {seed} --recordings made/{id}"
            );
            let (status, _, told) = windfall(&line, folder);
            assert_eq!(status, Some(0), "{told}");
            let made = folder.join("made").join(&id);
            let campaign = folder.join("campaign");
            if impacts.ends_with("file\n") {
                fs::create_dir_all(campaign.join("raw")).unwrap();
                fs::copy(made.join("campaign.toml"), campaign.join("campaign.toml")).unwrap();
            }
            let recording = made.join("raw/specimen-01.csv");
            fs::rename(recording, campaign.join(format!("raw/{id}.csv"))).unwrap();
            impacts += &format!("{id},s{number:02},{id}.csv\n");
        }
    }
    fs::write(folder.join("campaign/impacts.csv"), impacts).unwrap();
    fs::write(folder.join("campaign/specimens.csv"), specimens).unwrap();
}

fn json(line: &str, folder: &Path) -> Value {
    let (status, out, told) = windfall(&format!("{line} --format json"), folder);
    assert_eq!(status, Some(0), "{told}");
    serde_json::from_str(&out).unwrap()
}

/// Velocities from 0.2 to 0.5 m/s, none of them twice: the law that made the impacts predicts
/// thirds of them, another does not, and a column that numbers the impacts changes nothing.
#[test]
fn recovers_unseen_velocities_where_all_differ() {
    let folder = tempfile::tempdir().unwrap();
    let law = "kuwabara-kono(k=753599,c=1524)".to_owned();
    let one = |i: usize| vec![(law.clone(), 0.2 + 0.3 * ((i * 5) % 9) as f64 / 8.0)];
    campaign_of(folder.path(), &(0..9).map(one).collect::<Vec<_>>());
    let line = "laws campaign --law kuwabara-kono --law kelvin-voigt";
    let found = json(line, folder.path());
    assert_eq!(found["levels"], 3);
    let told = found["findings"].as_array().unwrap();
    let told = told.iter().find(|own| own["code"] == "velocity-thirds");
    let told = told.unwrap()["message"].as_str().unwrap();
    assert!(told.contains("3 impacts at 0.200 to 0.2"), "{told}");
    assert!(
        told.contains("to 0.500 m/s") || told.contains("to 0.499 m/s"),
        "{told}"
    );
    let of = |law: usize| found["laws"][law]["prediction"].as_f64().unwrap();
    assert!(of(0) < 0.03 && of(1) > 5.0 * of(0), "{} {}", of(0), of(1));

    let path = folder.path().join("campaign/impacts.csv");
    let table = fs::read_to_string(&path).unwrap();
    let numbered = table.lines().enumerate().map(|(line, row)| match line {
        0 => format!("{row},level\n"),
        _ => format!("{row},{line}\n"),
    });
    fs::write(&path, numbered.collect::<String>()).unwrap();
    let again = json(line, folder.path());
    assert_eq!(again["laws"], found["laws"]);
}

fn told<'a>(outcome: &'a Value, code: &str) -> Vec<&'a str> {
    let found = outcome["findings"].as_array().unwrap().iter();
    let own = found.filter(|own| own["code"] == code);
    own.map(|own| own["message"].as_str().unwrap()).collect()
}

/// Eight fruit of differing stiffness at 0.2, 0.35 and 0.5 m/s, under a law with k and c to be
/// filled in.
fn fruit(law: &str) -> Vec<Vec<(String, f64)>> {
    let one = |number: usize| {
        let size = 1.0 + 0.1 * ((number * 3) % 8) as f64;
        let law = law.replace("C", &(1524.0 * size).to_string());
        let law = law.replace("K", &(753_599.0 * size).to_string());
        let mut own = [0.2, 0.35, 0.5];
        own.rotate_left(number % 3);
        own.map(|velocity| (law.clone(), velocity)).to_vec()
    };
    (0..8).map(one).collect()
}

/// A law with another exponent makes k depend on velocity, which says what the exponent is; the
/// law that made the impacts has no trend; the report draws both.
#[test]
fn recovers_the_exponent_from_k_over_velocity() {
    let folder = tempfile::tempdir().unwrap();
    campaign_of(folder.path(), &fruit("power-law(k=6e6,n=1.8,c=C,p=0.5)"));
    let found = json("fit campaign --law kuwabara-kono", folder.path());
    let trend = told(&found, "law-velocity-trend");
    assert_eq!(trend.len(), 1, "{}", found["findings"]);
    assert!(
        trend[0].contains("k rises by ") && trend[0].contains("within fruit"),
        "{trend:?}"
    );
    let (_, exponent) = trend[0].split_once("an exponent of ").unwrap();
    let exponent: f64 = exponent.split(' ').next().unwrap().parse().unwrap();
    assert!((exponent - 1.8).abs() < 0.05, "{trend:?}");
    let right = json("fit campaign --law power-law(n=1.8,p=0.5)", folder.path());
    assert_eq!(told(&right, "law-velocity-trend"), [""; 0]);
    let (status, _, said) = windfall("report campaign --law kuwabara-kono", folder.path());
    assert_eq!(status, Some(0), "{said}");
    let page = fs::read_to_string(folder.path().join("campaign/report/report.html")).unwrap();
    assert!(page.contains("kuwabara-kono: what should be constant"));
}

/// Stiffness that grows along the campaign, with and without times of day; a time that is none.
#[test]
fn recovers_a_drift_of_the_fruit() {
    let folder = tempfile::tempdir().unwrap();
    let one = |number: usize| {
        let grown = 1.0 + 0.02 * number as f64 + 0.01 * ((number * 7) % 5) as f64;
        let law = format!("kuwabara-kono(k={},c=1524)", 753_599.0 * grown);
        vec![(law, 0.2 + 0.3 * ((number * 5) % 16) as f64 / 15.0)]
    };
    campaign_of(folder.path(), &(0..16).map(one).collect::<Vec<_>>());
    let found = json("fit campaign", folder.path());
    let drift = told(&found, "order-trend");
    assert_eq!(drift.len(), 1, "{}", found["findings"]);
    assert!(
        drift[0].contains("k of kuwabara-kono rises by ") && drift[0].contains("not the sensor"),
        "{drift:?}"
    );
    assert_eq!(told(&found, "law-velocity-trend"), [""; 0]);
    let slope = found["trends"].as_array().unwrap().iter();
    let mut slope = slope.filter(|own| own["quantity"] == "k" && own["over"] == "order");
    let slope = slope.next().unwrap()["slope"].as_f64().unwrap();
    // ln of 1.30 to 1.36 from first to last.
    assert!((0.2..0.36).contains(&slope), "{slope}");

    let path = folder.path().join("campaign/impacts.csv");
    let table = fs::read_to_string(&path).unwrap();
    let timed = |wrong: bool| {
        let rows = table.lines().enumerate().map(|(line, row)| match line {
            0 => format!("{row},time_of_day\n"),
            9 if wrong => format!("{row},2 o'clock\n"),
            _ => format!(
                "{row},2026-05-03 {:02}:{:02}\n",
                9 + line / 4,
                15 * (line % 4)
            ),
        });
        fs::write(&path, rows.collect::<String>()).unwrap();
        json("fit campaign", folder.path())
    };
    let found = timed(false);
    let hours = found["trends"].as_array().unwrap().iter();
    let hours = hours.filter(|own| own["over"] == "time_of_day").count();
    assert_eq!(hours, 4);
    let found = timed(true);
    let unread = told(&found, "time-of-day-unread");
    assert!(
        unread[0].contains("line 10, column time_of_day: \"2 o'clock\""),
        "{unread:?}"
    );
    assert!(!found["trends"].to_string().contains("time_of_day"));
}

/// A second comparison or population is that of the store, and is found anew after each change
/// that it depends on; an answer that was altered is refused.
#[test]
fn conserves_answers_in_the_store_until_something_changes() {
    let folder = tempfile::tempdir().unwrap();
    let own = folder.path();
    campaign_of(own, &fruit("kuwabara-kono(k=K,c=C)")[..3]);
    let store = own.join("campaign/results.sqlite");
    let (laws, population) = (
        "laws campaign --law kuwabara-kono --law hertz",
        "population campaign",
    );
    let first = (json(laws, own), json(population, own));
    let stored = fs::read(&store).unwrap();
    let again = (json(laws, own), json(population, own));
    assert_eq!(
        (&again, fs::read(&store).unwrap()),
        (&first, stored.clone())
    );

    // What was asked for, the tables, and the recordings.
    let fewer = json("laws campaign --law hertz --law kelvin-voigt", own);
    assert_eq!(fewer["laws"].as_array().unwrap().len(), 2);
    assert_ne!(fewer["laws"], first.0["laws"]);
    let table = own.join("campaign/impacts.csv");
    let rows = fs::read_to_string(&table).unwrap();
    let left = rows.lines().enumerate().map(|(line, row)| match line {
        0 => format!("{row},exclude\n"),
        3 => format!("{row},yes\n"),
        _ => format!("{row},\n"),
    });
    fs::write(&table, left.collect::<String>()).unwrap();
    assert_eq!(json(laws, own)["impacts"], 8);
    assert_eq!(json(population, own)["impacts"], 8);
    fs::write(&table, &rows).unwrap();
    assert_eq!((json(laws, own), json(population, own)), first);
    let recording = own.join("campaign/raw/i00-0.csv");
    let samples = fs::read_to_string(&recording).unwrap();
    fs::write(&recording, samples.replacen("0.0", "0.1", 1)).unwrap();
    assert_ne!(json(laws, own), first.0);
    fs::write(&recording, samples).unwrap();

    // Altered behind our back.
    let mut bytes = fs::read(&store).unwrap();
    let word = b"\"verdict\":\"sure\"";
    let places = bytes
        .windows(word.len())
        .enumerate()
        .filter(|own| own.1 == word);
    let places: Vec<usize> = places.map(|own| own.0).collect();
    assert!(!places.is_empty());
    for place in places {
        bytes[place + word.len() - 2] = b'f';
    }
    fs::write(&store, bytes).unwrap();
    let (status, _, told) = windfall(laws, own);
    assert_eq!(status, Some(1), "{told}");
    assert!(told.contains("laws") && told.contains("--refit"), "{told}");
    assert_eq!(json(&format!("{laws} --refit"), own), first.0);
    assert_eq!(json(laws, own), first.0);

    // A fit has its own run; its answers do not hide behind those of the campaign.
    let (status, out, told) = windfall("fit campaign", own);
    assert_eq!(status, Some(0), "{told}");
    assert!(out.contains("9 impacts"), "{out}");
}
