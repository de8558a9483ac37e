"""Writes docs/conversation.md by holding the conversation: FastMCP's client speaks with coin-server over stdio."""

import argparse
import asyncio
import difflib
import json
import sys
import tempfile
from pathlib import Path

from trial import homes
from trial.client import Client, Era, Stdio
from trial.fastmcp import connect
from trial.places import REPOSITORY

DOCUMENT = REPOSITORY / "docs/conversation.md"

LINE = 110
DECIMALS = 2

INTRODUCTION = f"""\
# A conversation

Bob speaks with an assistant that has `coin-server` plugged in, in the home of `fixtures/episodes/small-house` as it was
after two days. Requests, results and the form are real: `clients/run conversation` holds this conversation through
FastMCP's client, over standard input and output in revision {Era.MODERN.version} of the protocol, and writes it down;
`--check` holds it again and compares. Results are shortened by rule: numbers to {DECIMALS} decimals, no positions,
nothing that is empty. A language model would find its own words. Here the assistant is a script, which says what the
tools gave it to say.
"""


def shortened(value):
    """A result without what a reader does not need."""
    match value:
        case float():
            return round(value, DECIMALS)
        case list():
            return [shortened(item) for item in value]
        case dict():
            kept = {key: shortened(item) for key, item in value.items() if key != "position"}
            return {key: item for key, item in kept.items() if item not in ([], {})}
        case _:
            return value


def laid_out(value, indent: str = "") -> str:
    """JSON that takes a line where it fits into one."""
    line = json.dumps(value, ensure_ascii=False)
    if not isinstance(value, dict | list) or len(indent + line) <= LINE or not value:
        return line
    inner = indent + "  "
    if isinstance(value, dict):
        opening, closing = "{}"
        parts = [f"{json.dumps(key)}: {laid_out(item, inner)}" for key, item in value.items()]
    else:
        opening, closing = "[]"
        parts = [laid_out(item, inner) for item in value]
    return f"{opening}\n{inner}" + f",\n{inner}".join(parts) + f"\n{indent}{closing}"


class Transcript:
    """What is said and done, as Markdown."""

    def __init__(self):
        self.parts = [INTRODUCTION]

    def heading(self, text: str) -> None:
        self.parts.append(f"## {text}\n")

    def says(self, who: str, text: str) -> None:
        self.parts.append(f"**{who}:** {text}\n")

    def block(self, head: str, text: str) -> None:
        self.parts.append(f"{head}\n\n```json\n{text}\n```\n")

    async def calls(self, client: Client, tool: str, **arguments) -> dict:
        """Has the assistant call a tool. A form that is shown meanwhile comes before the result."""
        self.block(f"*The assistant calls `{tool}`:*", laid_out(arguments))
        reply = await client.call(tool, arguments)
        assert not reply.is_error, reply.text
        for form in client.person.forms:
            self.form(form, client.person.content)
        client.person.forms.clear()
        self.block("*The result:*", laid_out(shortened(reply.structured)))
        return reply.structured

    def form(self, form: dict, content: dict[str, str]) -> None:
        """A form as a person sees it, filled in."""
        fields = [f"**{form['message']}**"]
        for name, field in form["schema"]["properties"].items():
            filled_in = content[name]
            choices = [f"**[{choice}]**" if choice == filled_in else choice for choice in field.get("enum", [])]
            fields.append(f"{field['title']} {' · '.join(choices) or f'“{filled_in}”'}")
        shown = "\n>\n".join(f"> {field}" for field in fields)
        self.parts.append(f"*A form opens before Bob, and he fills it in:*\n\n{shown}\n")


async def held(database: Path) -> str:
    """Holds the conversation."""
    transcript = Transcript()
    async with connect(Stdio(database), Era.MODERN) as client:
        transcript.heading("The assistant looks, is unsure and asks")
        transcript.says("Bob", "Whose is the frying pan?")
        found = await transcript.calls(client, "list_objects", **{"class": "frying pan"})
        thing = found["objects"][0]["id"]
        judgement = await transcript.calls(client, "whose_is", object_id=thing)
        assert not judgement["settled"], "the assistant must have a reason to ask"
        transcript.says("Assistant", f"{judgement['explanation']} That is not sure enough to go by, so I had better ask.")
        client.person.content = {"owner": "Mary and Tom", "in_your_words": "They share it. I only borrowed it."}
        answer = await transcript.calls(client, "ask_owner", object_id=thing)
        assert answer["status"] == "answered", answer
        transcript.says("Assistant", "Thank you. I will remember that.")
    async with connect(Stdio(database), Era.MODERN) as client:
        transcript.heading("Another day, in another conversation")
        transcript.says("Tom", "May I lend the frying pan to a friend?")
        await transcript.calls(client, "list_objects", **{"class": "frying pan"})
        judgement = await transcript.calls(client, "whose_is", object_id=thing)
        assert judgement["settled"] and judgement["source"] == "answer", judgement
        transcript.says("Assistant", f"It is yours and Mary's. {judgement['explanation']}")
    return "\n".join(transcript.parts)


def main() -> int:
    arguments = argparse.ArgumentParser(prog="clients/run conversation", description=__doc__)
    arguments.add_argument("--check", action="store_true", help="compare with the file instead of writing it")
    given = arguments.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        text = asyncio.run(held(homes.a_day_in(Path(folder))))
    if not given.check:
        DOCUMENT.write_text(text)
        return 0
    if (written := DOCUMENT.read_text()) == text:
        print(f"{DOCUMENT.relative_to(REPOSITORY)} tells what happens")
        return 0
    print(*difflib.unified_diff(written.splitlines(), text.splitlines(), "written", "held now", lineterm=""), sep="\n")
    print(f"\n{DOCUMENT.relative_to(REPOSITORY)} tells something else; `clients/run conversation` writes it anew")
    return 1


if __name__ == "__main__":
    sys.exit(main())
