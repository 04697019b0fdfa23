from engine.scene.tables import overlay

EOS = {"form": "tillotson", "A": 1.0, "B": 2.0}


def test_tables_merge_at_any_depth_and_anything_else_is_replaced():
    base = {"a": {"b": {"c": 1, "d": 2}}, "e": 3, "f": {"g": 4}}
    assert overlay(base, {"a": {"b": {"c": 5}}, "f": None, "h": 6}) == {
        "a": {"b": {"c": 5, "d": 2}},
        "e": 3,
        "f": None,
        "h": 6,
    }
    assert base["a"]["b"] == {"c": 1, "d": 2}


def test_constants_of_another_form_replace_those_below():
    assert overlay({"eos": EOS}, {"eos": {"form": "murnaghan", "K": 3.0}}) == {"eos": {"form": "murnaghan", "K": 3.0}}
    for same in ({"A": 5.0}, {"form": "tillotson", "A": 5.0}):
        assert overlay({"eos": EOS}, {"eos": same}) == {"eos": {"form": "tillotson", "A": 5.0, "B": 2.0}}
