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
