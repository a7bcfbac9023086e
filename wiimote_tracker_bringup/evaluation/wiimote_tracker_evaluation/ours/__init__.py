"""The parts of the section ours, one subject each: commands(run), and tell(run)."""
