"""A run on disk: the job directory, its files, and the session that writes them."""
