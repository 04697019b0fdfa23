"""campaign.json: read by campaigns as this version writes it, by analysis as any version wrote it."""

import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from campaigns.campaign import Campaign, KeptCampaign, read_campaign
from campaigns.expansion import expand
from campaigns.study import find_study, read_study
from engine.errors import SceneError
from engine.job.storage import write_json


def of_another_version(directory: Path, **changes: Any) -> Path:
    """A campaign whose study and collision contain keys that this version does not know."""
    job = {"id": "a-0", "directory": "jobs/a-0", "index": {"angle": 5}, "collision": {"rock": {"hardness": [1, None]}}}
    content = {"name": "old", "physics_version": 0, "study": {"grid": {"angles": 3}}, "dims": ["angle"]}
    write_json(directory / "campaign.json", content | {"coords": {"angle": [5, 15]}, "jobs": [job]} | changes)
    return directory


def test_a_campaign_is_read_as_it_was_written(tmp_path: Path) -> None:
    campaign = expand(read_study(find_study("quick")), "quick")
    write_json(tmp_path / "campaign.json", campaign.content())
    assert read_campaign(tmp_path, Campaign) == campaign
    assert read_campaign(tmp_path, KeptCampaign).content() == campaign.content()


def test_a_campaign_of_another_version_can_be_analysed_and_not_run(tmp_path: Path) -> None:
    found = read_campaign(of_another_version(tmp_path, comment="of a version with more keys"), KeptCampaign)
    assert found.shape == (2,) and found.position(found.jobs[0]) == (0,)
    assert found.jobs[0].collision == {"rock": {"hardness": [1, None]}}
    with pytest.raises(SceneError, match=r"campaign\.json: unknown key 'jobs\.0\.collision\.rock'"):
        read_campaign(tmp_path, Campaign)


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"coords": {"angle": [15]}}, "job 'a-0' has no place on the axis 'angle'"),
        ({"coords": {}}, "dimension 'angle' has no coordinates"),
        ({"dims": ["angle", "seed"], "coords": {"angle": [5], "seed": [1]}}, "no place on the axis 'seed'"),
        ({"coords": {"angle": [5, [15]]}}, r"coords\.angle"),
    ],
)
def test_jobs_must_lie_on_the_axes(tmp_path: Path, changes: dict[str, Any], told: str) -> None:
    with pytest.raises(SceneError, match=told):
        read_campaign(of_another_version(tmp_path, **changes), KeptCampaign)


def test_reading_a_campaign_starts_neither_a_cluster_s_code_nor_the_compiler_s() -> None:
    code = "import sys, campaigns.campaign; print({'dask', 'distributed', 'taichi'} & set(sys.modules))"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert loaded.stdout.strip() == "set()"
