"""All jobs of a campaign in one data set, with error bars and tables."""
