"""The response of one particle to its deformation; no grid."""
