//! The Parquet file, read back by the library's own reader.

use crate::folder::{BASE, Folder};
use parquet::basic::Type;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::{Field, Row};
use std::fs::File;

fn read(folder: &Folder, name: &str) -> (Vec<(String, Type)>, Vec<Row>) {
    let file = File::open(folder.0.join(name)).expect("it was written");
    let reader = SerializedFileReader::new(file).expect("a Parquet file");
    let metadata = reader.metadata().file_metadata();
    let expected = concat!("controller-sim ", env!("CARGO_PKG_VERSION"));
    assert_eq!(metadata.created_by(), Some(expected));
    let columns = metadata.schema_descr().columns().iter();
    let columns = columns.map(|column| (column.name().to_owned(), column.physical_type())).collect();
    let rows = reader.get_row_iter(None).expect("rows").map(|row| row.expect("a row")).collect();
    (columns, rows)
}

/// A value as the CSV file has it.
fn written(field: &Field) -> String {
    match field {
        Field::Str(text) => text.clone(),
        Field::Double(x) => format!("{x}"),
        Field::Long(n) => format!("{n}"),
        Field::Null => String::new(),
        other => panic!("{other:?}"),
    }
}

/// Fails when the two files differ in any value; gives the columns and the number of rows.
pub(crate) fn same_rows(folder: &Folder, csv: &str, parquet: &str) -> (Vec<(String, Type)>, usize) {
    let (columns, rows) = read(folder, parquet);
    let csv = folder.read(csv);
    let mut lines = csv.lines();
    let names: Vec<&str> = columns.iter().map(|(name, _)| &**name).collect();
    assert_eq!(lines.next(), Some(&*names.join(",")));
    assert_eq!(csv.lines().count(), 1 + rows.len());
    for (line, row) in lines.zip(&rows) {
        let fields: Vec<String> = row.get_column_iter().map(|(_, field)| written(field)).collect();
        assert_eq!(line, fields.join(","));
    }
    (columns, rows.len())
}

/// Both files have the same rows: more than one group of them, bad samples among them.
#[test]
fn it_has_the_rows_of_the_csv_file() {
    let folder = Folder::new("parquet");
    let bad = BASE.replacen("disturbance = 1.0", "bad_samples = 5", 1);
    folder.write("a.toml", &bad.replacen("ts = 0.01", "ts = 0.0003", 1));
    folder.write("b.toml", BASE);
    for (scenarios, several) in [(&["a.toml"][..], false), (&["a.toml", "b.toml"], true)] {
        let files = ["--csv", "s.csv", "--parquet", "s.parquet", "--force"];
        let shown = folder.done(&[&["run"], scenarios, &files[..]].concat());
        let (columns, rows) = same_rows(&folder, "s.csv", "s.parquet");
        assert!(rows > 1 << 17, "several groups of rows: {rows}");
        assert!(shown.contains(&format!("wrote s.parquet: {rows} samples\n")), "{shown}");
        for (name, physical) in &columns {
            let expected = match &**name {
                "scenario" | "case" | "controller" | "mode" => Type::BYTE_ARRAY,
                "status" => Type::INT64,
                _ => Type::DOUBLE,
            };
            assert_eq!(*physical, expected, "{name}");
        }
        assert_eq!(columns[0].0 == "scenario", several);
    }
}
