"""The parts of the section ours, one per subject: commands(run), and tell(run)."""
