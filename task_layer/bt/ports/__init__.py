"""What nodes read and write: blackboards, ports on them, and values converted between text and types."""
