"""SUAVE: an underwater robot that searches for a pipeline and inspects it while things go wrong."""
