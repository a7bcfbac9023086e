"""A person is led through the experiments on a tracker that runs, by prompts on the terminal.

Only what a user of the tracker has is read: points, images, the rig, triggers; no truth.
"""
