"""Shows trees: in words, and as a picture."""
