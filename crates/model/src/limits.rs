//! What the reader accepts at most. Each limit is refused by name, at the place where it is passed.

/// Size of a file in bytes: 16 MiB.
pub const FILE_BYTES: usize = 16 * 1024 * 1024;

/// Primitives in all parts together, after named solids and symmetric unions are expanded.
pub const PRIMITIVES: usize = 10_000;

/// Open brackets inside each other.
pub const NESTING: usize = 200;

/// Numbers, names, operators and functions in one numeric expression.
pub const EXPRESSION_NODES: usize = 1_000;

/// Definitions, attributes, and written primitives in a file: so many of each.
pub const DEFINITIONS: usize = 100_000;

/// Steps of expansion (named solids entered, `at` groups, copies): bounds the work of finding all poses.
pub const EXPANSION_STEPS: usize = 1_000_000;

/// Different names in a file.
pub const NAMES: usize = 200_000;

/// Numbers, names, operators and primitives in a whole file; keeps a file of 16 MiB below 5 s and 1 GiB.
pub const FILE_NODES: usize = 1_000_000;

/// Characters of a name.
pub const NAME_CHARACTERS: usize = 100;

/// Characters of a written number: enough for every binary64 number to 17 digits, with room.
pub const NUMBER_CHARACTERS: usize = 100;

/// Points of one table of the supplement.
pub const TABLE_POINTS: usize = 100_000;
