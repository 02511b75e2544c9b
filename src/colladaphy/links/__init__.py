"""Links: ids, sids, urls, other files, and where nodes stand. References become rows."""
