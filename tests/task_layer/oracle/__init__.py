"""The nodes against the real BehaviorTree.CPP 4.8.2 (its Python binding, behaviortreepy), on random trees."""
