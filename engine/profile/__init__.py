"""Profile of a scene: its parts, their memory and their time."""
