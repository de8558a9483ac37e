"""Tries a client over every transport in every revision of the protocol, and says what worked."""

import asyncio
import tempfile
import traceback
from contextlib import AsyncExitStack
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path

from trial import homes, steps
from trial.client import Address, Client, Connect, Era, Http, Stdio
from trial.places import program
from trial.table import aligned

WORKED, FAILED, NOT_OFFERED = "✓", "✗", "–"

CONNECTION, ALL_TOOLS, ALL_PAGES = "connection", "all tools known", "all pages"


@dataclass
class Column:
    """What became of the steps over one transport in one revision."""

    title: str
    outcomes: dict[str, str] = field(default_factory=dict)
    failures: list[str] = field(default_factory=list)

    async def attempt(self, name: str, work) -> None:
        """Does a step, and notes what became of it."""
        try:
            await work
            self.outcomes[name] = WORKED
        except Exception:
            self.outcomes[name] = FAILED
            self.failures.append(f"{name}, {self.title}\n{traceback.format_exc()}")


async def known(tools: list[dict]) -> None:
    """A tool that is new needs a step, and a step needs its tool."""
    listed = {tool["name"] for tool in tools}
    assert listed == steps.TOOLS.keys(), f"without a step or without a tool: {listed ^ steps.TOOLS.keys()}"


async def all_pages(client: Client) -> None:
    """A list of many pages, of which the client fetches each."""
    uris = {resource["uri"] for resource in await client.resources()}
    assert len(uris) == homes.CROWD + 2, f"{len(uris)} resources"


async def try_era(column: Column, connect: Connect, home: Address, crowd: Address, era: Era) -> None:
    async with connect(home, era) as client:
        version = await client.protocol_version()
        assert version in (None, era.version), f"{version} was agreed on"
        tools = await client.tools()
        trial = steps.Trial(client, tools)
        await column.attempt(ALL_TOOLS, known(tools))
        for name, step in (steps.TOOLS | steps.FURTHER).items():
            if step is steps.completion and not client.completes:
                column.outcomes[name] = NOT_OFFERED
            else:
                await column.attempt(name, step(trial))
    async with connect(crowd, era) as client:
        await column.attempt(ALL_PAGES, all_pages(client))


def over_http(database: Path, stack: AsyncExitStack) -> Http:
    command = [program("coin-server"), "--db", database, "--http", "127.0.0.1:0"]
    return Http(stack.enter_context(homes.serving(command)))


async def try_everything(connect: Connect) -> list[Column]:
    """Tries all columns at once; each has a home of its own."""
    columns, attempts = [], []
    async with AsyncExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        crowd = homes.crowded_home(folder)
        reaches = {"stdio": Stdio, "HTTP": lambda database: over_http(database, stack)}
        for (transport, reach), era in product(reaches.items(), Era):
            column = Column(f"{transport} {era.version}")
            columns.append(column)
            work = try_era(column, connect, reach(homes.a_day_in(folder)), reach(crowd), era)
            attempts.append(column.attempt(CONNECTION, work))
        await asyncio.gather(*attempts)
    return columns


def tried(name: str, connect: Connect) -> int:
    """Prints what worked; the exit status."""
    columns = asyncio.run(try_everything(connect))
    rows = dict.fromkeys([CONNECTION, *(row for column in columns for row in column.outcomes)])
    print(aligned([name, *(column.title for column in columns)], [
        [row, *(column.outcomes.get(row, FAILED) for column in columns)] for row in rows
    ]))
    failures = [failure for column in columns for failure in column.failures]
    for failure in failures:
        print(f"\n{failure}")
    return 1 if failures else 0
