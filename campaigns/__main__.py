"""`python -m campaigns`."""

from campaigns.app import main

main()
