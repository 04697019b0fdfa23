"""The data set of a campaign: every kind of job, coordinates, attributes, round trip."""

import hashlib
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from analysis.remnant.variables import OUTCOMES, UndescribedError
from analysis.results.collect import collect
from analysis.results.variables import TEXTS
from engine.errors import SceneError
from engine.job.storage import read_dataset, write_json
from engine.quantities import Quantity
from engine.scene.collision import Collision
from tests.helpers.fake_jobs import (
    RHO0,
    history,
    lattice_ellipsoid,
    particles,
    write_campaign,
    write_dataset,
    write_job,
)
from tests.helpers.jobs import BAD_DISK

AXES = (1.2e5, 1e5, 9e4)
POINTS, SPACING = lattice_ellipsoid(AXES, 400)
OMEGA = np.array([0.0, 0.0, 3e-4])


def remnant(**attrs: Any) -> xr.Dataset:
    """An ellipsoid that spins, and one particle that leaves it at 500 m/s."""
    position = np.concatenate([POINTS, [[5e5, 0.0, 0.0]]])
    velocity = np.concatenate([np.cross(OMEGA, POINTS), [[500.0, 0.0, 0.0]]])
    return particles(position, SPACING, velocity, **{"time": 900.0, **attrs})


def collision(**settings: Any) -> Collision:
    return Collision(**{"velocity": 200.0, "angle": 15.0, "particles": 400, "end_time": 1000.0, **settings})


def one_job(campaign: Path, **job: Any) -> Path:
    """A campaign of one done job; returns the job's directory."""
    write_campaign(
        campaign, {"velocity": [200.0], "angle": [15.0]}, [({"velocity": 200.0, "angle": 15.0}, collision())]
    )
    write_job(campaign / "jobs/0", collision(), **{"final": remnant(), **job})
    return campaign / "jobs/0"


def test_a_done_job_is_measured(tmp_path: Path) -> None:
    one_job(tmp_path)
    cell = collect(tmp_path).isel(velocity=0, angle=0)
    target = 4.0 / 3.0 * np.pi * RHO0 * 5e4**3
    assert cell["state"] == "done" and cell["reason"] == "" and cell["job"] == "0"
    np.testing.assert_allclose(cell["mass_ratio"], len(POINTS) * RHO0 * SPACING**3 / target)
    np.testing.assert_allclose(cell["second_mass_ratio"], RHO0 * SPACING**3 / target)
    np.testing.assert_allclose(cell["bound_mass_ratio"], cell["mass_ratio"])
    np.testing.assert_allclose([cell[f"axis_{name}"] for name in "abc"], AXES, rtol=0.03)
    np.testing.assert_allclose(cell["spin_period"], 2.0 * np.pi / 3e-4, rtol=1e-6)
    np.testing.assert_allclose(cell["bulk_density"], RHO0, rtol=0.03)
    assert cell["clumps"] == 2.0 and cell["damaged_fraction"] == 1.0 and cell["J_p50"] == 1.0
    assert cell["steps"] == 100.0 and cell["wall_time"] == 12.5 and cell["cpu_time"] == 20.5
    assert cell["time_after_contact"] == 900.0
    assert cell["c_unresolved"] == 0.0 and np.isnan(cell["settled"])


def test_what_moves_inside_a_remnant_is_measured(tmp_path: Path) -> None:
    one_job(tmp_path)
    cell = collect(tmp_path).isel(velocity=0, angle=0)
    for flow in ("flow", "bound_flow"):
        np.testing.assert_allclose(cell[f"{flow}_spin_rate"], OMEGA[2], rtol=1e-9)
        assert abs(cell[f"{flow}_strain_rate"]) < 1e-9 * OMEGA[2] and cell[f"{flow}_residual"] < 1e-9
    np.testing.assert_allclose(cell["kurtosis_a"], 15.0 / 7.0, rtol=0.03)
    assert cell["compressed_fraction"] == 0.0


