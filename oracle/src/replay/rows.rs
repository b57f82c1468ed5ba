//! The rows of a Parquet file as lines: a row of the column `line` is a line, and a row of the columns `request` and `reply` is two, of which one
//! may be empty.
//!
//! Rows are read in batches, column by column. A page is the most that is held at once, whatever the file's size.

use std::cell::Cell;
use std::fs::File;
use std::io::{self, Read};
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

use parquet::basic::{Compression, ConvertedType, LogicalType, Type};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{ByteArray, ByteArrayType};
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader as _, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;

/// How many rows are read at once.
const BATCH: usize = 256;

/// A column of the row group at hand.
struct Column {
    reader: ColumnReaderImpl<ByteArrayType>,
    /// Whether a row may have no value.
    optional: bool,
    /// The values of the batch that are there, and for each row whether it has one, if it may have none.
    values: Vec<ByteArray>,
    there: Vec<i16>,
    /// The row of the batch and the value that come next.
    row: usize,
    value: usize,
}

/// The rows of a file as lines.
pub(super) struct Rows {
    file: SerializedFileReader<File>,
    /// The places of the columns that are read, in the order of their lines.
    places: Vec<usize>,
    /// The row group that comes next, and what is left of the one at hand: rows, and rows of the batch.
    group: usize,
    left: usize,
    batch: usize,
    columns: Vec<Column>,
    /// The lines of the row at hand, and how far they are given out.
    text: Vec<u8>,
    given: usize,
}

thread_local! {
    /// Whether this thread is in the library, where a panic is an error and is not printed.
    static WITHIN: Cell<bool> = const { Cell::new(false) };
}

/// Calls the library. It gives an error for most files that are damaged, and panics for a few: that is an error as well.
fn guarded<T>(call: impl FnOnce() -> Result<T, ParquetError>) -> io::Result<T> {
    static QUIET: Once = Once::new();
    QUIET.call_once(|| {
        let print = take_hook();
        set_hook(Box::new(move |info| {
            if !WITHIN.get() {
                print(info);
            }
        }));
    });
    WITHIN.set(true);
    let result = catch_unwind(AssertUnwindSafe(call));
    WITHIN.set(false);
    match result {
        Ok(result) => result.map_err(|error| {
            let error = error.to_string();
            let what = error.strip_prefix("Parquet error: ").unwrap_or(&error);
            io::Error::other(format!("it is no Parquet, or damaged: {what}"))
        }),
        Err(_) => Err(io::Error::other("it is no Parquet, or damaged")),
    }
}

impl Rows {
    /// Opens a file and finds its columns.
    ///
    /// # Errors
    /// It is no Parquet, is damaged, or has other columns: what is there, and what would be right.
    pub(super) fn open(file: File) -> io::Result<Self> {
        let file = guarded(|| SerializedFileReader::new(file))?;
        let places = places(file.metadata().file_metadata().schema_descr().columns().iter().map(AsRef::as_ref))?;
        let (columns, text) = (Vec::new(), Vec::new());
        Ok(Self { file, places, group: 0, left: 0, batch: 0, columns, text, given: 0 })
    }

    /// How many lines a row has.
    pub(super) fn lines_of_a_row(&self) -> u64 {
        self.places.len() as u64
    }

    /// Makes the lines of the next row; false at the end of the file.
    fn row(&mut self) -> io::Result<bool> {
        self.text.clear();
        self.given = 0;
        while self.batch == 0 {
            if self.left == 0 && !self.next_group()? {
                return Ok(false);
            }
            let rows = self.left.min(BATCH);
            for column in &mut self.columns {
                guarded(|| column.fill(rows))?;
            }
            (self.left, self.batch) = (self.left - rows, rows);
        }
        self.batch -= 1;
        for column in &mut self.columns {
            if let Some(value) = column.next()? {
                // A line break between two words of JSON is a space like another. So a row is a line.
                self.text
                    .extend(value.data().iter().map(|byte| if matches!(byte, b'\n' | b'\r') { b' ' } else { *byte }));
            }
            self.text.push(b'\n');
        }
        Ok(true)
    }

