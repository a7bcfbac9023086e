"""The fault matrix: faults are caused on the simulated rig, and what the tracker publishes is
compared with the truth before, during and after."""
