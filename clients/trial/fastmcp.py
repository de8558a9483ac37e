"""The client of FastMCP."""

import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from fastmcp import Client
from fastmcp.client.elicitation import ElicitResult
from fastmcp.client.transports import StdioTransport

from trial.client import ENVIRONMENT, Address, Era, Http, Person
from trial.report import tried
from trial.sdk_types import SdkTypes


@asynccontextmanager
async def connect(address: Address, era: Era) -> AsyncIterator[SdkTypes]:
    person = Person()

    async def show(message: str, _, form, __) -> ElicitResult:
        return ElicitResult(**person.fill_in(message, form.requested_schema))

    match address:
        case Http(url):
            server = url
        case stdio:
            command, *arguments = stdio.command
            server = StdioTransport(command, arguments, env=ENVIRONMENT, keep_alive=False)
    async with Client(server, mode=era.mode, elicitation_handler=show) as client:
        yield SdkTypes(client, person, suffix="_mcp")


if __name__ == "__main__":
    sys.exit(tried("FastMCP", connect))
