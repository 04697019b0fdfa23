"""Every wrong input is one clear line per mistake, exit code 2, and nothing written."""

import json

import pytest

from campaigns.study import SHIPPED

GRID = "[axes]\nvelocity = [100, 200]\nangle = [5]\n"
HEAD = 'name = "small"\n'

BAD_STUDIES = {
    "misspelt key of the study": (HEAD + "descripton = 'x'\n" + GRID, ["descripton", "did you mean 'description'"]),
    "misspelt setting": (
        HEAD + "[collision]\ntarget.raduis = 1e4\n" + GRID,
        ["collision", "target.raduis", "mean 'radius'"],
    ),
    "misspelt nested setting": (
        HEAD + "[collision.numerics]\nclf = 0.3\n" + GRID,
        ["numerics.clf", "did you mean 'cfl'"],
    ),
    "misspelt axis": (HEAD + "[axes]\nvelocty = [100]\nangle = [5]\n", ["axes.velocty", "did you mean 'velocity'"]),
    "setting outside of its table": (
        HEAD + "cfl = 0.1\n" + GRID,
        ["unknown key 'cfl'", "did you mean 'collision.numerics.cfl'"],
    ),
    "axis without its table": (
        HEAD + "[axes]\nvelocity = [1]\nangle = [5]\ncfl = [0.1]\n",
        ["unknown key 'axes.cfl'", "did you mean 'numerics.cfl'"],
    ),
    "old setting": (HEAD + "[collision]\nradius = 1e4\n" + GRID, ["collision: 'radius' is now 'target.radius'"]),
    "old axis": (
        HEAD + "[axes]\nvelocity = [1]\nangle = [5]\nmaterial.damaged_friction = [0.5]\n",
        ["'axes.material.damaged_friction' is now 'axes.materials.basalt.friction'"],
    ),
    "old key of a case": (
        HEAD + GRID + "[[cases]]\nprojectile_radius = 1e4\n",
        ["case 1: 'projectile_radius' is now 'projectile.radius'"],
    ),
    "old constant of a case": (
        HEAD + GRID + "[[cases]]\nmaterial.damaged_friction = 0.5\n",
        ["case 1: 'material.damaged_friction' is now 'materials.basalt.friction'"],
    ),
    "old constant of all": (
        HEAD + "[collision]\nmaterial = {damaged_friction = 0.5}\n" + GRID,
        ["collision: 'material.damaged_friction' is now 'materials.basalt.friction'"],
    ),
    "name of a material in place of its table": (
        HEAD + "[collision]\nmaterials.basalt = 'ice'\n" + GRID + "[[cases]]\nmaterials.basalt.friction = 0.3\n",
        ["'materials.basalt'", 'a table, as {name = "ice"}, not text'],
    ),
    "name of a material in place of its table in a case": (
        HEAD + GRID + "[[cases]]\nmaterials.mine = 'ice'\n",
        ["case 1: 'materials.mine'", 'a table, as {name = "ice"}, not text'],
    ),
    "two forms of equation of state": (
        HEAD + "[collision]\nmaterials.hard = {name = 'basalt', eos = {form = 'murnaghan', K = 2e10, n = 4}}\n"
        "projectile.material = 'hard'\n" + GRID,
        ["'target.material' basalt and 'projectile.material' hard", "'materials.hard.eos.form' is murnaghan"],
    ),
    "spin without end": (
        HEAD + "[axes]\nvelocity = [1]\nangle = [5]\ntarget.spin_period = [1e-307]\n",
        ["'target.spin_period' 1e-307 h", "give at least"],
    ),
    "false among numbers": (
        HEAD + "[axes]\nvelocity = [1]\nangle = [5]\ntarget.spin_period = [false, 8]\n",
        ["'axes.target.spin_period' mixes false with numbers", "[[cases]]", "1e9 h"],
    ),
    "material that lacks constants": (
        HEAD + "[axes]\nvelocity = [1]\nangle = [5]\nprojectile.material = ['basalt', 'ice']\n",
        ["'materials.ice' lacks cohesion", "which strength needs: give them"],
    ),
    "misspelt material": (
        HEAD + "[axes]\nvelocity = [1]\nangle = [5]\ntarget.material = ['basalt', 'icee']\n",
        ["'target.material': unknown material 'icee'", "did you mean 'ice'"],
    ),
    "materials as axis": (
        HEAD + "[axes]\nvelocity = [1]\nangle = [5]\nmaterials.basalt.eos = [1]\n",
        ["'axes.materials.basalt.eos' is a table", "materials.basalt.eos.A"],
    ),
    "misspelt constant as axis": (
        HEAD + "[axes]\nvelocity = [1]\nangle = [5]\nmaterials.basalt.frictoin = [1]\n",
        ["unknown key 'axes.materials.basalt.frictoin'", "did you mean 'materials.basalt.friction'"],
    ),
    "switch as velocity": (HEAD + "[axes]\nvelocity = [true]\nangle = [5]\n", ["'velocity'", "not true or false"]),
    "negative radius": (
        HEAD + "[collision]\ntarget.radius = -5.0\n" + GRID,
        ["'target.radius'", "greater than 0", "-5.0"],
    ),
    "steep angle": (HEAD + "[axes]\nvelocity = [100]\nangle = [95]\n", ["'angle'", "90", "95"]),
    "negative angle": (HEAD + "[axes]\nvelocity = [100]\nangle = [-1]\n", ["'angle'", "0", "-1"]),
    "no velocity": (HEAD + "[axes]\nvelocity = [0]\nangle = [5]\n", ["'velocity'", "greater than 0"]),
    "infinite velocity": (HEAD + "[axes]\nvelocity = [inf]\nangle = [5]\n", ["'velocity'", "finite"]),
    "word as velocity": (HEAD + "[axes]\nvelocity = ['fast']\nangle = [5]\n", ["'velocity'", "number", "fast"]),
    "velocity without orbit": (
        HEAD + "[collision]\ngravity = false\n[axes]\nvelocity = [1e-300]\nangle = [5]\n",
        ["no scene can be built"],
    ),
    "case inside an axis": (
        HEAD + "[axes]\nviscosity.shear = [1, 2]\n[[cases]]\nvelocity = 100\nangle = 5\nviscosity = false\n",
        ["case 1", "'viscosity' and 'axes.viscosity.shear' are parts of each other"],
    ),
    "deep tables": (HEAD + GRID + f"[collision.{'a.' * 300}a]\nb = 1\n", ["more than 20 tables"]),
    "deep lists": (HEAD + GRID + f"x = {'[' * 5000}{']' * 5000}\n", ["not valid TOML"]),
    "huge number": (HEAD + f"[collision]\nparticles = {'9' * 5000}\n" + GRID, ["not valid TOML", "4300"]),
    "no particles": (HEAD + "[collision]\nparticles = 0\n" + GRID, ["'particles'", "1", "0"]),
    "half a particle": (HEAD + "[collision]\nparticles = 10.5\n" + GRID, ["'particles'", "10.5"]),
    "ends before contact": (HEAD + "[collision]\nend_time = -1\n" + GRID, ["end_time", "-1"]),
    "unknown parameter set": (
        HEAD + "[collision]\nparameter_set = 'tlak'\n" + GRID,
        ["unknown parameter_set 'tlak'", "did you mean 'talk'"],
    ),
    "missing angle": (HEAD + "[axes]\nvelocity = [100]\n", ["missing key 'angle'"]),
    "missing name": (GRID, ["missing key 'name'"]),
    "name that leaves the directory": ("name = '../up'\n" + GRID, ["'name'", "../up"]),
    "empty axis": (HEAD + "[axes]\nvelocity = []\nangle = [5]\n", ["axes.velocity", "at least one"]),
    "no axes": (HEAD + "[axes]\n", ["'axes' is empty"]),
    "single value as axis": (HEAD + "[axes]\nvelocity = 100\nangle = [5]\n", ["axes.velocity", "list", "100"]),
    "repeated value": (HEAD + "[axes]\nvelocity = [100, 100.0]\nangle = [5]\n", ["axes.velocity", "twice"]),
    "repeated value as text": (
        HEAD + "[axes]\nvelocity = [100, '100']\nangle = [5]\n",
        ["velocity", "number, not text", "'100'"],
    ),
    "axis without effect": (
        HEAD + "[collision]\nmaterials.basalt.friction = 0.5\n[collision.fracture]\n"
        "flaws = 'covered'\nstrain = 'young'\ngrowth_speed = 0.4\nper_flaw = true\n"
        "[axes]\nvelocity = [100]\nangle = [5]\nparameter_set = ['talk', 'sugiura2018']\n",
        ["talk", "sugiura2018", "same simulation"],
    ),
    "table as axis": (HEAD + "[axes]\nvelocity = [100]\nangle = [5]\nviscosity = [1]\n", ["table", "viscosity.shear"]),
    "lists as values": (HEAD + "[axes]\nvelocity = [[100]]\nangle = [5]\n", ["axes.velocity", "single values"]),
    "case off the axes": (HEAD + GRID + "[[cases]]\nangle = 7\n", ["case 1", "'angle' is 7", "axes.angle"]),
    "case without effect beside axes": (
        HEAD + GRID + "[[cases]]\n[[cases]]\ntarget.radius = 5e4\n",
        ["case base, velocity 100.0", "case target.radius50000, velocity 100.0", "same simulation"],
    ),
    "cases of the same name": (
        HEAD + GRID + "[[cases]]\nname = 'a'\n[[cases]]\nname = 'a'\ntarget.radius = 1e4\n",
        ["case a, velocity 100.0", "coincide", "different names"],
    ),
    "name of a case that leaves the directory": (HEAD + GRID + "[[cases]]\nname = '../up'\n", ["name", "../up"]),
    "neither axes nor cases": (HEAD, ["give [axes]", "or [[cases]]"]),
    "empty cases": (HEAD + "cases = []\n", ["'cases' is empty"]),
    "misspelt case": (HEAD + "[[cases]]\nvelocity = 100\nangel = 5\n", ["case 1", "did you mean 'angle'"]),
    "repeated case": (
        HEAD + "[collision]\nangle = 5\n[[cases]]\nvelocity = 100\n[[cases]]\nvelocity = 100.0\nangle = 5.0\n",
        ["same simulation"],
    ),
    "misspelt error bars": (HEAD + GRID + "[error_bars]\nseed = [1, 2]\n", ["error_bars.seed", "mean 'seeds'"]),
    "one seed": (HEAD + GRID + "[error_bars]\nseeds = [1]\n", ["error_bars.seeds", "at least 2"]),
    "equal seeds": (HEAD + GRID + "[error_bars]\nseeds = [1, 1]\n", ["error_bars", "twice"]),
    "an order of zero": (
        HEAD + GRID + "[error_bars]\norder = 0\nseeds = [1, 2]\n",
        ["error_bars.order", "greater than 0"],
    ),
    "second resolution as fine": (HEAD + GRID + "[error_bars]\ncoarser = 1.0\nseeds = [1, 2]\n", ["coarser", "1"]),
    "second resolution of as many particles": (
        HEAD + "[collision]\nparticles = 1\n" + GRID + "[error_bars]\nseeds = [1, 2]\n",
        ["resolution coarse", "resolution fine", "same simulation"],
    ),
    "seeds as an axis beside error bars": (
        HEAD + GRID + "seed = [1, 2]\n[error_bars]\nseeds = [1, 2]\n",
        ["axes: 'seed'", "error_bars.seeds"],
    ),
    "seed of a case beside error bars": (
        HEAD + "[error_bars]\nseeds = [1, 2]\n[[cases]]\nvelocity = 1\nangle = 5\nseed = 3\n",
        ["case 1: 'seed'", "error_bars.seeds"],
    ),
    "no TOML": ("name = small", ["not valid TOML"]),
    "no text": ("name = '\x00'", ["not valid TOML"]),
}


