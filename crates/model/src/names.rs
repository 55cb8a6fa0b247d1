//! Names: finding the one that was probably meant, and listing those that exist.

/// Names shown in a list of what exists.
const LISTED: usize = 8;

/// Longest name that is compared; longer ones are no slips of the pen.
const COMPARED: usize = 40;

/// Names compared at most: the first in the text.
const CANDIDATES: usize = 10_000;

/// The name nearest to `wanted` in any letter case, if few letters differ (one of two to four, two of five to
/// seven, and so on).
pub(crate) fn nearest<'a>(known: impl IntoIterator<Item = &'a str>, wanted: &str) -> Option<&'a str> {
    if wanted.is_empty() || wanted.len() > COMPARED {
        return None;
    }
    let wanted = wanted.to_ascii_lowercase();
    let allowed = (wanted.len() + 1) / 3;
    let mut best: Option<(usize, &str)> = None;
    for name in known.into_iter().take(CANDIDATES).filter(|n| n.len().abs_diff(wanted.len()) <= allowed) {
        let distance = edits(&wanted, &name.to_ascii_lowercase());
        if distance <= allowed && best.is_none_or(|(d, _)| distance < d) {
            best = Some((distance, name));
        }
    }
    best.map(|(_, name)| name)
}

/// What to expect in place of `wanted`: the nearest name, or a list.
pub(crate) fn one_of(known: &[&str], wanted: &str) -> String {
    if let Some(name) = nearest(known.iter().copied(), wanted) {
        return format!("`{name}`, the nearest name");
    }
    list(known)
}

/// `one of a, b, c`, shortened.
pub(crate) fn list(known: &[&str]) -> String {
    match known {
        [] => "none, as there is none".to_string(),
        [only] => format!("`{only}`"),
        _ => {
            let shown: Vec<String> = known.iter().take(LISTED).map(|n| format!("`{n}`")).collect();
            let more = known.len().saturating_sub(LISTED);
            let rest = if more > 0 { format!(" or {more} more") } else { String::new() };
            format!("one of {}{rest}", shown.join(", "))
        }
    }
}

/// Number of letters to insert, delete, replace, or exchange with a neighbour (restricted Damerau–Levenshtein).
fn edits(a: &str, b: &str) -> usize {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let mut before: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 0..a.len() {
        let mut row = vec![i + 1];
        for j in 0..b.len() {
            let replaced = last[j] + usize::from(a[i] != b[j]);
            let mut least = replaced.min(last[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j] {
                least = least.min(before[j - 1] + 1);
            }
            row.push(least);
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}
