"""The missions, as trees."""
