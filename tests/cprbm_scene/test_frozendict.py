"""A mapping that stays as it is, as a key, in another process and in a copy."""

import copy
import pickle

import pytest

from cprbm_scene.frozendict import frozendict

WAYS = {
    "item": lambda it: it.__setitem__("a", 5),
    "delete": lambda it: it.__delitem__("a"),
    "update": lambda it: it.update(b=5),
    "in place": lambda it: it.__ior__({"b": 5}),
    "setdefault": lambda it: it.setdefault("b", 5),
    "pop": lambda it: it.pop("a"),
    "popitem": lambda it: it.popitem(),
    "clear": lambda it: it.clear(),
}


@pytest.mark.parametrize("way", WAYS.values(), ids=WAYS)
def test_no_way_changes_it(way):
    one = frozendict({"a": 3})
    with pytest.raises(TypeError, match="stays as it is"):
        way(one)
    assert one == {"a": 3}


def test_every_method_of_a_dict_that_changes_it_is_among_the_ways():
    """What a ``dict`` has and a mapping that is only read has not."""
    from types import MappingProxyType

    changing = set(dir(dict)) - set(dir(MappingProxyType)) - {"__getattribute__", "fromkeys"}
    changing = {name for name in changing if getattr(frozendict, name) is getattr(dict, name)}
    assert not changing


def test_order_has_no_part_in_hash_and_equality():
    one, other = frozendict({"a": 3, "b": 7}), frozendict({"b": 7, "a": 3})
    assert one == other
    assert {one: "found"}[other] == "found"
    assert hash(one) != hash(frozendict({"a": 3, "b": 8}))


def test_a_value_without_a_hash_has_none():
    with pytest.raises(TypeError, match="unhashable"):
        hash(frozendict({"a": [3]}))


@pytest.mark.parametrize(
    "again", [copy.copy, copy.deepcopy, lambda it: pickle.loads(pickle.dumps(it))], ids=["copy", "deepcopy", "pickle"]
)
def test_another_of_it_is_of_its_kind(again):
    one = frozendict({"a": frozendict({"b": (1, 2)})})
    other = again(one)
    assert other == one
    assert type(other) is frozendict
    assert type(other["a"]) is frozendict
    assert hash(other) == hash(one)
