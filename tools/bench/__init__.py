"""Measures how long reading and writing take, against `lxml.etree.parse` of the same bytes."""
