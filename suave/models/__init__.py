"""The knowledge models."""
