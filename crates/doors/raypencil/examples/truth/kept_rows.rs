//! Rows that were made by an earlier run of the same program.

use std::fs;
use std::path::PathBuf;

use raypencil::io::file_sha256_hex;

/// Folder of the rows that this program made.
pub struct KeptRows {
    folder: PathBuf,
    /// Whether rows that are not there are left out.
    only_kept: bool,
}

impl KeptRows {
    /// The rows of this very program: its bytes are in the folder's name.
    ///
    /// # Errors
    /// If the program or the folder cannot be read or made.
    pub fn of_this_program() -> Result<Self, crate::Failure> {
        let (_, digest) = file_sha256_hex(&std::env::current_exe()?)?;
        let folder = PathBuf::from("out/truth").join(&digest[..16]);
        fs::create_dir_all(&folder)?;
        Ok(Self { folder, only_kept: std::env::var_os("KEPT").is_some() })
    }

    /// The row of this name, made by `make` unless it is there. `None`: it is not there, and none is to be made.
    ///
    /// # Errors
    /// As `make`, and a row that cannot be written.
    pub fn row(
        &self,
        name: &str,
        make: impl FnOnce() -> Result<String, crate::Failure>,
    ) -> Result<Option<String>, crate::Failure> {
        let slug: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
        let path = self.folder.join(format!("{slug}.md"));
        if let Ok(row) = fs::read_to_string(&path) {
            return Ok(Some(row));
        }
        if self.only_kept {
            return Ok(None);
        }
        let row = make()?;
        fs::write(&path, &row)?;
        Ok(Some(row))
    }
}
