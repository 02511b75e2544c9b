"""Documents in the manner of programs that wrote physics, and what their authors meant by them."""
