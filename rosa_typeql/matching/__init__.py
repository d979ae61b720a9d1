"""Patterns matched against knowledge as facts; what models and queries share."""
