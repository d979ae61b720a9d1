"""Managing systems that serve every simulated robot: who decides how it is configured."""
