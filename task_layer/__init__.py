"""The task layer: what the robot does next, decided with what the knowledge base says it can do."""
