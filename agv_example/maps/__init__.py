"""Maps that come with the example."""
