"""The files that knowledge models are written in: a reader for each format, and what puts their statements together."""

from rosa_core.formats.builder import ModelBuilder
from rosa_core.formats.loader import ModelReader, load_model, register_format

__all__ = ["ModelBuilder", "ModelReader", "load_model", "register_format"]
