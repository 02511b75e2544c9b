"""Kinematics of documents as joints of a World (COLLADA 1.5 part 2, §kinematics)."""
