"""Managing systems: who decides what the aircraft does and how it is configured."""
