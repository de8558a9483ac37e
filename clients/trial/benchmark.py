"""How long `get_usage_summary` takes on coin-server and on peers: the same tool, file, calls and client."""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from statistics import median, quantiles

from trial import homes
from trial.places import CLIENTS, NODE, REPOSITORY, SMALL_HOUSE, program
from trial.table import aligned, markdown

PEERS = REPOSITORY / "clients/peers"

OURS, FASTMCP, PYTHON_SDK, TYPESCRIPT_SDK = "coin-server", "FastMCP", "Python SDK", "TypeScript SDK v2"

# How many times as long as coin-server a peer must take at the median, on one processor.
REQUIRED = {FASTMCP: 15.0, TYPESCRIPT_SDK: 3.0}


@dataclass
class Plan:
    """How much is measured."""

    starts: int
    warm_up: int
    rounds: int
    calls_a_round: int


THOROUGH = Plan(starts=5, warm_up=340, rounds=5, calls_a_round=1020)
QUICK = Plan(starts=2, warm_up=340, rounds=3, calls_a_round=340)


def commands(database: Path) -> dict[str, list[str]]:
    python = str(CLIENTS / "python/bin/python")
    return {
        OURS: [str(program("coin-server")), "--db", str(database)],
        TYPESCRIPT_SDK: [str(NODE), str(PEERS / "with_typescript_sdk.mjs"), str(database)],
        PYTHON_SDK: [python, str(PEERS / "with_python_sdk.py"), str(database)],
        FASTMCP: [python, str(PEERS / "with_fastmcp.py"), str(database)],
    }


def things() -> list[str]:
    """The ids of all things of the home."""
    episode = json.loads((SMALL_HOUSE / "episode.json").read_text())
    return [thing["id"] for thing in episode["objects"]]


def measured(plan: Plan, database: Path, pinned: bool) -> list[dict]:
    """Figures of all servers, which gave equal results."""
    servers = [{"name": name, "command": command} for name, command in commands(database).items()]
    calls = [{"name": "get_usage_summary", "arguments": {"object_id": thing}} for thing in things()]
    command = [program("measure-calls")]
    if pinned:
        command = ["taskset", "-c", str(max(os.sched_getaffinity(0))), *command]
    run = subprocess.run(
        command,
        input=json.dumps({"servers": servers, "calls": calls, **vars(plan)}),
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    figures = json.loads(run.stdout)
    for peer in figures[1:]:
        assert peer["results"] == figures[0]["results"], f"{peer['name']} gives other results than {OURS}"
    return figures


def typical(peer: dict) -> float:
    """The median of all calls, in microseconds."""
    return median(call for calls in peer["microseconds"] for call in calls)


def row(peer: dict, ours: dict) -> list[str]:
    calls = [call for calls in peer["microseconds"] for call in calls]
    medians = [median(calls) for calls in peer["microseconds"]]
    return [
        peer["name"],
        f"{typical(peer):.0f}",
        f"{typical(peer) / typical(ours):.1f} ×",
        f"{min(medians):.0f}–{max(medians):.0f}",
        f"{quantiles(calls, n=100)[98]:.0f}",
        f"{peer['processor_microseconds_a_call']:.0f}",
        f"{median(peer['start_milliseconds']):.0f}",
        f"{peer['peak_memory_mebibytes']:.0f}",
    ]


HEAD = ["server", "median µs", "of ours", "of rounds", "p99 µs", "CPU µs", "start ms", "peak MiB"]


def shortfalls(ours: dict, peers: list[dict]) -> list[str]:
    """What is required and not reached."""
    ratios = {peer["name"]: typical(peer) / typical(ours) for peer in peers}
    return [
        f"{name} takes {ratios[name]:.1f} times as long as {OURS}; {required:.0f} times is required"
        for name, required in REQUIRED.items()
        if ratios[name] < required
    ]


def main() -> int:
    arguments = argparse.ArgumentParser(prog="clients/run benchmark", description=__doc__)
    arguments.add_argument(
        "--check",
        action="store_true",
        help="measure on one processor, little at first and thoroughly where that falls short; fail below what is required",
    )
    arguments.add_argument("--markdown", action="store_true", help="print the tables as docs/latency.md has them")
    given = arguments.parse_args()
    table = markdown if given.markdown else aligned

    def measure(plan: Plan, pinned: bool) -> list[str]:
        ours, *peers = figures = measured(plan, database, pinned)
        print("\nclient and server on one processor\n" if pinned else "\nclient and server on any processor\n")
        print(table(HEAD, [row(peer, ours) for peer in figures]))
        return shortfalls(ours, peers) if pinned else []

    with tempfile.TemporaryDirectory() as folder:
        database = homes.small_house(Path(folder))
        if given.check:
            missed = measure(QUICK, pinned=True) and measure(THOROUGH, pinned=True)
        else:
            missed = measure(THOROUGH, pinned=True) + measure(THOROUGH, pinned=False)
    for shortfall in missed:
        print(f"\n{shortfall}")
    return 1 if given.check and missed else 0


if __name__ == "__main__":
    sys.exit(main())
