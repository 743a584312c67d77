//! Files of single fits for other programs.

use crate::counted::windfall;
use serde_json::Value;

fn numbers(value: &Value) -> Vec<f64> {
    let all = value.as_array().unwrap().iter();
    all.map(|own| own.as_f64().unwrap()).collect()
}

/// The diagonal of the covariance against the deviations that the fit tells of.
fn holds_covariance(impact: &Value, file: &Value) {
    let constant = &file["constant_data"];
    let names = file["coords"]["parameter"].as_array().unwrap();
    for (i, name) in names.iter().enumerate() {
        let name = name.as_str().unwrap();
        let own = match impact["parameters"].get(name) {
            Some(own) => own,
            None => &impact["nuisances"][name],
        };
        let sd = own["sd"].as_f64().unwrap();
        let variance = constant["covariance"][i][i].as_f64().unwrap();
        assert!((variance.sqrt() / sd - 1.0).abs() < 1e-12, "{name}");
        assert_eq!(constant["estimate"][i], own["value"]);
    }
}

/// Residuals, deviations and draws in the file are those that the fit tells of.
#[test]
fn closed_form_residuals_and_covariance_in_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let line = "simulate pendulum --law kuwabara-kono(k=394931,c=681) --specimens 1 --recordings \
                campaign";
    let (status, _, told) = windfall(&line.replace("                ", ""), folder.path());
    assert_eq!(status, Some(0), "{told}");
    // Where recordings lie, nothing is written.
    let (status, _, told) = windfall("fit campaign --detail campaign/raw", folder.path());
    assert_eq!(status, Some(2), "{told}");
    let read = |options: &str| -> (Value, Value) {
        let line = format!("fit campaign --format json {options}");
        let (status, out, told) = windfall(&line, folder.path());
        assert_eq!(status, Some(0), "{told}");
        let outcome: Value = serde_json::from_str(&out).unwrap();
        let impact = outcome["impacts"][0].clone();
        let name = format!("fits/{}-kuwabara-kono.json", impact["id"].as_str().unwrap());
        let text = std::fs::read_to_string(folder.path().join(name)).unwrap();
        (impact, serde_json::from_str(&text).unwrap())
    };
    let (impact, file) = read("--detail fits");
    let constant = &file["constant_data"];
    for quantity in ["displacement", "force"] {
        let residuals = numbers(&constant[format!("{quantity}_residual")]);
        let predicted = numbers(&constant[format!("{quantity}_predicted")]);
        let measured = numbers(&file["observed_data"][quantity]);
        let times = numbers(&file["coords"][format!("{quantity}_time")]);
        assert_eq!(times.len(), residuals.len());
        let square: f64 = residuals.iter().map(|own| own * own).sum();
        let rms = (square / residuals.len() as f64).sqrt();
        let told = impact["residuals"][quantity]["rms"].as_f64().unwrap();
        assert!((rms / told - 1.0).abs() < 1e-12, "{rms} {told}");
        for ((predicted, measured), residual) in predicted.iter().zip(&measured).zip(&residuals) {
            assert!((predicted - measured - residual).abs() <= 1e-12 * predicted.abs().max(1.0));
        }
    }
    holds_covariance(&impact, &file);
    assert!(file.get("posterior").is_none());

    // The draws of one parameter: four chains whose R-hat is told beside them.
    let (impact, file) = read("--detail fits --intervals posterior --draws 200");
    let chains = file["posterior"]["k"].as_array().unwrap();
    assert_eq!(chains.len(), 4);
    let draws: Vec<f64> = chains.iter().flat_map(numbers).collect();
    assert_eq!(draws.len(), 800);
    let mean = draws.iter().sum::<f64>() / 800.0;
    let square: f64 = draws.iter().map(|own| (own - mean).powi(2)).sum();
    let sd = impact["parameters"]["k"]["sd"].as_f64().unwrap();
    assert!(((square / 799.0).sqrt() / sd - 1.0).abs() < 1e-9);
    let told = &impact["intervals"]["mixing"]["k"];
    assert_eq!(file["constant_data"]["r_hat"][0], told["r_hat"]);
    assert_eq!(file["constant_data"]["ess_bulk"][0], told["bulk_draws"]);

    // What is uncertain of the bench is in the covariance as it is in the deviations.
    let path = folder.path().join("campaign/campaign.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let line = text
        .lines()
        .find(|line| line.starts_with("inertia"))
        .unwrap();
    let uncertain = text.replace(line, "inertia = \"0.01435 ± 0.0003 kg m^2\"");
    std::fs::write(&path, uncertain).unwrap();
    let (wider, file) = read("--detail fits");
    let sd = |impact: &Value| impact["parameters"]["k"]["sd"].as_f64().unwrap();
    assert!(sd(&wider) > 3.0 * sd(&impact));
    holds_covariance(&wider, &file);
}

/// Where there are no fits, or none that end, nothing can be written.
#[test]
fn rejects_watching_and_campaigns_without_fits() {
    let folder = tempfile::tempdir().unwrap();
    let (status, _, told) = windfall("new acoustic taps", folder.path());
    assert_eq!(status, Some(0), "{told}");
    for (line, words) in [
        ("fit taps --detail fits", "--detail"),
        ("fit taps --watch --detail fits", "cannot be used with"),
    ] {
        let (status, _, told) = windfall(line, folder.path());
        assert_eq!(status, Some(2), "{told}");
        assert!(told.contains(words), "{told}");
        assert!(!folder.path().join("fits").exists());
    }
}
