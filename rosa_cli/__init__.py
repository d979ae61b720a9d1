"""The ``rosa`` command."""
