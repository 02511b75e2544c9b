"""Loading: columns of documents become a World (thesis 5.3)."""
