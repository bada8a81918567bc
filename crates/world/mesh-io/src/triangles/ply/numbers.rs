//! Numbers after the header of a PLY file, as text or binary.

use raypencil_files::Fault;

use crate::cloud::{Printed, decimal, whole_decimal};
use crate::triangles::ply::header::{Element, Number};
use crate::triangles::text::{self, Lines, quoted, words};

/// Numbers of a file, one after the other.
pub(super) trait Numbers {
    /// Fewest bytes that a row of an element takes.
    fn least_row_bytes(&self, element: &Element<'_>) -> u64;

    fn bytes_left(&self) -> u64;

    /// Place of the last number, for messages.
    fn place(&self) -> String;

    fn begin_row(&mut self) -> Result<(), Fault>;

    /// A number as the nearest double.
    fn real(&mut self, number: Number) -> Result<f64, Fault>;

    /// The last number as it is printed; `None` in a binary file.
    fn printed(&self) -> Option<Printed> {
        None
    }

    /// A whole number. The header has been checked to declare an integer.
    fn whole(&mut self, number: Number) -> Result<i64, Fault>;

    /// Skips so many numbers.
    fn skip(&mut self, number: Number, count: u64) -> Result<(), Fault>;

    fn end_row(&mut self) -> Result<(), Fault>;

    /// Refuses anything after the last row.
    fn finish(&mut self) -> Result<(), Fault>;
}

pub(super) struct Binary<'a> {
    file: &'a [u8],
    big_endian: bool,
    /// Offset of the next number.
    next: usize,
    /// Offset of the last number.
    last: usize,
}

impl<'a> Binary<'a> {
    pub(super) fn new(file: &'a [u8], offset: usize, big_endian: bool) -> Self {
        Self { file, big_endian, next: offset, last: offset }
    }

    /// Bits of the next number; absent high bytes are zero.
    fn bits(&mut self, number: Number) -> Result<u64, Fault> {
        let size = number.bytes();
        self.last = self.next;
        let Some(bytes) = self.file[self.next..].get(..size) else {
            let found = format!("{} bytes left", self.bytes_left());
            return Err(Fault::new(self.place(), found, format!("a number of {size} bytes")));
        };
        self.next += size;
        let mut word = [0; 8];
        word[..size].copy_from_slice(bytes);
        if self.big_endian {
            word[..size].reverse();
        }
        Ok(u64::from_le_bytes(word))
    }
}

impl Numbers for Binary<'_> {
    fn least_row_bytes(&self, element: &Element<'_>) -> u64 {
        element
            .properties
            .iter()
            .map(|property| property.length.unwrap_or(property.number).bytes() as u64)
            .sum()
    }

    fn bytes_left(&self) -> u64 {
        (self.file.len() - self.next) as u64
    }

    fn place(&self) -> String {
        format!("byte {}", self.last)
    }

    fn begin_row(&mut self) -> Result<(), Fault> {
        Ok(())
    }

    fn real(&mut self, number: Number) -> Result<f64, Fault> {
        match number {
            Number::Real(4) => Ok(f32::from_bits(self.bits(number)? as u32).into()),
            Number::Real(_) => Ok(f64::from_bits(self.bits(number)?)),
            // At most 32 bits, which a double holds.
            _ => Ok(self.whole(number)? as f64),
        }
    }

    fn whole(&mut self, number: Number) -> Result<i64, Fault> {
        let bits = self.bits(number)?;
        // Sign extension: the sign bit is moved to the top and back.
        let shift = 64 - 8 * number.bytes();
        match number {
            Number::Signed(_) => Ok((bits << shift) as i64 >> shift),
            _ => Ok(bits as i64),
        }
    }

    fn skip(&mut self, number: Number, count: u64) -> Result<(), Fault> {
        self.last = self.next;
        let size = count.saturating_mul(number.bytes() as u64);
        if size > self.bytes_left() {
            let found = format!("{} bytes left", self.bytes_left());
            return Err(Fault::new(
                self.place(),
                found,
                format!("{count} numbers of {} bytes", number.bytes()),
            ));
        }
        self.next += size as usize;
        Ok(())
    }

    fn end_row(&mut self) -> Result<(), Fault> {
        Ok(())
    }

    fn finish(&mut self) -> Result<(), Fault> {
        match self.bytes_left() {
            0 => Ok(()),
            left => {
                let found = format!("{left} bytes after the last row");
                Err(Fault::new(format!("byte {}", self.next), found, "the end of the file"))
            }
        }
    }
}

