"""What a user says of the records, by options or by answers, and what he is still asked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal

from sms.errors import InputError
from sms.io.signals import without_leg

Subject = Literal["column", "unit", "offset", "scale", "pressures", "parameter"]


@dataclass(frozen=True)
class Given:
    """What needs no guess. Keys are signals; of a platform also without the number of a leg, for all three."""

    column: Mapping[str, str] = field(default_factory=dict)
    unit: Mapping[str, str] = field(default_factory=dict)
    offset: Mapping[str, str] = field(default_factory=dict)
    scale: Mapping[str, str] = field(default_factory=dict)
    parameter: Mapping[str, str] = field(default_factory=dict)
    pressures: str | None = None  #: "gauge" or "absolute", where headers say nothing
    accept: bool = False  #: doubtful guesses, too

    def of(self, subject: Subject, signal: str) -> str | None:
        """What was said of a signal, or of its kind on every leg."""
        said: Mapping[str, str] = getattr(self, subject)
        return said.get(signal, said.get(without_leg(signal)))

    def with_answer(self, subject: Subject, name: str, answer: str) -> Given:
        """The same with one more thing said."""
        if subject == "pressures":
            return replace(self, pressures=answer)
        changed: dict[str, Any] = {subject: {**getattr(self, subject), name: answer}}
        return replace(self, **changed)


class Question(InputError):
    """What the records do not tell. Without somebody to ask, it is an InputError that names the option to give."""

    def __init__(
        self,
        subject: Subject,
        name: str,
        problem: str,
        example: str,
        suggestion: str | None = None,
        choices: tuple[str, ...] = (),
    ) -> None:
        """problem: what cannot be told, half a sentence; suggestion: a doubtful guess, which --yes accepts."""
        option = (
            f"--{subject} {example}" if subject == "pressures" else f"--{subject} {name}={example}"
        )
        accept = f"; or accept the guess, {suggestion}, with --yes" if suggestion else ""
        super().__init__(f"{problem}; give {option}{accept}")
        self.subject: Subject = subject
        self.name, self.problem = name, problem
        self.suggestion, self.choices = suggestion, choices
