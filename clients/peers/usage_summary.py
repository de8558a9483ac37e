"""`get_usage_summary` in Python, on the same file as coin-server: one open connection, prepared statements."""

import sqlite3
from datetime import UTC, datetime

from typing_extensions import TypedDict

SESSION_GAP_SECONDS = 1200
SECONDS_A_DAY = 86_400
ACTIONS = ("use", "take", "place", "transport", "clean", "search", "give", "other")

EVENTS = """
    SELECT at, name, action, caption FROM usage_events LEFT JOIN users ON user_key = actor
    WHERE object_key = ? AND at BETWEEN ? AND ? ORDER BY at, caption
"""


class Thing(TypedDict):
    id: str
    name: str


class User(TypedDict):
    user_id: str
    total_events: int
    sessions: int
    actions: dict[str, int]
    last_used_days_ago: float
    example_events: list[str]


class UsageSummary(TypedDict):
    """The result, from which both SDKs make the tool's output schema."""

    object: Thing
    as_of: str
    window_days: int
    user_summary: list[User]
    unattributed_events: int


class Home:
    """A home's database, open for reading as coin-server opens it. Statements stay prepared in the connection."""

    def __init__(self, database: str):
        self.connection = sqlite3.connect(database, isolation_level=None)
        self.connection.executescript("PRAGMA query_only = ON; PRAGMA cache_size = -4000;")

    def usage_summary(self, object_id: str, window_days: int, as_of: str | None, max_examples: int) -> UsageSummary:
        query = self.connection.execute
        query("BEGIN")
        try:
            thing = query("SELECT object_key, class FROM objects WHERE id = ?", (object_id,)).fetchone()
            if thing is None:
                raise ValueError(f"object_id: there is no object {object_id!r}")
            key, label = thing
            last = seconds(as_of) if as_of else query("SELECT clock FROM home").fetchone()[0]
            events = query(EVENTS, (key, last - window_days * SECONDS_A_DAY, last)).fetchall()
        finally:
            query("COMMIT")
        users, unattributed = summarised(events, last, max_examples)
        return {
            "object": {"id": object_id, "name": " ".join(word[:1].upper() + word[1:] for word in label.split(" "))},
            "as_of": datetime.fromtimestamp(last, UTC).strftime("%Y-%m-%dT%H:%M:%S"),
            "window_days": window_days,
            "user_summary": users,
            "unattributed_events": unattributed,
        }


def seconds(local_time: str) -> int:
    return int(datetime.fromisoformat(local_time).replace(tzinfo=UTC).timestamp())


def summarised(events: list[tuple], now: int, max_examples: int) -> tuple[list[User], int]:
    """What each user did, most events first, and how many events are nobody's."""
    users, unattributed, before = {}, 0, (None, 0)
    for at, name, action, caption in events:
        if name is None:
            unattributed += 1
            continue
        user = users.get(name)
        if user is None:
            user = users[name] = {"total": 0, "sessions": 0, "actions": {}, "last": at, "captions": []}
        user["total"] += 1
        if before[0] != name or at - before[1] > SESSION_GAP_SECONDS:
            user["sessions"] += 1
        word = ACTIONS[action]
        user["actions"][word] = user["actions"].get(word, 0) + 1
        user["last"] = at
        user["captions"].append(caption)
        before = (name, at)
    ordered = sorted(users.items(), key=lambda item: (-item[1]["total"], item[0]))
    return [
        {
            "user_id": name,
            "total_events": user["total"],
            "sessions": user["sessions"],
            "actions": user["actions"],
            "last_used_days_ago": (now - user["last"] + 4320) // 8640 / 10,
            "example_events": user["captions"][-max_examples:] if max_examples else [],
        }
        for name, user in ordered
    ], unattributed
