"""How Worlds are drawn: numbers, bodies, joints, materials, and the program that makes them."""