def test_density_is_that_of_the_particles_and_pressure_that_of_the_bound_mass(tmp_path: Path) -> None:
    final = remnant()
    J = np.where(np.arange(len(POINTS) + 1) % 4 == 0, 0.5, 1.25)
    final["J"], final["rho"] = ("particle", J), ("particle", RHO0 / J)
    one_job(tmp_path, final=final)
    cell = collect(tmp_path).isel(velocity=0, angle=0)
    np.testing.assert_allclose(cell["particle_density"], RHO0 / J[:-1].mean())
    np.testing.assert_allclose(cell["compressed_fraction"], (J[:-1] < 1.0).mean())


def test_loose_rubble_is_under_pressure_below_its_packing(tmp_path: Path) -> None:
    final = remnant()
    loose = np.arange(len(POINTS) + 1) % 4 == 0
    final["J"] = ("particle", np.full(len(POINTS) + 1, 1.2))
    final["packing"] = ("particle", np.where(loose, 1.3, 1.1))
    one_job(tmp_path, final=final)
    cell = collect(tmp_path).isel(velocity=0, angle=0)
    np.testing.assert_allclose(cell["compressed_fraction"], loose[:-1].mean())


def test_flow_and_pressure_of_the_bound_mass_are_not_those_of_the_remnant(tmp_path: Path) -> None:
    position = np.concatenate([POINTS, [[5e5, 0.0, 0.0]]])
    velocity = np.concatenate([np.cross(OMEGA, POINTS), [[0.0, 1.0, 0.0]]])
    final = particles(position, SPACING, velocity, time=900.0)
    final["J"][-1] = 0.999
    one_job(tmp_path, final=final)
    cell = collect(tmp_path).isel(velocity=0, angle=0)
    assert cell["bound_mass_ratio"] > cell["mass_ratio"]
    np.testing.assert_allclose(cell["compressed_fraction"], 1.0 / (len(POINTS) + 1))
    assert cell["flow_residual"] < 1e-9 and cell["bound_flow_residual"] > 1e-3


def test_a_thin_remnant_is_flagged(tmp_path: Path) -> None:
    points, spacing = lattice_ellipsoid((3e5, 2e5, 3e4), 400)
    one_job(tmp_path, final=particles(points, spacing, time=900.0))
    cell = collect(tmp_path).isel(velocity=0, angle=0)
    assert cell["c_unresolved"] == 1.0
    assert cell["c_over_a_extended"] > cell["c_over_a"]


