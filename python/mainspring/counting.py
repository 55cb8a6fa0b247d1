"""Numbers with what they count, in the singular or the plural."""


def number_of(count: int, one: str, many: str | None = None) -> str:
    """Return "1 minimum", "0 minima", "3 impacts"; the plural is made with an s unless given."""
    return f"{count} {one}" if count == 1 else f"{count} {many or one + 's'}"


def impacts(instants: int, contacts: int) -> str:
    """Return how often parts struck, and at how many contacts where several struck at once."""
    said = number_of(instants, "impact")
    return said if contacts == instants else f"{said} (at {number_of(contacts, 'contact')})"


def minima(count: int, basis: str = "kinetic_energy_minima") -> str:
    """Return how many points of comparison a pattern has, by what kind they are."""
    if basis == "whole_turns":
        return number_of(count, "whole turn")
    kind = "prominent " if basis == "prominent_minima" else ""
    return f"{number_of(count, kind + 'minimum', kind + 'minima')} of kinetic energy"
