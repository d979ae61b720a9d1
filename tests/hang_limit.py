"""The one limit on waiting in tests."""

from __future__ import annotations

HANG_LIMIT = 300.0
"""Seconds after which a test that hangs is ended; what works takes a small part of it, on a busy machine too."""
