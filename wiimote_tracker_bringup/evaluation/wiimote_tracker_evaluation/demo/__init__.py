"""The demonstration: the paper's experiment with the whole system, recorded, scored and shown."""