    fn next_group(&mut self) -> io::Result<bool> {
        let (file, places, number) = (&self.file, &self.places, self.group);
        if number >= file.num_row_groups() {
            return Ok(false);
        }
        is_read(file, number, places)?;
        let (rows, columns) = guarded(|| {
            let group = file.get_row_group(number)?;
            let rows = usize::try_from(group.metadata().num_rows())?;
            let open = |place: &usize| {
                let optional = group.metadata().column(*place).column_descr().max_def_level() > 0;
                let ColumnReader::ByteArrayColumnReader(reader) = group.get_column_reader(*place)? else {
                    return Err(ParquetError::General("a column of text has other values".to_owned()));
                };
                Ok(Column { reader, optional, values: Vec::new(), there: Vec::new(), row: 0, value: 0 })
            };
            Ok((rows, places.iter().map(open).collect::<Result<Vec<_>, ParquetError>>()?))
        })?;
        (self.group, self.left, self.columns) = (number + 1, rows, columns);
        Ok(true)
    }
}

impl Column {
    /// Reads so many rows.
    fn fill(&mut self, rows: usize) -> Result<(), ParquetError> {
        self.values.clear();
        self.there.clear();
        (self.row, self.value) = (0, 0);
        let mut read = 0;
        while read < rows {
            let there = self.optional.then_some(&mut self.there);
            let (more, _, _) = self.reader.read_records(rows - read, there, None, &mut self.values)?;
            if more == 0 {
                return Err(ParquetError::EOF("a column has fewer rows than its row group".to_owned()));
            }
            read += more;
        }
        Ok(())
    }

    /// The value of the next row of the batch; none: it has none.
    fn next(&mut self) -> io::Result<Option<&ByteArray>> {
        let less = || io::Error::other("it is damaged: a column has fewer values than rows");
        let there = !self.optional || *self.there.get(self.row).ok_or_else(less)? > 0;
        self.row += 1;
        if !there {
            return Ok(None);
        }
        self.value += 1;
        self.values.get(self.value - 1).map(Some).ok_or_else(less)
    }
}

impl Read for Rows {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        if self.given == self.text.len() && !self.row()? {
            return Ok(0);
        }
        let rest = &self.text[self.given..];
        let count = rest.len().min(into.len());
        into[..count].copy_from_slice(&rest[..count]);
        self.given += count;
        Ok(count)
    }
}

const RIGHT: &str = "a log has one column of text `line`, or two, `request` and `reply`";

/// Whether the columns of a row group are packed in a way that is read.
fn is_read(file: &SerializedFileReader<File>, group: usize, places: &[usize]) -> io::Result<()> {
    let columns = file.metadata().row_group(group).columns();
    for column in places.iter().filter_map(|place| columns.get(*place)) {
        // The library counts on it.
        let place = column.dictionary_page_offset().unwrap_or(column.data_page_offset());
        if place < 0 || column.compressed_size() < 0 {
            return Err(io::Error::other("it is damaged: a column has a place or a size below 0"));
        }
        let packed = column.compression();
        if !matches!(packed, Compression::UNCOMPRESSED | Compression::SNAPPY) {
            let (name, packed) = (column.column_path().string(), packed.to_string());
            let packed = packed.split('(').next().unwrap_or_default();
            let what = format!("its column `{name}` is packed by {packed}; UNCOMPRESSED and SNAPPY are read");
            return Err(io::Error::other(what));
        }
    }
    Ok(())
}

