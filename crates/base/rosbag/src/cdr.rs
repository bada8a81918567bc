//! The encoding of ROS 2's messages, read value by value.

/// CDR of ROS 2: each number stands at a multiple of its size behind the first four bytes. (OMG DDSI-RTPS 2.3, 10.2; CDR 1.0)
pub(crate) struct Cdr<'a> {
    data: &'a [u8],
    at: usize,
    is_little: bool,
}

impl<'a> Cdr<'a> {
    pub(crate) fn new(data: &'a [u8]) -> Result<Self, String> {
        let is_little = match data {
            [0, 0, _, _, ..] => false,
            [0, 1, _, _, ..] => true,
            [a, b, _, _, ..] => return Err(format!("the representation {a:#04x} {b:#04x}")),
            _ => return Err(format!("{} bytes", data.len())),
        };
        Ok(Self { data: &data[4..], at: 0, is_little })
    }

    pub(crate) fn bytes(&mut self, count: usize) -> Result<&'a [u8], String> {
        let end = self.at.checked_add(count).filter(|end| *end <= self.data.len());
        let end = end.ok_or_else(|| format!("{} bytes, which end within a value", self.data.len() + 4))?;
        let bytes = &self.data[self.at..end];
        self.at = end;
        Ok(bytes)
    }

    /// The bytes of a number, the lowest first.
    fn number<const N: usize>(&mut self) -> Result<[u8; N], String> {
        self.at = self.at.next_multiple_of(N);
        let mut number = [0; N];
        number.copy_from_slice(self.bytes(N)?);
        if !self.is_little {
            number.reverse();
        }
        Ok(number)
    }

    pub(crate) fn byte(&mut self) -> Result<u8, String> {
        let [byte] = self.number()?;
        Ok(byte)
    }

    pub(crate) fn word(&mut self) -> Result<u32, String> {
        Ok(u32::from_le_bytes(self.number()?))
    }

    pub(crate) fn real(&mut self) -> Result<f64, String> {
        Ok(f64::from_le_bytes(self.number()?))
    }

    /// A text, whose length counts the zero at its end.
    pub(crate) fn text(&mut self) -> Result<String, String> {
        let length = self.word()? as usize;
        let bytes = self.bytes(length)?;
        let text = bytes.strip_suffix(&[0]).unwrap_or(bytes);
        std::str::from_utf8(text).map(String::from).map_err(|_| "a name that is no text".into())
    }

    /// Seconds.
    pub(crate) fn stamp(&mut self) -> Result<f64, String> {
        let seconds = i32::from_le_bytes(self.number()?);
        match self.word()? {
            nanoseconds @ 0..1_000_000_000 => Ok(f64::from(seconds) + f64::from(nanoseconds) / 1e9),
            more => Err(format!("a stamp of {more} nanoseconds beside its seconds")),
        }
    }
}
