"""TypeQL text to plain data."""
