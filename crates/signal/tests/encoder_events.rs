//! A real wheel encoder whose counts come with the times at which they changed.
//!
//! The data are not part of windfall (int-brain-lab/ibllib, MIT); `WINDFALL_DATA`
//! names their folder.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use windfall_signal::encoder::edge_rate::{CountTimes, edge_rate, edges};

fn wheel() -> Option<(Vec<f64>, Vec<f64>)> {
    let file = "encoder/ibl_wheel/training_ge5_encoderPositions.raw.ssv";
    let text = std::fs::read_to_string(windfall_test_data::find(file)?).unwrap();
    let cells = text.lines().map(|line| {
        let mut cells = line.split_whitespace().map(|c| c.parse::<f64>().unwrap());
        (cells.next().unwrap() * 1e-6, cells.next().unwrap())
    });
    Some(cells.unzip())
}

// 936 rows, 921 changes of the count of which 26 pairs are reversals, the fastest
// pair at 923.361 counts/s and the median at 330.199: NumPy 2.4.6, by np.diff.
#[test]
fn reference_rates_of_a_wheel() {
    let Some((times, counts)) = wheel() else {
        return;
    };
    assert_eq!(times.len(), 936);
    let found = edges(&times, &counts, CountTimes::Events);
    assert_eq!(found.times.len(), 921);
    let rate = edge_rate(&found, 0.0, 1.0, times[times.len() - 1]);
    let mut speeds: Vec<f64> = rate.values.iter().map(|v| v.abs()).collect();
    speeds.sort_by(f64::total_cmp);
    assert_eq!(speeds.len(), 920);
    assert_eq!(speeds.iter().filter(|v| **v == 0.0).count(), 26);
    assert!((speeds[919] - 923.361_034_164_783_6).abs() < 1e-6);
    let median = 0.5 * (speeds[459] + speeds[460]);
    assert!((median - 330.199_067_806_425_6).abs() < 1e-6);
    // Over 50 ms the wheel is slower than between its fastest two edges.
    let smooth = edge_rate(&found, 0.05, 1.0, times[times.len() - 1]);
    let fastest = smooth.values.iter().map(|v| v.abs()).fold(0.0, f64::max);
    assert!(fastest < 900.0 && fastest > 300.0, "{fastest}");
}
