"""`get_usage_summary` as a FastMCP server: with_fastmcp.py DATABASE."""

import sys

from fastmcp import FastMCP
from usage_summary import Home, UsageSummary

home = Home(sys.argv[1])
server = FastMCP("usage")


@server.tool
async def get_usage_summary(
    object_id: str, window_days: int = 365, as_of: str | None = None, max_examples: int = 5
) -> UsageSummary:
    """Who used a thing, how often, how and how long ago."""
    return home.usage_summary(object_id, window_days, as_of, max_examples)


if __name__ == "__main__":
    server.run(show_banner=False)
