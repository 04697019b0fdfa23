"""The figures of a campaign, each drawn from its results data set."""