/// The places of the columns that are read.
fn places<'a>(columns: impl Iterator<Item = &'a ColumnDescriptor>) -> io::Result<Vec<usize>> {
    let columns: Vec<_> = columns.collect();
    let find = |name: &str| {
        let place = columns.iter().position(|column| column.path().string() == name);
        place.map(|place| is_text(columns[place]).map(|()| place)).transpose()
    };
    match (find("line")?, find("request")?, find("reply")?) {
        (Some(line), None, None) => Ok(vec![line]),
        (None, Some(request), Some(reply)) => Ok(vec![request, reply]),
        (Some(_), ..) => Err(io::Error::other(format!("it has `line` and `request` or `reply` as well; {RIGHT}"))),
        _ => {
            let mut names: Vec<_> = columns.iter().take(10).map(|column| column.path().string()).collect();
            if columns.len() > names.len() {
                names.push("…".to_owned());
            }
            Err(io::Error::other(format!("its columns are {}; {RIGHT}", names.join(", "))))
        }
    }
}

/// Whether a column has one text in each row, or none.
fn is_text(column: &ColumnDescriptor) -> io::Result<()> {
    let text = column.physical_type() == Type::BYTE_ARRAY
        && (matches!(column.converted_type(), ConvertedType::UTF8 | ConvertedType::JSON | ConvertedType::NONE)
            || matches!(column.logical_type_ref(), Some(LogicalType::String | LogicalType::Json)));
    if text && column.max_rep_level() == 0 && column.max_def_level() <= 1 {
        return Ok(());
    }
    let (name, kind) = (column.name(), column.physical_type());
    Err(io::Error::other(format!("its column `{name}` is of type {kind} or has many values in a row; {RIGHT}")))
}

#[cfg(test)]
mod tests {
    use std::fs::File;
    use std::io::{Read as _, Seek as _, Write as _};
    use std::sync::Arc;

    use parquet::basic::Compression;
    use parquet::data_type::{ByteArray, ByteArrayType, Int64Type};
    use parquet::file::properties::WriterProperties;
    use parquet::file::writer::SerializedFileWriter;
    use parquet::schema::parser::parse_message_type;

    use super::{BATCH, Rows};
    use crate::conform::random::Random;

    fn file(bytes: &[u8]) -> File {
        let mut file = tempfile::tempfile().expect("a file");
        file.write_all(bytes).and_then(|()| file.rewind()).expect("it is written");
        file
    }

    /// A file with a column of numbers and these columns of text, in row groups of so many rows.
    fn written(columns: &[(&str, &[Option<&str>])], rows: usize, packed: Compression) -> Vec<u8> {
        let text = |(name, _): &(&str, &[Option<&str>])| format!("optional binary {name} (STRING);");
        let schema = format!("message log {{ required int64 time; {} }}", columns.iter().map(text).collect::<String>());
        let schema = Arc::new(parse_message_type(&schema).expect("a schema"));
        let properties = Arc::new(WriterProperties::builder().set_compression(packed).build());
        let mut bytes = Vec::new();
        let mut out = SerializedFileWriter::new(&mut bytes, schema, properties).expect("a writer");
        let all = columns.first().map_or(0, |(_, values)| values.len());
        for from in (0..all).step_by(rows) {
            let piece = from..(from + rows).min(all);
            let mut group = out.next_row_group().expect("a group");
            let mut time = group.next_column().expect("it writes").expect("a column");
            let times: Vec<i64> = piece.clone().map(|row| i64::try_from(row).expect("small")).collect();
            time.typed::<Int64Type>().write_batch(&times, None, None).expect("it writes");
            time.close().expect("it writes");
            for (_, values) in columns {
                let values = &values[piece.clone()];
                let there: Vec<i16> = values.iter().map(|value| value.is_some().into()).collect();
                let values: Vec<ByteArray> = values.iter().flatten().map(|value| ByteArray::from(*value)).collect();
                let mut column = group.next_column().expect("it writes").expect("a column");
                column.typed::<ByteArrayType>().write_batch(&values, Some(&there), None).expect("it writes");
                column.close().expect("it writes");
            }
            group.close().expect("it writes");
        }
        out.close().expect("it writes");
        bytes
    }

