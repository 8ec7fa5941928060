"""What a reader of an answer should know besides its numbers.

Where no mesh that is fitted to a station's contacts has a certified state, the one on even elements stands: as
believable, but its error changes with where in their elements the contacts end, and two of them say less of it.
"""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass
class Remarks:
    """What was seen at the stations so far.

    Attributes:
        even: stations on even elements though there is contact, in order.
        passed: ends of branches beside which the march went on, in order.
    """

    even: list[str] = field(default_factory=list)
    passed: list[str] = field(default_factory=list)

    def told(self) -> list[str]:
        """Sentences of all that was seen."""
        said = []
        if self.even:
            said.append(
                f"at {', '.join(self.even)} no mesh fitted to where contact is had a certified state: the values are "
                "of even elements, and their error changes unevenly with the number of links"
            )
        said += [
            f"the branch ends, {end}, and was left for the state beside it to which the decrease of the energy leads"
            for end in self.passed
        ]
        return said
