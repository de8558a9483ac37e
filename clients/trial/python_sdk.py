"""The client of the Python SDK."""

import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

import mcp_types
from mcp import Client, StdioServerParameters

from trial.client import ENVIRONMENT, Address, Era, Http, Person
from trial.report import tried
from trial.sdk_types import SdkTypes


@asynccontextmanager
async def connect(address: Address, era: Era) -> AsyncIterator[SdkTypes]:
    person = Person()

    async def show(_, form: mcp_types.ElicitRequestFormParams) -> mcp_types.ElicitResult:
        return mcp_types.ElicitResult(**person.fill_in(form.message, form.requested_schema))

    match address:
        case Http(url):
            server = url
        case stdio:
            command, *arguments = stdio.command
            server = StdioServerParameters(command=command, args=arguments, env=ENVIRONMENT)
    async with Client(server, mode=era.mode, elicitation_callback=show) as client:
        yield SdkTypes(client, person)


if __name__ == "__main__":
    sys.exit(tried("Python SDK", connect))
