"""Pairing a Wii Remote with this computer."""
