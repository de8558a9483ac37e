"""The command line of MCP Inspector. Every request is a run of its own; over stdio it starts a server of its own too."""

import asyncio
import json
import sys
import tempfile
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from trial.client import ENVIRONMENT, Address, Era, Http, Refused, Reply
from trial.places import node
from trial.report import tried

LAUNCHER = "@modelcontextprotocol/inspector/clients/launcher/build/index.js"

# The exit status where a tool answers with isError, or, without a result, where there is no such tool.
TOOL_ERROR = 5


class Inspector:
    person = None
    completes = False

    def __init__(self, target: list[str], era: Era, settings: str):
        self.target = target
        self.options = ["--protocol-era", era.value, "--format", "json", "--quiet"]
        self.settings = settings

    async def request(self, method: str, *options: str) -> dict:
        command = [*node(LAUNCHER), "--cli", *self.options, "--method", method, *options, *self.target]
        run = await asyncio.create_subprocess_exec(
            *command,
            stdin=asyncio.subprocess.DEVNULL,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.PIPE,
            # Its own settings and catalogues of servers stay as they are.
            env={"HOME": self.settings, "PATH": "/usr/bin:/bin"} | ENVIRONMENT,
        )
        output, errors = await run.communicate()
        if run.returncode not in (0, TOOL_ERROR) or not output:
            raise Refused(errors.decode())
        return json.loads(output)["result"]

    async def protocol_version(self) -> str | None:
        return None

    async def tools(self) -> list[dict]:
        return (await self.request("tools/list", "--strict"))["tools"]

    async def resources(self) -> list[dict]:
        return (await self.request("resources/list"))["resources"]

    async def templates(self) -> list[dict]:
        return (await self.request("resources/templates/list"))["resourceTemplates"]

    async def prompts(self) -> list[dict]:
        return (await self.request("prompts/list"))["prompts"]

    async def call(self, tool: str, arguments: dict) -> Reply:
        options = ["--tool-name", tool, "--tool-args-json", json.dumps(arguments)]
        return Reply.of(await self.request("tools/call", *options))

    async def read(self, uri: str) -> str:
        [content] = (await self.request("resources/read", "--uri", uri))["contents"]
        return content["text"]

    async def prompt(self, name: str, arguments: dict[str, str]) -> str:
        pairs = [f"{argument}={value}" for argument, value in arguments.items()]
        options = ["--prompt-name", name, *(["--prompt-args", *pairs] if pairs else [])]
        messages = (await self.request("prompts/get", *options))["messages"]
        return "\n".join(message["content"]["text"] for message in messages)


@asynccontextmanager
async def connect(address: Address, era: Era) -> AsyncIterator[Inspector]:
    target = ["--", address.url] if isinstance(address, Http) else ["--", *address.command]
    with tempfile.TemporaryDirectory() as settings:
        yield Inspector(target, era, settings)


if __name__ == "__main__":
    sys.exit(tried("Inspector", connect))