@pytest.mark.parametrize(("text", "expected"), BAD_STUDIES.values(), ids=BAD_STUDIES.keys())
@pytest.mark.parametrize("verb", ["run", "plan"])
def test_bad_study(verb, text, expected, command, write_study, runs):
    study = write_study(text)
    result = command(verb, study)
    assert result.code == 2
    assert result.out == ""
    for words in expected:
        assert words in result.err
    assert all(str(study) in line for line in result.err.splitlines())
    assert list(runs.parent.iterdir()) == [study]


def test_every_mistake_is_named_once(command, write_study):
    result = command("run", write_study(HEAD + "[collision]\ntarget.radius = -1\nparticles = 0\n" + GRID))
    assert len(result.err.splitlines()) == 2


def test_unknown_study(command, runs):
    result = command("run", "quik")
    assert result.code == 2
    assert "did you mean 'quick'" in result.err
    assert not runs.exists()


def test_a_study_unlike_any_other_names_those_there_are(command):
    names = sorted(path.stem for path in SHIPPED.glob("*.toml"))
    assert f"; known studies: {', '.join(names)}" in command("run", "zzzz").err


def test_directory_as_study(command, tmp_path):
    result = command("run", tmp_path)
    assert result.code == 2
    assert "cannot be read" in result.err


