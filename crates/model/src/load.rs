//! Reading a machine from files or bytes.

use crate::error::{Error, Place, Read, file_name};
use crate::limits::FILE_BYTES;
use crate::machine::Machine;
use crate::{build, parse_file, parse_supplement, source};
use std::fs::File;
use std::io::Read as _;
use std::path::Path;

impl Machine {
    /// Reads a model file and its supplement. Without a path the supplement is the file beside the model with the
    /// ending `.sup`; it may be absent.
    pub fn load(model: &Path, supplement: Option<&Path>) -> Result<Self, Error> {
        let text = read(model)?;
        let beside = model.with_extension("sup");
        let path = match supplement {
            Some(path) => Some(path),
            None => Some(beside.as_path()).filter(|p| p.exists()),
        };
        let bytes = path.map(read).transpose()?;
        let names = path.map(|p| p.display().to_string());
        let supplement = names.as_deref().zip(bytes.as_deref());
        Self::parse(&model.display().to_string(), &text, supplement)
    }

    /// Reads a machine from bytes; the names are those shown in errors.
    pub fn parse(
        model_name: &str,
        model_text: &[u8],
        supplement: Option<(&str, &[u8])>,
    ) -> Result<Self, Error> {
        let files = [model_name.to_string(), supplement.map_or(String::new(), |(name, _)| name.to_string())];
        let mut machine = in_file(model_name, model(model_text, files))?;
        if let Some((name, bytes)) = supplement {
            let read = source::decode(bytes, 1).and_then(|text| parse_supplement::parse(text, &machine));
            machine.supplement = in_file(name, read)?;
        }
        Ok(machine)
    }
}

fn model(bytes: &[u8], files: [String; 2]) -> Read<Machine> {
    let syntax = parse_file::parse(source::decode(bytes, 0)?, 0)?;
    build::build(&syntax, files)
}

fn in_file<T>(name: &str, result: Read<T>) -> Result<T, Error> {
    result.map_err(|fault| {
        let Place { line, column, .. } = fault.place;
        Error { file: file_name(name), line, column, message: fault.message }
    })
}

/// A file's bytes, at most one more than allowed.
fn read(path: &Path) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    let opened = File::open(path).and_then(|f| f.take(FILE_BYTES as u64 + 1).read_to_end(&mut bytes));
    match opened {
        Ok(_) => Ok(bytes),
        Err(e) => {
            let message = format!("the file cannot be read ({e}); expected a readable text file");
            Err(Error { file: file_name(&path.display().to_string()), line: 1, column: 1, message })
        }
    }
}
