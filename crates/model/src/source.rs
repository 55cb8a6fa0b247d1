//! From bytes to text: size and encoding.

use crate::error::{Fault, Place, Read};
use crate::limits::FILE_BYTES;

/// The text of a file; UTF-8 with or without a byte order mark.
pub(crate) fn decode(bytes: &[u8], file: u8) -> Read<&str> {
    let start = Place { file, line: 1, column: 1 };
    if bytes.len() > FILE_BYTES {
        return Err(Fault::new(
            start,
            format!("the file is larger than {FILE_BYTES} bytes; expected at most 16 MiB"),
        ));
    }
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(Fault::new(start, "the file is encoded as UTF-16; expected UTF-8"));
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    std::str::from_utf8(bytes).map_err(|e| not_text(bytes, e.valid_up_to(), file))
}

/// The place of the first byte that is not UTF-8.
fn not_text(bytes: &[u8], valid: usize, file: u8) -> Box<Fault> {
    let text = std::str::from_utf8(&bytes[..valid]).unwrap_or("");
    let line_start = text.rfind(['\n', '\r']).map_or(0, |i| i + 1);
    let lines = text.replace("\r\n", "\n").matches(['\n', '\r']).count();
    let column = text[line_start..].chars().count();
    let place = Place { file, line: lines as u32 + 1, column: column as u32 + 1 };
    Fault::new(place, format!("byte 0x{:02x} is no UTF-8 text; expected a text file in UTF-8", bytes[valid]))
}
