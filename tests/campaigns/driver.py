"""`python -m campaigns` with the fake engine and without collecting, for tests that need a process of their own."""

import sys
from pathlib import Path

import campaigns.app
import campaigns.job
import campaigns.run
from tests.campaigns.sound import SOUND

campaigns.job.ENGINE = (sys.executable, str(Path(__file__).with_name("fake_engine.py")))
campaigns.run.PERIOD = 0.05
campaigns.app.collect_results = lambda directory: SOUND

campaigns.app.main()
