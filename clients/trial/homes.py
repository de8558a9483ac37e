"""Homes to call upon, and servers of them."""

import json
import os
import re
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from trial.places import SMALL_HOUSE, program

# More than a page of the list of resources holds.
CROWD = 230


def imported(episode: Path, database: Path) -> Path:
    """An episode as a database."""
    command = [program("coin-server"), "import", "--episode", episode, "--db", database]
    subprocess.run(command, check=True, stderr=subprocess.DEVNULL)
    return database


def small_house(folder: Path) -> Path:
    """A family's home, as at the end of a week of captions. Every call makes a new one."""
    return imported(SMALL_HOUSE, folder / f"small-house-{len(list(folder.iterdir()))}.db")


def crowded_home(folder: Path) -> Path:
    """A home with more things than a page of a list holds."""
    things = [{"id": f"{number:03}", "class": "sock", "position": [number / 10, 0, 0]} for number in range(CROWD)]
    episode = folder / "crowded"
    episode.mkdir()
    (episode / "captions.jsonl").write_text("")
    (episode / "episode.json").write_text(
        json.dumps(
            {
                "name": "crowded",
                "users": {"Bob": {}},
                "objects": things,
                "captions": "captions.jsonl",
                "now": "2025-01-20T00:00:00",
            }
        )
    )
    return imported(episode, folder / "crowded.db")


@contextmanager
def serving(command: list) -> Iterator[str]:
    """The URL of a server over HTTP, while it runs."""
    environment = os.environ | {"RUST_LOG": "error"}
    server = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env=environment)
    try:
        said = server.stderr.readline()
        url = re.search(r"http://\S+", said)
        if url is None:
            raise RuntimeError(f"{command[0]} does not say where it serves, but: {said}{server.stderr.read()}")
        yield url.group()
    finally:
        server.terminate()
        server.communicate(timeout=20)
