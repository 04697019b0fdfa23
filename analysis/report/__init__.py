"""Figures and the page of a campaign."""
