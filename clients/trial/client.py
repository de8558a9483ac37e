"""What the trial asks of a client, whoever wrote it."""

from contextlib import AbstractAsyncContextManager
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import Protocol

from trial.places import program


class Era(StrEnum):
    """A revision of the protocol."""

    LEGACY = "legacy"
    MODERN = "modern"

    @property
    def version(self) -> str:
        """Its name."""
        return {Era.LEGACY: "2025-11-25", Era.MODERN: "2026-07-28"}[self]

    @property
    def mode(self) -> str:
        """Its name for the Python clients, which take anything old together."""
        return self.value if self is Era.LEGACY else self.version


# Servers are to log only what is wrong with them.
ENVIRONMENT = {"RUST_LOG": "error"}


@dataclass(frozen=True)
class Stdio:
    """A server that the client starts itself."""

    database: Path

    @property
    def command(self) -> list[str]:
        return [str(program("coin-server")), "--db", str(self.database)]


@dataclass(frozen=True)
class Http:
    """A server that runs already."""

    url: str


Address = Stdio | Http


class Refused(Exception):
    """The server answered with an error of the protocol."""


@dataclass
class Reply:
    """What a tool answered."""

    is_error: bool
    text: str
    structured: dict | None

    @classmethod
    def of(cls, result: dict) -> "Reply":
        """Reads the result of a call."""
        text = "".join(content["text"] for content in result["content"])
        return cls(result.get("isError", False), text, result.get("structuredContent"))


@dataclass
class Person:
    """Whoever sits before the client: what they make of a form, and the forms that they saw."""

    action: str = "accept"
    # What they write into a form; None for the first choice.
    content: dict[str, str] | None = None
    forms: list[dict] = field(default_factory=list)

    def fill_in(self, message: str, schema: dict) -> dict:
        """The form as it goes back."""
        self.forms.append({"message": message, "schema": schema})
        if self.action != "accept":
            return {"action": self.action}
        first = {name: schema["properties"][name]["enum"][0] for name in schema["required"]}
        return {"action": "accept", "content": self.content or first}


class Client(Protocol):
    """A connected client. Everything is JSON as it was sent."""

    # Who answers forms; None where the client shows none.
    person: Person | None
    # Whether it offers completion at all.
    completes: bool

    async def protocol_version(self) -> str | None:
        """The revision that was agreed on, where the client tells."""

    async def tools(self) -> list[dict]: ...

    async def call(self, tool: str, arguments: dict) -> Reply: ...

    async def resources(self) -> list[dict]:
        """All of them, page by page."""

    async def templates(self) -> list[dict]: ...

    async def read(self, uri: str) -> str: ...

    async def prompts(self) -> list[dict]: ...

    async def prompt(self, name: str, arguments: dict[str, str]) -> str: ...

    async def complete(self, reference: dict, argument: str, typed: str) -> list[str]: ...


class Connect(Protocol):
    """How a client is connected to a server."""

    def __call__(self, address: Address, era: Era) -> AbstractAsyncContextManager[Client]: ...
