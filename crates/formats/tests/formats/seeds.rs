//! Small valid files of every format, from which damaged ones are made.

use windfall_formats::contents::Format;

/// Formats with a file each, and what the file holds: name, format, bytes.
pub fn seeds() -> Vec<(&'static str, Format, Vec<u8>)> {
    vec![
        ("text", Format::Text, text()),
        ("lvm", Format::Lvm, lvm()),
        ("tdms", Format::Tdms, tdms()),
        ("mat", Format::Mat, mat()),
        ("mat4", Format::Mat, mat4()),
        ("wav", Format::Wav, wav()),
        ("uff58", Format::Uff58, uff(false)),
        ("uff58b", Format::Uff58, uff(true)),
        ("sigrok", Format::Sigrok, sigrok()),
        ("xlsx", Format::Xlsx, archive(&xlsx_parts())),
        ("ods", Format::Ods, archive(&ods_parts())),
        ("zip", Format::Zip, archive(&zip_parts())),
        (
            "npy",
            Format::Npy,
            npy("[('t', '<f8'), ('F', '>i2', (2,)), ('s', '<U1')]", "2,", 32),
        ),
        ("npz", Format::Npy, archive(&npz_parts())),
    ]
}

/// Names and contents of the members of an archive.
pub type Parts = Vec<(&'static str, Vec<u8>)>;

/// A zip archive of members that are stored as they are, with their checksums.
pub fn archive(parts: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut archive = rawzip::ZipArchiveWriter::new(&mut bytes);
    for (name, contents) in parts {
        let (mut entry, config) = archive.new_file(name).start().unwrap();
        let mut writer = config.wrap(&mut entry);
        std::io::Write::write_all(&mut writer, contents).unwrap();
        let (_, descriptor) = writer.finish().unwrap();
        entry.finish(descriptor).unwrap();
    }
    archive.finish().unwrap();
    bytes
}

/// An array of zeros.
fn npy(descr: &str, shape: &str, bytes: usize) -> Vec<u8> {
    let descr = match descr.starts_with('[') {
        true => descr.to_owned(),
        false => format!("'{descr}'"),
    };
    let header = format!("{{'descr': {descr}, 'fortran_order': False, 'shape': ({shape}), }}\n");
    let length = (header.len() as u16).to_le_bytes();
    le(&[
        b"\x93NUMPY\x01\x00",
        &length,
        header.as_bytes(),
        &vec![0; bytes],
    ])
}

pub fn npz_parts() -> Parts {
    vec![
        ("a/b.npy", npy("<c8", "2, 2", 32)),
        ("fs.npy", npy("<i4", "", 4)),
    ]
}

/// A sheet with shared and inline texts, a date, an error, a formula and blank cells.
pub fn xlsx_parts() -> Parts {
    let main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main";
    let of = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
    let package = "http://schemas.openxmlformats.org/package/2006/relationships";
    let workbook = format!(
        "<workbook xmlns=\"{main}\" xmlns:r=\"{of}\"><sheets><sheet name=\"a\" sheetId=\"1\" \
         r:id=\"rId1\"/></sheets></workbook>"
    );
    let relations = |kind: &str, target: &str| {
        format!(
            "<Relationships xmlns=\"{package}\"><Relationship Id=\"rId1\" \
             Type=\"{of}/{kind}\" Target=\"{target}\"/></Relationships>"
        )
    };
    let sheet = format!(
        "<worksheet xmlns=\"{main}\"><dimension ref=\"A1:C5\"/><sheetData>\
         <row r=\"1\"><c r=\"A1\" t=\"s\"><v>0</v></c>\
         <c r=\"B1\" t=\"inlineStr\"><is><t>F (N)</t></is></c>\
         <c r=\"C1\" t=\"str\"><v>When</v></c></row>\
         <row r=\"2\"><c r=\"A2\"><v>0.5</v></c><c r=\"B2\"><v>-1e3</v></c>\
         <c r=\"C2\" s=\"1\"><v>45615.25</v></c></row>\
         <row r=\"3\"><c r=\"A3\"><f>A2+1</f><v>1.5</v></c><c r=\"B3\" t=\"e\"><v>#N/A</v></c>\
         <c r=\"C3\" s=\"1\"><v>45615.5</v></c></row>\
         <row r=\"4\"><c r=\"A4\" t=\"s\"><v>1</v></c></row>\
         <row r=\"5\"><c r=\"B5\" t=\"b\"><v>1</v></c></row></sheetData></worksheet>"
    );
    let strings = format!(
        "<sst xmlns=\"{main}\" count=\"2\" uniqueCount=\"2\"><si><t>Zeit</t></si>\
         <si><r><t>2,</t></r><r><t>25</t></r></si></sst>"
    );
    let styles = format!(
        "<styleSheet xmlns=\"{main}\"><cellXfs count=\"2\"><xf numFmtId=\"0\"/>\
         <xf numFmtId=\"22\" applyNumberFormat=\"1\"/></cellXfs></styleSheet>"
    );
    let rest = format!(
        "<Relationships xmlns=\"{package}\"><Relationship Id=\"rId1\" Type=\"{of}/worksheet\" \
         Target=\"worksheets/sheet1.xml\"/></Relationships>"
    );
    vec![
        (
            "_rels/.rels",
            relations("officeDocument", "xl/workbook.xml").into(),
        ),
        ("xl/workbook.xml", workbook.into()),
        ("xl/_rels/workbook.xml.rels", rest.into()),
        ("xl/worksheets/sheet1.xml", sheet.into()),
        ("xl/sharedStrings.xml", strings.into()),
        ("xl/styles.xml", styles.into()),
    ]
}

/// Two sheets, with repeated and covered cells, a remark, a date and an entity.
pub fn ods_parts() -> Parts {
    let contents = "<office:document-content><office:body><office:spreadsheet>\
        <table:table table:name=\"a\"><table:table-column/><table:table-row>\
        <table:table-cell office:value-type=\"string\"><text:p>t<text:s/>&amp;</text:p>\
        </table:table-cell><table:covered-table-cell table:number-columns-repeated=\"2\"/>\
        <table:table-cell office:value-type=\"string\"><office:annotation><text:p>no</text:p>\
        </office:annotation><text:p>F (N)</text:p></table:table-cell></table:table-row>\
        <table:table-row table:number-rows-repeated=\"2\"><table:table-cell \
        office:value-type=\"float\" office:value=\"0.5\"/><table:table-cell \
        table:number-columns-repeated=\"2\"/><table:table-cell office:value-type=\"time\" \
        office:time-value=\"PT01H00M00.5S\"/></table:table-row>\
        <table:table-row table:number-rows-repeated=\"9\"><table:table-cell \
        table:number-columns-repeated=\"9\"/></table:table-row></table:table>\
        <table:table table:name=\"b\"><table:table-row><table:table-cell \
        office:value-type=\"float\" office:value=\"1\" table:number-columns-repeated=\"2\"/>\
        <table:table-cell office:value-type=\"date\" office:date-value=\"2024-11-19T20:00:00\"/>\
        </table:table-row></table:table></office:spreadsheet></office:body>\
        </office:document-content>";
    let kind: &[u8] = b"application/vnd.oasis.opendocument.spreadsheet";
    vec![
        ("mimetype", kind.to_vec()),
        ("content.xml", contents.into()),
    ]
}

/// Two tables, one of two segments, and what is no table.
pub fn zip_parts() -> Parts {
    vec![
        (
            "a.csv",
            b"t (s),F (N)\n0,1\n1,2\n2,3\nt (s),F (N)\n0,1\n1,2\n2,3\n".to_vec(),
        ),
        ("meta/device.csv", b"property,value\nversion,1\n".to_vec()),
        ("b/c.txt", "x;y\n1,5;2\n2,5;3\n".into()),
        ("readme.md", b"nothing".to_vec()),
    ]
}

fn text() -> Vec<u8> {
    "Rig;A\n# a comment\nZeit (s);\"Kraft\";Ort\n(s);(N);(mm)\n\
     0,5;1.234,25;\"1\"\n0,6;-2;\n0,7;3e-5;7\n"
        .as_bytes()
        .to_vec()
}

fn lvm() -> Vec<u8> {
    "LabVIEW Measurement\t\nSeparator\tTab\nDecimal_Separator\t.\nMulti_Headings\tYes\n\
     X_Columns\tOne\n***End_of_Header***\t\n\t\nChannels\t2\t\nSamples\t2\t2\t\n\
     Y_Unit_Label\tN\tg\t\nX_Dimension\tTime\tTime\t\nX0\t0.5\t0.5\t\nDelta_X\t0.1\t0.1\t\n\
     ***End_of_Header***\t\t\nX_Value\tF\ta\tComment\n0.5\t1\t2\n0.6\t3\t4\tok\n\t\n\
     Channels\t1\t\nX0\t0\t\nDelta_X\t1\t\n***End_of_Header***\t\nX_Value\tF\tComment\n0\t5\n"
        .as_bytes()
        .to_vec()
}

pub fn le(parts: &[&[u8]]) -> Vec<u8> {
    parts.concat()
}

fn string(text: &str) -> Vec<u8> {
    le(&[&(text.len() as u32).to_le_bytes(), text.as_bytes()])
}

/// Contiguous with a linear and a table scale, then interleaved, then a repeated
/// segment, then DAQmx.
fn tdms() -> Vec<u8> {
    let u32s = |values: &[u32]| {
        values
            .iter()
            .flat_map(|v| v.to_le_bytes())
            .collect::<Vec<u8>>()
    };
    let values = |code: u32, count: u64| le(&[&u32s(&[20, code, 1]), &count.to_le_bytes()]);
    let text = |name: &str, value: &str| le(&[&string(name), &u32s(&[0x20]), &string(value)]);
    let number = |name: &str, value: f64| le(&[&string(name), &u32s(&[10]), &value.to_le_bytes()]);
    let count = |name: &str, value: u32| le(&[&string(name), &u32s(&[7, value])]);
    let object = |path: &str, index: &[u8], properties: &[Vec<u8>]| {
        let length = u32s(&[properties.len() as u32]);
        le(&[&string(path), index, &length, &properties.concat()])
    };
    let segment = |flags: u32, objects: &[Vec<u8>], raw: &[u8]| {
        let metadata = match flags & 2 {
            0 => Vec::new(),
            _ => le(&[&u32s(&[objects.len() as u32]), &objects.concat()]),
        };
        let lengths = [(metadata.len() + raw.len()) as u64, metadata.len() as u64];
        let lengths: Vec<u8> = lengths.iter().flat_map(|l| l.to_le_bytes()).collect();
        le(&[b"TDSm", &u32s(&[flags, 4713]), &lengths, &metadata, raw])
    };
    let scales = [
        number("wf_increment", 0.5),
        text("unit_string", "N"),
        count("NI_Number_Of_Scales", 2),
        text("NI_Scale[0]_Scale_Type", "Linear"),
        number("NI_Scale[0]_Linear_Slope", 2.0),
        number("NI_Scale[0]_Linear_Y_Intercept", 1.0),
        text("NI_Scale[1]_Scale_Type", "Table"),
        count("NI_Scale[1]_Table_Input_Source", 0),
        count("NI_Scale[1]_Table_Pre_Scaled_Values_Size", 2),
        count("NI_Scale[1]_Table_Scaled_Values_Size", 2),
        number("NI_Scale[1]_Table_Pre_Scaled_Values[0]", 0.0),
        number("NI_Scale[1]_Table_Pre_Scaled_Values[1]", 10.0),
        number("NI_Scale[1]_Table_Scaled_Values[0]", 0.0),
        number("NI_Scale[1]_Table_Scaled_Values[1]", 5.0),
    ];
    let a = object("/'g'/'a'", &values(2, 2), &scales);
    let b = object("/'g'/'b'", &values(0x44, 1), &[]);
    let c = object("/'g'/'a'", &[0; 4], &[]);
    let d = object("/'g'/'c'", &values(5, 2), &[]);
    let daqmx = le(&[
        &u32s(&[0x1269, u32::MAX, 1, 2, 0, 1]),
        &u32s(&[3, 0, 0, 0, 0]),
        &u32s(&[1, 2]),
    ]);
    let e = object("/'g'/'e'", &daqmx, &[]);
    le(&[
        &segment(
            2 | 4 | 8,
            &[a, b],
            &[1, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 128, 9, 0, 0, 0, 0, 0, 0, 0],
        ),
        &segment(2 | 4 | 8 | 32, &[c, d], &[3, 0, 7, 4, 0, 8]),
        &segment(8 | 32, &[], &[5, 0, 9, 6, 0, 10]),
        &segment(2 | 4 | 8 | 128, &[e], &[1, 0, 2, 0]),
    ])
}

/// A vector, a structure with a field, a cell with a text.
fn mat() -> Vec<u8> {
    let element = |code: u32, data: &[u8]| {
        let mut bytes = le(&[
            &code.to_le_bytes(),
            &(data.len() as u32).to_le_bytes(),
            data,
        ]);
        bytes.resize(bytes.len().next_multiple_of(8), 0);
        bytes
    };
    let array = |class: u32, columns: u32, name: &str, rest: &[u8]| {
        let flags = le(&[&class.to_le_bytes(), &[0; 4]]);
        let size = le(&[&1_u32.to_le_bytes(), &columns.to_le_bytes()]);
        let parts = [
            element(6, &flags),
            element(5, &size),
            element(1, name.as_bytes()),
        ];
        element(14, &le(&[&parts.concat(), rest]))
    };
    let doubles = |values: &[f64]| {
        element(
            9,
            &values
                .iter()
                .flat_map(|v| v.to_le_bytes())
                .collect::<Vec<u8>>(),
        )
    };
    let vector = array(6, 3, "F", &doubles(&[1.0, 2.0, 3.0]));
    let inner = array(6, 2, "", &doubles(&[4.0, 5.0]));
    // A small element: its length stands in the same word.
    let names = le(&[&[5, 0, 4, 0, 8, 0, 0, 0], &element(1, b"time\0\0\0\0")]);
    let structure = array(2, 1, "s", &le(&[&names, &inner]));
    let text = array(4, 2, "", &element(16, b"ab"));
    let cell = array(1, 1, "c", &text);
    let mut bytes = b"MATLAB 5.0 MAT-file".to_vec();
    bytes.resize(124, b' ');
    le(&[&bytes, &[0, 1, b'I', b'M'], &vector, &structure, &cell])
}

fn mat4() -> Vec<u8> {
    let header: Vec<u8> = [0_u32, 2, 2, 1, 2]
        .iter()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    let numbers: Vec<u8> = (0..8).flat_map(|v| f64::from(v).to_le_bytes()).collect();
    le(&[&header, b"z\0", &numbers])
}

fn wav() -> Vec<u8> {
    let chunk = |name: &[u8], data: &[u8]| le(&[name, &(data.len() as u32).to_le_bytes(), data]);
    let format: [&[u8]; 6] = [
        &1_u16.to_le_bytes(),
        &2_u16.to_le_bytes(),
        &8000_u32.to_le_bytes(),
        &32000_u32.to_le_bytes(),
        &4_u16.to_le_bytes(),
        &16_u16.to_le_bytes(),
    ];
    let body = le(&[
        b"WAVE",
        &chunk(b"LIST", b"INFOISFT\x04\0\0\0rig1"),
        &chunk(b"fmt ", &format.concat()),
        &chunk(b"data", &[1, 2, 3, 4, 5, 6, 7, 8]),
    ]);
    chunk(b"RIFF", &body)
}

fn uff(binary: bool) -> Vec<u8> {
    let title = match binary {
        true => "    58b     1     2          11          16     0     0           0           0",
        false => "    58",
    };
    let header = "NONE\nNONE\n20-Nov-26\nNONE\nNONE\n\
        \x20   1         0    0         0 NONE               1   3 NONE               0   0\n\
        \x20        2         4         1  0.00000E+00  5.00000E-02  0.00000E+00\n\
        \x20       17    0    0    0 Time                 s                   \n\
        \x20       13    0    0    0 Force                N                   \n\
        \x20        0    0    0    0 NONE                 NONE                \n\
        \x20        0    0    0    0 NONE                 NONE                \n";
    let data: Vec<u8> = match binary {
        true => [1.5_f32, -2.0, 3.0, 4.0]
            .iter()
            .flat_map(|v| v.to_le_bytes())
            .collect(),
        false => b"  1.50000E+00 -2.00000E+00  3.00000E+00  4.00000E+00\n".to_vec(),
    };
    let other = "    -1\n   164\n         1  SI: mks\n    -1\n    -1\n";
    le(&[
        other.as_bytes(),
        title.as_bytes(),
        b"\n",
        header.as_bytes(),
        &data,
        b"\n    -1\n",
    ])
}

/// A zip archive of two entries that are stored as they are.
fn sigrok() -> Vec<u8> {
    let metadata: &[u8] = b"[device 1]\ncapturefile=logic-1\nsamplerate=1 MHz\n\
        total probes=2\nprobe1=A\nprobe2=B\nunitsize=1\n";
    let entries: [(&[u8], &[u8]); 2] = [(b"metadata", metadata), (b"logic-1-1", &[0, 1, 3, 2])];
    let (mut bytes, mut directory) = (Vec::new(), Vec::new());
    for (name, data) in entries {
        let size = (data.len() as u32).to_le_bytes();
        let name_length = (name.len() as u16).to_le_bytes();
        let offset = (bytes.len() as u32).to_le_bytes();
        bytes.extend(le(&[
            b"PK\x03\x04",
            &[0; 14],
            &size,
            &size,
            &name_length,
            &[0; 2],
            name,
            data,
        ]));
        let lengths = le(&[&name_length, &[0; 12]]);
        directory.extend(le(&[
            b"PK\x01\x02",
            &[0; 16],
            &size,
            &size,
            &lengths,
            &offset,
            name,
        ]));
    }
    let place = le(&[
        &(directory.len() as u32).to_le_bytes(),
        &(bytes.len() as u32).to_le_bytes(),
    ]);
    le(&[&bytes, &directory, b"PK\x05\x06", &[0; 8], &place, &[0; 2]])
}
