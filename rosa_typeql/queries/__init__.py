"""Read queries in TypeQL, answered from what a knowledge base knows."""
