"""Documents as columns: all elements of a kind at once (see `colladaphy_schema.rows`)."""
