"""What runs a World in time: the protocol of engines, the engines, runs and checkpoints."""
