"""Generates `generated/colladaphy_schema`: dataclasses and codecs from the schema files."""