    fn read(bytes: &[u8]) -> std::io::Result<String> {
        let mut text = Vec::new();
        Rows::open(file(bytes))?.read_to_end(&mut text)?;
        Ok(String::from_utf8_lossy(&text).into_owned())
    }

    #[test]
    fn rows_are_lines() {
        let many: Vec<String> = (0..3 * BATCH + 7).map(|row| format!("{{\"row\": {row}}}")).collect();
        let mut lines: Vec<Option<&str>> = many.iter().map(|line| Some(line.as_str())).collect();
        (lines[3], lines[BATCH]) = (None, Some("{\n\r}"));
        let right: String = lines.iter().map(|line| line.unwrap_or("").replace(['\n', '\r'], " ") + "\n").collect();
        for (rows, packed) in
            [(10_000, Compression::SNAPPY), (100, Compression::UNCOMPRESSED), (1, Compression::SNAPPY)]
        {
            assert_eq!(read(&written(&[("line", &lines)], rows, packed)).expect("it is read"), right);
        }
        let two =
            written(&[("reply", &[Some("b"), None]), ("request", &[Some("a"), Some("c")])], 9, Compression::SNAPPY);
        assert_eq!(read(&two).expect("it is read"), "a\nb\nc\n\n");
        assert_eq!(read(&written(&[("line", &[])], 9, Compression::SNAPPY)).expect("it is read"), "");
    }

    #[test]
    fn what_is_no_log_says_what_would_be_right() {
        let one: &[Option<&str>] = &[Some("a")];
        for (columns, says) in [
            (&[("text", one)][..], "its columns are time, text; a log has one column of text `line`, or two"),
            (&[("request", one)], "its columns are time, request;"),
            (&[("line", one), ("reply", one)], "it has `line` and `request` or `reply` as well"),
        ] {
            let error = read(&written(columns, 9, Compression::SNAPPY)).expect_err("no log").to_string();
            assert!(error.starts_with(says), "{error}");
        }
        for bytes in [&b""[..], b"PAR1", b"PAR1PAR1", b"{\"start\":{}}\n", &[0; 100]] {
            let error = read(bytes).expect_err("no Parquet").to_string();
            assert!(error.starts_with("it is no Parquet, or damaged: "), "{error}");
        }
    }

    /// Whatever is wrong with a file: an error or rows, soon, and no panic comes through.
    #[test]
    fn damaged_files_are_refused() {
        let lines: Vec<String> =
            (0..400).map(|row| format!("{{\"step\":{{\"detected_km_h\":[{}]}}}}", row % 7)).collect();
        let lines: Vec<Option<&str>> = lines.iter().map(|line| Some(line.as_str())).collect();
        let mut draw = Random::of(1, "damaged", 0);
        let mut refused = 0;
        for packed in [Compression::SNAPPY, Compression::UNCOMPRESSED] {
            let whole = written(&[("line", &lines)], 150, packed);
            for _ in 0..1000 {
                let mut bytes = whole.clone();
                for _ in 0..=draw.number() % 3 {
                    let at = usize::try_from(draw.number()).unwrap_or(0) % bytes.len();
                    // Half of them where the pages and columns are described.
                    let at =
                        if draw.number().is_multiple_of(2) { at } else { bytes.len() - 1 - at % bytes.len().min(600) };
                    let byte = u8::try_from(draw.number() % 256).unwrap_or(0);
                    match draw.number() % 5 {
                        0 => bytes[at] ^= 1 << (byte % 8),
                        1 => bytes[at] = byte,
                        2 => bytes[at] = 0xff,
                        3 => bytes.truncate(at.max(1)),
                        _ => drop(bytes.splice(at..at, [byte, byte])),
                    }
                }
                match read(&bytes) {
                    Ok(text) => assert!(text.len() < 1 << 20, "{} bytes", text.len()),
                    Err(error) => {
                        refused += 1;
                        assert!(error.to_string().starts_with("it"), "{error}");
                    }
                }
            }
        }
        assert!(refused > 1000, "{refused} of 2000 were found damaged");
    }
}
