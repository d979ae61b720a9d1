"""Map files: our own YAML or JSON, and the JSON of the CMU BRASS exemplar (Rainbow), read unchanged."""

from agv_example.map_formats.files import load_map, read_map

__all__ = ["load_map", "read_map"]
