"""Specifications of transformations and targets: the paper's XML, YAML, and templates over individuals."""

from rosa_streams.specification.loading import Specification, load_specification, load_transformations
from rosa_streams.specification.xml_format import specifications_xml

__all__ = ["Specification", "load_specification", "load_transformations", "specifications_xml"]
