"""Experiments on a running tracker: prompts on the terminal lead a person through them.

They use only what a user of the tracker has: points, images, the rig, triggers; no ground truth.
"""