/// Numbers of a text file: one row in each line.
pub(super) struct Text<'a> {
    lines: Lines<'a>,
    line: usize,
    rest: &'a [u8],
    /// The last word.
    last: &'a [u8],
}

impl<'a> Text<'a> {
    /// Numbers of a text that has so many lines of header before it.
    pub(super) fn new(text: &'a [u8], header_lines: usize) -> Self {
        Self { lines: Lines::new(text, header_lines + 1), line: header_lines, rest: &[], last: &[] }
    }

    fn word(&mut self) -> Option<&'a [u8]> {
        let word = words(self.rest).next()?;
        self.last = word;
        self.rest = &self.rest.trim_ascii_start()[word.len()..];
        Some(word)
    }
}

impl Numbers for Text<'_> {
    fn least_row_bytes(&self, element: &Element<'_>) -> u64 {
        // A digit and a space, or the end of the line, for each number.
        2 * element.properties.len() as u64
    }

    fn bytes_left(&self) -> u64 {
        // The end of the last line may be absent.
        self.lines.rest().len() as u64 + 1
    }

    fn place(&self) -> String {
        format!("line {}", self.line)
    }

    fn begin_row(&mut self) -> Result<(), Fault> {
        // Empty lines are no rows.
        loop {
            let Some((line, rest)) = self.lines.next() else {
                return Err(Fault::new(self.place(), "the end of the file", "more lines of numbers"));
            };
            (self.line, self.rest) = (line, rest);
            if !rest.trim_ascii().is_empty() {
                return Ok(());
            }
        }
    }

    fn real(&mut self, number: Number) -> Result<f64, Fault> {
        let word = self.word();
        let text = word.and_then(|word| std::str::from_utf8(word).ok());
        let real = text.and_then(|text| match number {
            Number::Real(bytes) => decimal(text, bytes == 4),
            Number::Signed(bytes) => whole_decimal(text, true, bytes),
            Number::Unsigned(bytes) => whole_decimal(text, false, bytes),
        });
        real.ok_or_else(|| {
            let expected = match number {
                Number::Real(_) => "a decimal number that its type holds".to_string(),
                _ => format!("a whole number that its type holds ({})", number.type_name()),
            };
            Fault::new(self.place(), quoted(word), expected)
        })
    }

    fn printed(&self) -> Option<Printed> {
        Some(Printed::of(std::str::from_utf8(self.last).unwrap_or_default()))
    }

    fn whole(&mut self, number: Number) -> Result<i64, Fault> {
        let word = self.word();
        let whole = text::whole(word, || self.place())?;
        let text = word.and_then(|word| std::str::from_utf8(word).ok()).unwrap_or_default();
        match whole_decimal(text, matches!(number, Number::Signed(_)), number.bytes()) {
            Some(_) => Ok(whole),
            None => {
                let expected = format!("a whole number that its type holds ({})", number.type_name());
                Err(Fault::new(self.place(), quoted(word), expected))
            }
        }
    }

    fn skip(&mut self, _: Number, count: u64) -> Result<(), Fault> {
        for number in 0..count {
            if self.word().is_none() {
                let found = format!("{number} numbers to the end of the line");
                return Err(Fault::new(self.place(), found, format!("{count} numbers")));
            }
        }
        Ok(())
    }

    fn end_row(&mut self) -> Result<(), Fault> {
        match self.word() {
            None => Ok(()),
            surplus => Err(Fault::new(self.place(), quoted(surplus), "the end of the line")),
        }
    }

    fn finish(&mut self) -> Result<(), Fault> {
        match self.lines.find(|(_, line)| !line.trim_ascii().is_empty()) {
            None => Ok(()),
            Some((line, _)) => {
                Err(Fault::new(format!("line {line}"), "a line after the last row", "the end of the file"))
            }
        }
    }
}