def test_what_is_measured_is_described(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    one_job(tmp_path)
    monkeypatch.delitem(OUTCOMES, "clumps")
    with pytest.raises(UndescribedError, match="clumps"):
        collect(tmp_path)


def test_what_is_described_is_measured(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    one_job(tmp_path)
    monkeypatch.setitem(OUTCOMES, "colour", Quantity("colour of the largest remnant", "1"))
    with pytest.raises(UndescribedError, match="colour"):
        collect(tmp_path)


def truncate(job: Path) -> None:
    whole = (job / "final.nc").read_bytes()
    (job / "final.nc").write_bytes(whole[: len(whole) // 2])


def make_nan(job: Path) -> None:
    broken = remnant()
    broken["velocity"][3, 1] = np.nan
    write_dataset(job / "final.nc", broken)


def rename_a_key(job: Path) -> None:
    """Give the scene the key that versions before had for the friction of rubble."""
    scene = (job / "scene.json").read_text()
    assert '"friction"' in scene
    (job / "scene.json").write_text(scene.replace('"friction"', '"damaged_friction"'))


TIME = ("corrupt", "status.json: damaged: 'wall_time'")

FAULTS = {
    "truncated": (truncate, "corrupt", "final.nc"),
    "gone": (lambda job: (job / "final.nc").unlink(), "corrupt", "final.nc"),
    "not finite": (make_nan, "failed", "not finite"),
    "no damage": (lambda job: write_dataset(job / "final.nc", remnant().drop_vars("damage")), "corrupt", "damage"),
    "no particles": (
        lambda job: write_dataset(job / "final.nc", remnant().isel(particle=slice(0, 0))),
        "corrupt",
        "no particle",
    ),
    "no spacing": (
        lambda job: write_dataset(job / "final.nc", remnant().assign_attrs(spacing="x")),
        "corrupt",
        "final.nc",
    ),
    "status": (lambda job: (job / "status.json").write_text("{"), "corrupt", "status.json"),
    "status of a list": (lambda job: (job / "status.json").write_text("[]"), "corrupt", "status.json"),
    "status with a list": (lambda job: (job / "status.json").write_text('{"state": "done", "wall_time": [1]}'), *TIME),
    "status with a text": (lambda job: (job / "status.json").write_text('{"state": "done", "wall_time": "x"}'), *TIME),
    "state": (lambda job: (job / "status.json").write_text('{"state": "well"}'), "corrupt", "state"),
    "advice": (truncate, "corrupt", "move the directory of this job away"),
    "no history": (lambda job: (job / "history.nc").unlink(), "corrupt", "history.nc"),
    "short history": (
        lambda job: write_dataset(job / "history.nc", history(np.zeros(2)).drop_vars("mass")),
        "corrupt",
        "lacks mass",
    ),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_damaged_job_gives_nan_and_its_reason(tmp_path: Path, fault: str) -> None:
    damage, state, reason = FAULTS[fault]
    damage(one_job(tmp_path))
    cell = collect(tmp_path).isel(velocity=0, angle=0)
    assert cell["state"] == state
    assert reason in str(cell["reason"].item()) and "\n" not in str(cell["reason"].item())
    assert np.isnan([cell[name] for name in OUTCOMES]).all()


OTHER_VERSIONS = {
    "physics": (lambda job: write_dataset(job / "final.nc", remnant(physics_version=7)), "physics version 7, not 1"),
    "another scene": (
        lambda job: write_dataset(job / "final.nc", remnant().assign_attrs(scene_hash="other")),
        "not of the scene",
    ),
    "a renamed key": (rename_a_key, "is now"),
    "a scene without bodies": (lambda job: (job / "scene.json").write_text("{}"), "scene.json"),
}


@pytest.mark.parametrize("version", OTHER_VERSIONS)
def test_a_job_of_another_version_is_to_be_kept(tmp_path: Path, version: str) -> None:
    change, reason = OTHER_VERSIONS[version]
    coords: dict[str, list[Any]] = {"angle": [5.0, 15.0]}
    write_campaign(tmp_path, coords, [({"angle": angle}, collision(angle=angle)) for angle in coords["angle"]])
    for number, angle in enumerate(coords["angle"]):
        write_job(tmp_path / f"jobs/{number}", collision(angle=angle), remnant())
    change(tmp_path / "jobs/0")
    results = collect(tmp_path)
    assert results["state"].values.tolist() == ["corrupt", "done"]
    told = str(results["reason"].values[0])
    assert reason in told and "keep it: it may be sound" in told and "delete" not in told


def test_a_scene_that_a_version_with_fewer_keys_wrote_is_measured(tmp_path: Path) -> None:
    job = one_job(tmp_path)
    scene = json.loads((job / "scene.json").read_text())
    del scene["numerics"]["filter_time"]
    text = json.dumps(scene)
    (job / "scene.json").write_text(text)
    scene_hash = hashlib.sha256(text.encode()).hexdigest()
    write_dataset(job / "final.nc", remnant().assign_attrs(scene_hash=scene_hash))
    assert collect(tmp_path)["state"].item() == "done"


@pytest.mark.parametrize("version", OTHER_VERSIONS)
def test_results_of_a_campaign_of_another_version_are_not_replaced(tmp_path: Path, version: str) -> None:
    job = one_job(tmp_path)
    collect(tmp_path)
    before = (tmp_path / "results.nc").read_bytes()
    OTHER_VERSIONS[version][0](job)
    with pytest.raises(SceneError, match=r"keep it: it may be sound.*nothing was written"):
        collect(tmp_path)
    assert (tmp_path / "results.nc").read_bytes() == before


def test_a_fault_of_the_analysis_is_not_laid_on_the_job(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*arguments: object) -> None:
        raise KeyError("x")

    one_job(tmp_path)
    monkeypatch.setattr("analysis.remnant.outcome.clumps_of", fail)
    told = str(collect(tmp_path)["reason"].item())
    assert "KeyError: 'x'" in told and "keep it" in told and "delete" not in told


@pytest.mark.parametrize("order", [1, -1])
def test_a_part_that_some_jobs_leave_out_is_a_parameter(tmp_path: Path, order: int) -> None:
    settings: list[dict[str, Any]] = [{}, {"fracture": False}][::order]
    jobs = [({"case": f"case {number}"}, collision(**given)) for number, given in enumerate(settings)]
    write_campaign(tmp_path, {"case": ["case 0", "case 1"]}, jobs)
    rules = collect(tmp_path)["fracture.flaws"].values.tolist()
    assert rules == ["covered", "none"][::order]


def test_constants_of_a_material_that_some_jobs_have_are_attributes(tmp_path: Path) -> None:
    ice = {"ice": {"cohesion": 1e6, "intact_friction": 1.0, "melt_energy": 7e5, "friction": 0.6}}
    settings: list[dict[str, Any]] = [{}, {"projectile": {"material": "ice"}, "materials": ice}]
    jobs = [({"case": f"case {number}"}, collision(**given)) for number, given in enumerate(settings)]
    write_campaign(tmp_path, {"case": ["case 0", "case 1"]}, jobs)
    results = collect(tmp_path)
    assert not [name for name in results.coords if str(name).startswith("materials.")]
    assert results.attrs["materials.ice.cohesion"] == 1e6
    assert results["projectile.material"].values.tolist() == ["none", "ice"]


@pytest.fixture
def grid(tmp_path: Path) -> Path:
    """A grid whose jobs are done, failed, interrupted, pending, corrupt, and one cell without a job."""
    cells = [(v, a) for v in (100.0, 200.0) for a in (5.0, 15.0, 25.0)]
    jobs = [({"velocity": v, "angle": a}, collision(velocity=v, angle=a)) for v, a in cells]
    write_campaign(tmp_path, {"velocity": [100.0, 200.0], "angle": [5, 15, 25]}, jobs[:5])
    write_job(tmp_path / "jobs/0", jobs[0][1], remnant())
    write_job(tmp_path / "jobs/1", jobs[1][1], None, "failed", "dt fell below\n1e-9 s")
    write_job(tmp_path / "jobs/2", jobs[2][1], None, "running")
    status = tmp_path / "jobs/2/status.json"
    write_json(status, json.loads(status.read_text()) | {"process_start": 0.0})
    write_job(tmp_path / "jobs/4", jobs[4][1], remnant())
    truncate(tmp_path / "jobs/4")
    return tmp_path


def test_every_cell_carries_its_state(grid: Path) -> None:
    results = collect(grid)
    assert results["state"].to_numpy().tolist() == [
        ["done", "failed", "interrupted"],
        ["pending", "corrupt", "missing"],
    ]
    assert results["reason"].sel(velocity=100, angle=15) == "dt fell below 1e-9 s"
    assert np.isfinite(results["mass_ratio"]).to_numpy().tolist() == [[True, False, False], [False] * 3]


def test_results_are_cf_and_come_back_as_written(grid: Path) -> None:
    results = collect(grid)
    again = read_dataset(grid / "results.nc")
    xr.testing.assert_equal(results, again)
    assert set(again.data_vars) == {*OUTCOMES, *TEXTS}
    for name in (*OUTCOMES, "velocity", "angle", "end_time"):
        assert again[name].attrs["units"] and again[name].attrs["long_name"], name
    assert again.attrs["Conventions"].startswith("CF-")
    assert again.attrs["parameter_set"] == "sugiura2018" and again.attrs["materials.basalt.rho0"] == RHO0
    assert again.attrs["viscosity"] == "none" and again.attrs["physics_version"] == 1
    assert "velocity" not in again.attrs


def test_collecting_again_takes_in_what_was_done_since_and_changes_nothing_else(grid: Path) -> None:
    before = collect(grid)
    write_job(grid / "jobs/3", collision(velocity=200.0, angle=5.0), remnant())
    again = collect(grid)
    assert again["state"].sel(velocity=200, angle=5) == "done"
    assert np.isfinite(again["mass_ratio"].sel(velocity=200, angle=5))
    others = (before["state"] != "pending").drop_attrs()
    for name in before.data_vars:
        xr.testing.assert_identical(again[name].where(others), before[name].where(others))
    assert again.attrs == before.attrs


def test_cases_have_their_parameters_as_coordinates(tmp_path: Path) -> None:
    cases = {
        "slow": collision(velocity=100.0, end_time=1500.0),
        "thick": collision(viscosity={"shear": 1e5}),
    }
    write_campaign(tmp_path, {"case": list(cases)}, [({"case": name}, case) for name, case in cases.items()])
    write_job(tmp_path / "jobs/1", cases["thick"], remnant())
    collect(tmp_path)
    results = read_dataset(tmp_path / "results.nc")
    assert results.sizes == {"case": 2}
    assert results["velocity"].sel(case="slow") == 100.0 and results["end_time"].to_numpy().tolist() == [1500.0, 1000.0]
    assert results["angle"].dims == ("case",) and results["angle"].attrs["units"] == "degree"
    np.testing.assert_array_equal(results["viscosity.shear"], [np.nan, 1e5])
    assert np.isfinite(results["b_over_a"]).to_numpy().tolist() == [False, True]


def test_further_axes_keep_their_names(tmp_path: Path) -> None:
    jobs = [
        ({"viscosity.shear": nu, "parameter_set": name}, collision(viscosity={"shear": nu}, parameter_set=name))
        for nu in (0.0, 1e5)
        for name in ("talk", "sugiura2018")
    ]
    write_campaign(tmp_path, {"viscosity.shear": [0.0, 1e5], "parameter_set": ["talk", "sugiura2018"]}, jobs)
    collect(tmp_path)
    results = read_dataset(tmp_path / "results.nc")
    assert dict(results.sizes) == {"viscosity.shear": 2, "parameter_set": 2}
    assert results["job"].sel({"viscosity.shear": 1e5, "parameter_set": "talk"}) == "2"
    assert results["velocity"].dims == ("viscosity.shear", "parameter_set")


def test_a_directory_without_a_campaign_is_named(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"contains no campaign\.json"):
        collect(tmp_path)
    write_json(tmp_path / "campaign.json", {"name": "x"})
    with pytest.raises(SceneError, match=r"campaign\.json: missing key 'physics_version'"):
        collect(tmp_path)


def test_a_job_off_the_axes_is_refused(tmp_path: Path) -> None:
    write_campaign(tmp_path, {"angle": [5.0]}, [({"angle": 15.0}, collision())])
    with pytest.raises(SceneError, match="job '0' has no place on the axis 'angle'"):
        collect(tmp_path)


@pytest.mark.parametrize("name", ["final.nc", "history.nc", "status.json", "scene.json", "snapshots/0000000001.nc"])
def test_a_job_that_cannot_be_read_now_is_kept(tmp_path: Path, name: str) -> None:
    path = one_job(tmp_path) / name
    path.parent.mkdir(exist_ok=True)
    well = tmp_path / "well"
    if path.exists():
        path.rename(well)
    path.symlink_to(BAD_DISK)
    found = collect(tmp_path)
    assert found["state"].item() == "unreadable"
    told = str(found["reason"].item())
    assert str(path) in told and "Input/output error" in told and "again later" in told and "away" not in told
    path.unlink()
    if well.exists():
        well.rename(path)
    assert collect(tmp_path)["state"].item() == "done"
