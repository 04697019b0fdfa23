"""The Material Point Method: the grid and the transfer to it and back."""
