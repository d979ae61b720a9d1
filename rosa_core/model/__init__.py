"""Design-time knowledge: the elements of a model, and the files that they are written in."""

from rosa_core.model.elements import ElementKind, ElementRef
from rosa_core.model.knowledge_model import KnowledgeModel

__all__ = ["ElementKind", "ElementRef", "KnowledgeModel"]
