"""What the programs of this package share: errors, files, processes, rigs and their geometry."""
