"""A job on disk: its directory, its files, and the session that runs it."""
