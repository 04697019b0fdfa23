"""Which scenes run to their end, and what stops the others: a matrix of stiff and extreme cases."""
