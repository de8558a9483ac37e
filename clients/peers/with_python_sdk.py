"""`get_usage_summary` as a server of the Python SDK: with_python_sdk.py DATABASE."""

import sys

from mcp.server import MCPServer
from usage_summary import Home, UsageSummary

home = Home(sys.argv[1])
server = MCPServer("usage", log_level="ERROR")


@server.tool()
async def get_usage_summary(
    object_id: str, window_days: int = 365, as_of: str | None = None, max_examples: int = 5
) -> UsageSummary:
    """Who used a thing, how often, how and how long ago."""
    return home.usage_summary(object_id, window_days, as_of, max_examples)


if __name__ == "__main__":
    server.run()
