"""What the Python SDK's client and FastMCP's have in common: both speak in the SDK's types."""

import logging
from collections.abc import Awaitable

import mcp_types
from mcp import MCPError

from trial.client import Person, Refused, Reply

# It warns of a session that the server ends with 202 (accepted) rather than 200, which is as good.
logging.getLogger("mcp.client.streamable_http").setLevel(logging.ERROR)


class SdkTypes:
    """A client of either kind. FastMCP has the SDK's methods under the same names with a suffix."""

    completes = True

    def __init__(self, client, person: Person, suffix: str = ""):
        self.client = client
        self.person = person
        self.suffix = suffix

    async def request(self, method: str, *arguments, **options) -> dict:
        """The answer to a request as the JSON that it came as."""
        call: Awaitable = getattr(self.client, method + self.suffix)(*arguments, **options)
        try:
            answer = await call
        except MCPError as error:
            raise Refused(str(error)) from error
        return answer.model_dump(mode="json", by_alias=True, exclude_none=True)

    async def everything(self, method: str, key: str) -> list[dict]:
        """A list, page by page."""
        items, cursor = [], None
        while True:
            answer = await self.request(method, cursor=cursor)
            items += answer[key]
            cursor = answer.get("nextCursor")
            if cursor is None:
                return items

    async def protocol_version(self) -> str | None:
        return self.client.protocol_version

    async def tools(self) -> list[dict]:
        return await self.everything("list_tools", "tools")

    async def resources(self) -> list[dict]:
        return await self.everything("list_resources", "resources")

    async def templates(self) -> list[dict]:
        return await self.everything("list_resource_templates", "resourceTemplates")

    async def prompts(self) -> list[dict]:
        return await self.everything("list_prompts", "prompts")

    async def call(self, tool: str, arguments: dict) -> Reply:
        return Reply.of(await self.request("call_tool", tool, arguments))

    async def read(self, uri: str) -> str:
        [content] = (await self.request("read_resource", uri))["contents"]
        return content["text"]

    async def prompt(self, name: str, arguments: dict[str, str]) -> str:
        messages = (await self.request("get_prompt", name, arguments))["messages"]
        return "\n".join(message["content"]["text"] for message in messages)

    async def complete(self, reference: dict, argument: str, typed: str) -> list[str]:
        kinds = {"ref/prompt": mcp_types.PromptReference, "ref/resource": mcp_types.ResourceTemplateReference}
        about = kinds[reference["type"]](**reference)
        answer = await self.request("complete", about, {"name": argument, "value": typed})
        return answer["completion"]["values"]
