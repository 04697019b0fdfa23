"""State of a simulation on the device: particles and clock."""
