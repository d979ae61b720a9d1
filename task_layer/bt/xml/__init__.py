"""BehaviorTree.CPP v4 XML: reading, checking, building, outlining and saving of trees."""
