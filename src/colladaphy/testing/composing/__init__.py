"""How documents of physics are drawn whose structures no writer of ours makes."""
