"""Leading the tracker through the paper's experiment, and measuring how well it did."""
