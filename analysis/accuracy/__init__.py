"""What each numerical setting of a collision costs and changes, from a campaign of cases with several seeds."""
