//! Reading a machine from files or bytes.

use crate::error::{Error, Fault, Place, Read, file_name};
use crate::limits::FILE_BYTES;
use crate::machine::Machine;
use crate::{build, native, parse_file, parse_supplement, source};
use std::fs::File;
use std::io::{Read as _, Write as _};
use std::path::Path;

impl Machine {
    /// Reads a model file and its supplement. Without a path the supplement is the file beside the model with the
    /// ending `.sup`; it may be absent. A model whose name ends in `.toml` says everything itself and has none.
    pub fn load(model: &Path, supplement: Option<&Path>) -> Result<Self, Error> {
        let text = read(model)?;
        let beside = model.with_extension("sup");
        let path = match supplement {
            Some(path) => Some(path),
            None => Some(beside.as_path()).filter(|p| p.exists() && !is_toml(&model.display().to_string())),
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
        if is_toml(model_name) {
            return in_file(model_name, native(model_text, files, supplement.is_some()));
        }
        let mut machine = in_file(model_name, model(model_text, files))?;
        if let Some((name, bytes)) = supplement {
            let read = source::decode(bytes, 1).and_then(|text| parse_supplement::parse(text, &machine));
            machine.supplement = in_file(name, read)?;
        }
        Ok(machine)
    }
}

impl Machine {
    /// The text of a TOML machine with new values of some parameters; comments and everything else stay.
    ///
    /// # Errors
    /// A machine in PADL, and values that [`Machine::values`] refuses.
    pub fn text_with(&self, set: &[(String, f64)]) -> Result<String, Error> {
        let Some(native) = &self.native else {
            let place = Place { file: 0, line: 1, column: 1 };
            let message = "only machines in TOML are written back; expected a model that ends in .toml";
            return Err(self.error(place, message));
        };
        self.values(set)?;
        self.named(native::with_values(&native.source, set))
    }

    /// Writes [`Machine::text_with`] to a file, whole or not at all: beside it first, then in its place.
    ///
    /// # Errors
    /// As there, and a place that cannot be written.
    pub fn save(&self, path: &Path, set: &[(String, f64)]) -> Result<(), Error> {
        let text = self.text_with(set)?;
        replace(path, text.as_bytes()).map_err(|e| {
            let message = format!("the file cannot be written ({e}); expected a writable place");
            Error { file: file_name(&path.display().to_string()), line: 1, column: 1, message }
        })
    }
}

fn replace(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let name = path.file_name().ok_or_else(|| std::io::Error::other("no file name"))?;
    let mut beside = std::ffi::OsString::from(".");
    beside.push(name);
    beside.push(format!(".{}.part", std::process::id()));
    let scratch = path.with_file_name(beside);
    let written = File::create(&scratch)
        .and_then(|mut f| f.write_all(bytes).and_then(|()| f.sync_all()))
        .and_then(|()| std::fs::rename(&scratch, path));
    if written.is_err() {
        // The first error is the one to tell.
        let _ = std::fs::remove_file(&scratch);
    }
    written
}

/// The suffix decides.
fn is_toml(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"))
}

fn native(bytes: &[u8], files: [String; 2], supplemented: bool) -> Read<Machine> {
    if supplemented {
        let place = Place { file: 0, line: 1, column: 1 };
        return Err(Fault::new(
            place,
            "a TOML machine with a supplement; expected everything in the one file",
        ));
    }
    native::read(source::decode(bytes, 0)?, files)
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
