"""`python -m engine`: the command line in engine/cli.py."""

from engine.cli import application

if __name__ == "__main__":
    application()