@pytest.mark.parametrize(
    ("key", "value", "expected"),
    [
        ("name", "other", "belongs to study 'other'"),
        ("physics_version", -1, "physics version -1"),
        ("jobs", 5, "'jobs'"),
    ],
)
def test_foreign_directory(key, value, expected, command, write_study, runs, tree):
    command("run", write_study())
    file = runs / "small" / "campaign.json"
    file.write_text(json.dumps(json.loads(file.read_text()) | {key: value}))
    before = tree(runs)
    result = command("run", write_study(velocity="[300]"))
    assert result.code == 2
    assert expected in result.err
    assert tree(runs) == before


def test_other_settings(command, write_study, runs, tree):
    command("run", write_study())
    before = tree(runs)
    result = command("run", write_study(collision="target.radius = 1e4"))
    assert result.code == 2
    assert "target.radius 50000.0 there and 10000.0 in the study" in result.err
    assert "RUNS=" in result.err
    assert tree(runs) == before


def test_a_campaign_of_another_version_is_kept_and_told_about_in_few_lines(command, write_study, runs, tree):
    command("run", write_study(angle="[5, 15]"))
    file = runs / "small" / "campaign.json"
    content = json.loads(file.read_text())
    for job in content["jobs"]:
        job["collision"] |= {"friction": 0.5, "radius": 5e4, "projectile_radius": None, "material": {"rho0": 2700.0}}
    file.write_text(json.dumps(content))
    before = tree(runs)
    for verb in ("run", "plan", "status", "resume"):
        result = command(verb, write_study())
        assert result.code == 2
        assert "'jobs.0.collision.friction' is now" in result.err and "jobs.1" not in result.err
        assert "keep it" in result.err and "RUNS=DIR" in result.err and "delete" not in result.err
        assert "and 13 more like these" in result.err and len(result.err.splitlines()) == 5
    assert tree(runs) == before


