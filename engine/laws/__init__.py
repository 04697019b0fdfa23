"""Laws of matter: the response of one particle to its deformation, without a grid."""
