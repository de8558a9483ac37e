"""Homes to call upon, and servers of them."""

import json
import os
import re
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from trial.places import SMALL_HOUSE, program

# More than a page of the list of resources holds.
CROWD = 230

A_DAY_IN = "2025-01-14T00:00:00"


def imported(episode: Path, database: Path) -> Path:
    """An episode as a database."""
    command = [program("coin-server"), "import", "--episode", episode, "--db", database]
    subprocess.run(command, check=True, stderr=subprocess.DEVNULL)
    return database


def small_house(folder: Path) -> Path:
    """A family's home, as at the end of a week of captions. Every call makes a new one."""
    return imported(SMALL_HOUSE, folder / f"small-house-{len(list(folder.iterdir()))}.db")


def a_day_in(folder: Path) -> Path:
    """The same home as it was a day into the week, when some things were still worth a question."""
    episode = json.loads((SMALL_HOUSE / "episode.json").read_text()) | {"now": A_DAY_IN}
    del episode["train_until"], episode["truth"]
    seen = [line for line in captions_of(episode) if as_time(json.loads(line)["caption"]) < A_DAY_IN]
    early = folder / f"a-day-in-{len(list(folder.iterdir()))}"
    early.mkdir()
    (early / "episode.json").write_text(json.dumps(episode))
    (early / episode["captions"]).write_text("\n".join(seen))
    shutil.copy(SMALL_HOUSE / episode["embeddings"], early)
    return imported(early, early.with_suffix(".db"))


def captions_of(episode: dict) -> list[str]:
    return (SMALL_HOUSE / episode["captions"]).read_text().splitlines()


def as_time(caption: str) -> str:
    """When a caption was taken, such as 2025-01-13T06:14."""
    return "T".join(caption.split(" ", 2)[:2])


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
