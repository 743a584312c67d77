//! LabVIEW measurement files.

use crate::channels::{check_file, open_bytes, samples};
use windfall_formats::contents::{Format, TimeBase};

/// Checksums by lvm_read 1.21; it gives the times of even channels as we do.
#[test]
fn reference_real_files() {
    let files: &[(&str, &[crate::channels::Expected])] = &[
        (
            "daq_formats/lvm/short.lvm",
            &[
                (
                    "Excitation (Trigger)",
                    10,
                    0xf57c_7362_62cb_a726,
                    Some((0.0, 3.90625e-5)),
                ),
                (
                    "Response (Trigger)",
                    10,
                    0xfb18_4bf6_e3f7_8bca,
                    Some((0.0, 3.90625e-5)),
                ),
            ],
        ),
        (
            "daq_formats/lvm/long_single_header_multi_ch.lvm",
            &[
                // Twice the samples of its one header: by lvm_read, in halves.
                (
                    "F (segment 1)",
                    8192,
                    0x9ca0_b7b8_b288_bf1c,
                    Some((0.0, 0.000977)),
                ),
                (
                    "m_1 (segment 1)",
                    8192,
                    0x1166_19fe_4367_3e86,
                    Some((0.0, 0.000977)),
                ),
                (
                    "m_2 (segment 1)",
                    8192,
                    0xefcc_6015_dc83_7ed2,
                    Some((0.0, 0.000977)),
                ),
                (
                    "F (segment 2)",
                    8192,
                    0x093f_1c87_b9b6_c9e0,
                    Some((0.0, 0.000977)),
                ),
                (
                    "m_1 (segment 2)",
                    8192,
                    0xb02e_c75a_94df_bef7,
                    Some((0.0, 0.000977)),
                ),
                (
                    "m_2 (segment 2)",
                    8192,
                    0x5127_fdb1_e9f0_a75e,
                    Some((0.0, 0.000977)),
                ),
            ],
        ),
        (
            "daq_formats/lvm/multi_time_column.lvm",
            &[
                ("X_Value", 3, 0xf7f3_d70a_3d70_a3d8, None),
                (
                    "Voltage",
                    3,
                    0xbcaf_251c_193b_3a6a,
                    Some((0.0, 1.953125e-5)),
                ),
                ("X_Value (2)", 3, 0xf7f3_d70a_3d70_a3d8, None),
                (
                    "Acceleration",
                    3,
                    0x3ed6_f197_1c10_d7bc,
                    Some((0.0, 1.953125e-5)),
                ),
            ],
        ),
        (
            "daq_formats/lvm/with_comments.lvm",
            &[
                ("X_Value", 9, 0x0442_8c28_4dfc_e30f, None),
                ("Pressão ABS. (MPa)", 9, 0x3e81_ce7c_d035_3715, None),
                ("Temperatura (°C)", 9, 0x46e4_2c7e_2824_0b71, None),
                ("Volume (ml)", 9, 0x1b04_6ede_00d1_b726, None),
            ],
        ),
        (
            "impact/hrshm_ds5_lvm/Test_001.lvm",
            &[
                ("X_Value", 51200, 0x321e_a9e6_eeb9_d017, None),
                (
                    "Acceleration_0",
                    51200,
                    0x57d4_68f1_1623_2c2f,
                    Some((0.0, 1.953125e-5)),
                ),
                (
                    "Acceleration_1",
                    51200,
                    0x1986_3c89_41d2_cdaf,
                    Some((0.0, 1.953125e-5)),
                ),
                ("Untitled", 51200, 0xcc8a_4200_0000_0000, Some((0.0, 1.0))),
                ("Untitled 1", 51200, 0xe952_a9cd_8800_0000, Some((0.0, 1.0))),
                ("Untitled 2", 51200, 0x491f_cebb_98c7_e286, Some((0.0, 1.0))),
                ("Untitled 3", 51200, 0x80c8_0000_0000_0000, Some((0.0, 1.0))),
            ],
        ),
    ];
    for (file, channels) in files {
        check_file(file, Format::Lvm, channels);
    }
}

const HEADER: &str = "LabVIEW Measurement\t\nSeparator\tTab\nDecimal_Separator\t.\n\
                      Multi_Headings\tYes\nX_Columns\tNo\n***End_of_Header***\t\n\t\n";

fn segment(interval: &str, values: &str) -> String {
    format!(
        "Channels\t1\t\nSamples\t3\t\nY_Unit_Label\tN\t\nX_Dimension\tTime\t\nX0\t0.5\t\n\
         Delta_X\t{interval}\t\n***End_of_Header***\t\t\nX_Value\tF\tComment\n{values}"
    )
}

#[test]
fn closed_form_two_segments() {
    let text = format!(
        "{HEADER}{}\t\n{}",
        segment("0.25", "\t1\n\t2\n\t3\n"),
        segment("0.125", "\t4\n\t5\n")
    );
    let mut reader = open_bytes("t.lvm", text.into_bytes(), Format::Lvm).unwrap();
    let channels = reader.contents().channels.clone();
    assert_eq!(channels[0].name, "F (segment 1)");
    assert_eq!(channels[1].unit.as_deref(), Some("N"));
    let time = TimeBase::Uniform {
        start: 0.5,
        interval: 0.125,
    };
    assert_eq!(channels[1].time, time);
    let found = samples(reader.as_mut());
    assert_eq!(found, [vec![1.0, 2.0, 3.0], vec![4.0, 5.0]]);
}

/// LabVIEW's "One header only": later measurements follow without a header.
#[test]
fn closed_form_three_measurements_under_one_header() {
    let text = format!(
        "{HEADER}{}",
        segment("0.25", "\t1\n\t2\n\t3\n\t4\n\t5\n\t6\n\n\t7\n\t8\n\t9\n")
    );
    let mut reader = open_bytes("t.lvm", text.clone().into_bytes(), Format::Lvm).unwrap();
    let channels = reader.contents().channels.clone();
    let names: Vec<&str> = channels.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["F (segment 1)", "F (segment 2)", "F (segment 3)"]);
    let time = TimeBase::Uniform {
        start: 0.5,
        interval: 0.25,
    };
    assert!(channels.iter().all(|channel| channel.time == time));
    let found = samples(reader.as_mut());
    assert_eq!(found, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]]);
    // A fault is told by its line in the file.
    let text = text.replace("\t8\n", "\tdefect\n");
    let mut reader = open_bytes("t.lvm", text.into_bytes(), Format::Lvm).unwrap();
    let told = reader.read_whole(&[2]).unwrap_err().to_string();
    assert!(told.contains("line 24, column \"F\": \"defect\""), "{told}");
}

#[test]
fn rejects_files_without_headers_and_says_the_line_of_a_fault() {
    let only_file_header = HEADER.to_owned();
    let bad = format!("{HEADER}{}", segment("0.25", "\t1\n\tdefect\n\t3\n"));
    for (text, expected) in [
        (
            "LabVIEW Measurement\t\n".to_owned(),
            "no header ends with ***End_of_Header***",
        ),
        (
            only_file_header,
            "no segment with channels follows the header",
        ),
        (
            bad,
            "t.lvm, line 17, column \"F\": \"defect\" is not a number",
        ),
    ] {
        let read = open_bytes("t.lvm", text.into_bytes(), Format::Lvm)
            .and_then(|mut reader| reader.read_whole(&[0]));
        let message = read.unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    }
}
