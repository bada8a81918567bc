//! The table of a sweep: a row for each run, with its parameters and its results.

use std::io;
use std::path::Path;
use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as PhysicalType};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{Type, TypePtr};
use raypencil_files::{FileError, write_atomically};
use serde_json::Value;

use crate::formula::is_formula;
use crate::record::Outcome;
use crate::run::Finished;

/// Values of a column, of one type. `None`: the run has no such value.
#[derive(Debug, Clone, PartialEq)]
pub enum Cells {
    /// Integers.
    Integers(Vec<Option<i64>>),
    /// Numbers, if at least one is no integer.
    Numbers(Vec<Option<f64>>),
    /// Truths.
    Truths(Vec<Option<bool>>),
    /// Texts, and values of several types.
    Texts(Vec<Option<String>>),
}

/// A column of the table.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Its name: `run`, a key of the scene file, or the name of a result.
    pub name: String,
    /// Its values, by run.
    pub cells: Cells,
}

/// The table of a sweep.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepTable {
    /// `run`, the parameters in their order, the results in the order in which they come, and `refused` if a run was.
    pub columns: Vec<Column>,
    /// Number of parameters.
    pub parameters: usize,
}

impl SweepTable {
    /// The table of a finished sweep.
    pub fn new(finished: &Finished) -> Self {
        let runs = finished.outcomes.len();
        let sweep = &finished.sweep;
        let mut columns =
            vec![Column { name: "run".into(), cells: Cells::Integers((0..runs as i64).map(Some).collect()) }];
        let keys = sweep.keys();
        let rows: Vec<Vec<&str>> = (0..runs as u64).map(|run| sweep.values(run)).collect();
        for (at, key) in keys.iter().enumerate() {
            let texts = rows.iter().map(|row| row[at]);
            let texts = texts.map(|text| Some(text.to_string()).filter(|text| !text.is_empty())).collect();
            columns.push(Column { name: key.to_string(), cells: typed(texts) });
        }
        let mut names: Vec<&str> = Vec::new();
        let mut values: Vec<Vec<Value>> = Vec::new();
        for (run, outcome) in finished.outcomes.iter().enumerate() {
            let Outcome::Results(results) = outcome else { continue };
            for (place, (name, value)) in results.iter().enumerate() {
                // Runs have the same results in the same order, almost always.
                let at = match names.get(place) {
                    Some(own) if own == name => place,
                    _ => names.iter().position(|own| own == name).unwrap_or(names.len()),
                };
                if at == names.len() {
                    names.push(name);
                    values.push(vec![Value::Null; runs]);
                }
                values[at][run] = value.clone();
            }
        }
        columns.extend(
            names
                .into_iter()
                .zip(values)
                .map(|(name, values)| Column { name: name.into(), cells: of_json(values) }),
        );
        if finished.refused().next().is_some() {
            let mut why = vec![None; runs];
            finished.refused().for_each(|(run, reason)| why[run as usize] = Some(reason.to_string()));
            columns.push(Column { name: "refused".into(), cells: Cells::Texts(why) });
        }
        Self { columns, parameters: keys.len() }
    }

    /// The column of that name.
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name == name)
    }

    /// Number of runs.
    pub fn runs(&self) -> usize {
        self.columns[0].cells.len()
    }

    /// The table as CSV. A missing value is empty. A text that a spreadsheet would compute has an apostrophe before it.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write_csv(&self, path: &Path) -> Result<(), FileError> {
        write_atomically(path, |file| {
            let mut writer = csv::Writer::from_writer(file);
            writer.write_record(self.columns.iter().map(|column| &column.name))?;
            for run in 0..self.runs() {
                writer.write_record(self.columns.iter().map(|column| column.csv(run)))?;
            }
            writer.flush()
        })
    }

    /// The table as Parquet, with a type for each column.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write_parquet(&self, path: &Path) -> Result<(), FileError> {
        let bytes = self.parquet().map_err(|error| FileError::io(path, "write", io::Error::other(error)))?;
        write_atomically(path, |file| file.write_all(&bytes))
    }

    fn parquet(&self) -> parquet::errors::Result<Vec<u8>> {
        let fields: Vec<TypePtr> = self.columns.iter().map(Column::field).collect::<Result<_, _>>()?;
        let schema = Arc::new(Type::group_type_builder("sweep").with_fields(fields).build()?);
        let properties = Arc::new(WriterProperties::builder().build());
        let mut writer = SerializedFileWriter::new(Vec::new(), schema, properties)?;
        let mut group = writer.next_row_group()?;
        for column in &self.columns {
            column.cells.write(&mut group)?;
        }
        group.close()?;
        writer.into_inner()
    }
}

impl Column {
    /// A cell of the file for spreadsheets.
    fn csv(&self, run: usize) -> String {
        let text = self.cells.text(run);
        if is_formula(&text) { format!("'{text}") } else { text }
    }

