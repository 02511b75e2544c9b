"""Documents with one fault each, and those that nearly have it."""
