"""A scene put together from its parts and moved in time."""