    fn field(&self) -> parquet::errors::Result<TypePtr> {
        let (physical, logical) = match self.cells {
            Cells::Integers(_) => (PhysicalType::INT64, None),
            Cells::Numbers(_) => (PhysicalType::DOUBLE, None),
            Cells::Truths(_) => (PhysicalType::BOOLEAN, None),
            Cells::Texts(_) => (PhysicalType::BYTE_ARRAY, Some(LogicalType::String)),
        };
        let field = Type::primitive_type_builder(&self.name, physical).with_repetition(Repetition::OPTIONAL);
        Ok(Arc::new(field.with_logical_type(logical).build()?))
    }
}

impl Cells {
    fn len(&self) -> usize {
        match self {
            Self::Integers(cells) => cells.len(),
            Self::Numbers(cells) => cells.len(),
            Self::Truths(cells) => cells.len(),
            Self::Texts(cells) => cells.len(),
        }
    }

    /// The value of a run as text; empty if there is none.
    pub fn text(&self, run: usize) -> String {
        match self {
            Self::Integers(cells) => cells[run].map(|value| value.to_string()),
            Self::Numbers(cells) => cells[run].map(|value| value.to_string()),
            Self::Truths(cells) => cells[run].map(|value| value.to_string()),
            Self::Texts(cells) => cells[run].clone(),
        }
        .unwrap_or_default()
    }

    /// The value of a run as a number; a truth is 0 or 1.
    pub fn number(&self, run: usize) -> Option<f64> {
        match self {
            Self::Integers(cells) => cells[run].map(|value| value as f64),
            Self::Numbers(cells) => cells[run],
            Self::Truths(cells) => cells[run].map(|value| f64::from(u8::from(value))),
            Self::Texts(_) => None,
        }
    }

    fn write(&self, group: &mut SerializedRowGroupWriter<'_, Vec<u8>>) -> parquet::errors::Result<()> {
        fn parts<T: Clone>(cells: &[Option<T>]) -> (Vec<T>, Vec<i16>) {
            let levels = cells.iter().map(|cell| i16::from(cell.is_some())).collect();
            (cells.iter().flatten().cloned().collect(), levels)
        }
        let mut column = group.next_column()?.expect("as many columns as the schema has");
        match self {
            Self::Integers(cells) => {
                let (values, levels) = parts(cells);
                column.typed::<Int64Type>().write_batch(&values, Some(&levels), None)?;
            }
            Self::Numbers(cells) => {
                let (values, levels) = parts(cells);
                column.typed::<DoubleType>().write_batch(&values, Some(&levels), None)?;
            }
            Self::Truths(cells) => {
                let (values, levels) = parts(cells);
                column.typed::<BoolType>().write_batch(&values, Some(&levels), None)?;
            }
            Self::Texts(cells) => {
                let (values, levels) = parts(cells);
                let values: Vec<ByteArray> =
                    values.iter().map(|text| ByteArray::from(text.as_str())).collect();
                column.typed::<ByteArrayType>().write_batch(&values, Some(&levels), None)?;
            }
        }
        column.close()
    }
}

/// Texts as the narrowest type that holds them all.
fn typed(texts: Vec<Option<String>>) -> Cells {
    fn all<T: std::str::FromStr>(texts: &[Option<String>]) -> Option<Vec<Option<T>>> {
        texts
            .iter()
            .map(|text| text.as_ref().map(|text| text.parse().ok()).map_or(Some(None), |it| it.map(Some)))
            .collect()
    }
    if let Some(cells) = all::<i64>(&texts) {
        Cells::Integers(cells)
    } else if let Some(cells) = all::<f64>(&texts) {
        Cells::Numbers(cells)
    } else if let Some(cells) = all::<bool>(&texts) {
        Cells::Truths(cells)
    } else {
        Cells::Texts(texts)
    }
}

/// JSON values as the narrowest type that holds them all.
fn of_json(values: Vec<Value>) -> Cells {
    let is_each = |is: fn(&Value) -> bool| values.iter().all(|value| value.is_null() || is(value));
    if is_each(Value::is_i64) {
        Cells::Integers(values.iter().map(Value::as_i64).collect())
    } else if is_each(Value::is_number) {
        Cells::Numbers(values.iter().map(Value::as_f64).collect())
    } else if is_each(Value::is_boolean) {
        Cells::Truths(values.iter().map(Value::as_bool).collect())
    } else {
        let text = |value: Value| match value {
            Value::Null => None,
            Value::String(text) => Some(text),
            other => Some(other.to_string()),
        };
        Cells::Texts(values.into_iter().map(text).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_spreadsheet_would_compute_is_a_text_in_csv() {
        let cells = ["=cmd|' /C calc'!A0", "@SUM(1)", "+x", "-3", "-1e5", "+7", "a=b", "", "\t=1", "\r=1"];
        let texts = cells.iter().map(|text| Some(text.to_string())).collect();
        let column = Column { name: "a".into(), cells: Cells::Texts(texts) };
        let written: Vec<String> = (0..cells.len()).map(|run| column.csv(run)).collect();
        assert_eq!(
            written,
            ["'=cmd|' /C calc'!A0", "'@SUM(1)", "'+x", "-3", "-1e5", "+7", "a=b", "", "'\t=1", "'\r=1"]
        );
    }
}
