"""What a scene costs: its parts, their memory and their time."""
