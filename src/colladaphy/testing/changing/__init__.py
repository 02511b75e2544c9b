"""How documents are changed: spelled otherwise, rearranged, and edited."""