@pytest.mark.parametrize("content", ["[]", '{"jobs": ' + "[" * 30 + "]" * 30 + "}"])
def test_json_that_is_no_campaign_is_kept(content, command, write_study, runs):
    command("run", write_study())
    (runs / "small" / "campaign.json").write_text(content)
    result = command("run", write_study())
    assert result.code == 2 and "keep it" in result.err and "delete" not in result.err


def test_many_other_settings_are_told_in_short(command, write_study):
    command("run", write_study())
    result = command("run", write_study(collision="parameter_set = 'talk'"))
    assert result.code == 2
    assert "fracture.flaws covered there and 2NlnN in the study" in result.err and ", and 2 more)" in result.err


def test_same_settings_in_other_words(command, write_study):
    command("run", write_study())
    assert command("plan", write_study(collision="target.radius = 50_000\nseed = 1")).code == 0


def test_directory_with_other_things(command, write_study, runs, tree):
    (runs / "small").mkdir(parents=True)
    (runs / "small" / "holiday.jpg").write_bytes(b"")
    result = command("run", write_study())
    assert result.code == 2
    assert "not a campaign's" in result.err
    assert list(tree(runs)) == ["small/holiday.jpg"]


def test_damaged_campaign_file(command, write_study, runs):
    command("run", write_study())
    (runs / "small" / "campaign.json").write_text("{")
    for verb in ("run", "plan", "status", "resume"):
        result = command(verb, write_study())
        assert result.code == 2
        assert "campaign.json: not valid JSON" in result.err
        assert "move this file away and run the study again" in result.err
    (runs / "small" / "campaign.json").unlink()
    before = {path: path.read_bytes() for path in runs.glob("small/jobs/*/*")}
    assert command("run", write_study()).code == 0
    assert {path: path.read_bytes() for path in before} == before
    assert (runs / "small" / "campaign.json").is_file()


@pytest.mark.parametrize("verb", ["status", "resume"])
def test_no_campaign_yet(verb, command, write_study, runs):
    result = command(verb, write_study())
    assert result.code == 2
    assert "contains no campaign" in result.err
    assert not runs.exists()


@pytest.mark.parametrize("options", [["--workers", "0"], ["--threads-per-job", "-1"], ["--arch", "abacus"], ["--fast"]])
def test_bad_option(options, command, write_study, runs):
    assert command("run", write_study(), *options).code == 2
    assert not runs.exists()
