"""Error against computing time of verification scenes, every setting varied."""
