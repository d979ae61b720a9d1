"""The types, attributes and roles of ROSA as TypeQL spells them, and the values of attributes."""
