"""Blackboards, the ports of nodes on them, and conversion between text and typed values."""
