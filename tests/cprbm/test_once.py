"""A property that is worked out when it is asked for first, and then kept."""

from dataclasses import dataclass, replace

from cprbm.once import once


@dataclass(frozen=True)
class Sum:
    one: float
    asked: list[float]

    @once
    def twice(self) -> float:
        """Two times it."""
        self.asked.append(self.one)
        return 2.0 * self.one


def test_it_is_worked_out_once_of_each_object():
    one = Sum(3.7, [])
    other = replace(one, one=-0.9)
    assert (one.twice, one.twice, other.twice, one.twice, other.twice) == (7.4, 7.4, -1.8, 7.4, -1.8)
    assert one.asked == [3.7, -0.9]


def test_asked_of_the_class_it_says_what_it_is():
    assert Sum.twice.__doc__ == "Two times it."
