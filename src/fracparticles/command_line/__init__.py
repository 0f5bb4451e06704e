"""The command line: its commands, what they print and draw, and how far a run is."""
