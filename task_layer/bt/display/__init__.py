"""Trees to be looked at: in words, and as a picture."""
