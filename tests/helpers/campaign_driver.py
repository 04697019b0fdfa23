"""`python -m campaigns` with the fake engine, for tests that need a process of their own."""

import sys
from pathlib import Path

import campaigns.cli
import campaigns.runner
import campaigns.worker

campaigns.worker.ENGINE = (sys.executable, str(Path(__file__).with_name("fake_engine.py")))
campaigns.runner.PERIOD = 0.05

campaigns.cli.main()
