"""Knowledge models in TypeQL: a reader for the port of formats."""
