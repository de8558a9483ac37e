"""What is tried: every tool, every resource, every prompt. A step fails with an AssertionError or a Refused."""

import json

import jsonschema

from trial.client import Client, Refused, Reply

PEOPLE = ["Bob", "Mary", "Tom"]
THINGS = 34


class Trial:
    """A client that is connected to a home of its own, and what is known of the server's tools."""

    def __init__(self, client: Client, tools: list[dict]):
        self.client = client
        self.output_schemas = {tool["name"]: tool["outputSchema"] for tool in tools}

    async def call(self, tool: str, **arguments) -> Reply:
        """A call. What comes back satisfies the schema, and its text says the same."""
        reply = await self.client.call(tool, arguments)
        if not reply.is_error:
            jsonschema.validate(reply.structured, self.output_schemas[tool], jsonschema.Draft202012Validator)
            assert json.loads(reply.text) == reply.structured, "text and structured content differ"
        return reply

    async def done(self, tool: str, **arguments) -> dict:
        """What a call that must succeed returns."""
        reply = await self.call(tool, **arguments)
        assert not reply.is_error, f"{tool} {arguments} is refused: {reply.text}"
        return reply.structured

    async def refused(self, tool: str, *words: str, **arguments) -> None:
        """A call that must fail, in these words among others."""
        reply = await self.call(tool, **arguments)
        assert reply.is_error, f"{tool} {arguments} is not refused: {reply.text}"
        for word in words:
            assert word in reply.text, f"{tool} {arguments} is refused without a word about {word}: {reply.text}"

    async def in_question(self) -> str:
        """The thing that is most worth a question."""
        question = await self.done("next_question")
        assert not question["done"] and question["question"].endswith("?"), question
        return question["object"]["id"]


async def list_users(trial: Trial) -> None:
    users = (await trial.done("list_users"))["users"]
    assert [user["name"] for user in users] == PEOPLE, users


async def list_objects(trial: Trial) -> None:
    ids, cursor = [], {}
    while cursor is not None:
        page = await trial.done("list_objects", limit=10, **cursor)
        ids += [thing["id"] for thing in page["objects"]]
        cursor = {"cursor": page["next_cursor"]} if "next_cursor" in page else None
    assert len(set(ids)) == len(ids) == page["total"] == THINGS, ids
    await trial.refused("list_objects", "cursor", cursor="nowhere")


async def get_usage_summary(trial: Trial) -> None:
    summary = await trial.done("get_usage_summary", object_id="3", window_days=30, max_examples=2)
    assert summary["user_summary"] and summary["window_days"] == 30, summary
    await trial.refused("get_usage_summary", "window_days", object_id="3", window_days=0)


async def nearby_objects(trial: Trial) -> None:
    assert len((await trial.done("nearby_objects", object_id="3", k=3, min_weight=0))["nearby_objects"]) == 3


async def similar_objects(trial: Trial) -> None:
    assert len((await trial.done("similar_objects", object_id="3", k=3))["similar_objects"]) == 3


async def whose_is(trial: Trial) -> None:
    judgement = await trial.done("whose_is", object_id="3")
    assert set(judgement["owners"]) <= set(PEOPLE) and judgement["explanation"], judgement
    await trial.refused("whose_is", "object_id", "nothing", object_id="nothing")


async def find_object(trial: Trial) -> None:
    found = await trial.done("find_object", query="Bob's calculator", speaker="Mary")
    assert found["decision"] == "found" and found["object"]["id"] == "1", found
    await trial.refused("find_object", "speaker", "Bob", query="my cup", speaker="Bobby")


async def next_question(trial: Trial) -> None:
    assert await trial.in_question() == await trial.in_question(), "asking changes nothing"


async def ask_owner(trial: Trial) -> None:
    """A person accepts, declines and cancels, or is asked in the chat where the client shows no forms."""
    if trial.client.person is None:
        await asked_in_chat(trial)
    else:
        await asked_by_form(trial)


async def asked_by_form(trial: Trial) -> None:
    person, accepted = trial.client.person, await trial.in_question()
    answer = await trial.done("ask_owner")
    assert answer["status"] == "answered" and answer["object"]["id"] == accepted, answer
    assert [form["message"] for form in person.forms] == [answer["question"]], person.forms
    judgement = await trial.done("whose_is", object_id=accepted)
    assert judgement["settled"] and judgement["source"] == "answer", judgement

    person.action, declined = "decline", await trial.in_question()
    for _ in range(2):
        assert (await trial.done("ask_owner", object_id=declined))["status"] == "declined"
    assert len(person.forms) == 2, "a declined question is put again"

    person.action, cancelled = "cancel", await trial.in_question()
    assert cancelled != declined
    for forms in (3, 4):
        assert (await trial.done("ask_owner", object_id=cancelled))["status"] == "cancelled"
        assert len(person.forms) == forms, "a cancelled question is not put again"
    person.action = "accept"


async def asked_in_chat(trial: Trial) -> None:
    question = await trial.done("next_question")
    thing = question["object"]["id"]
    await trial.refused("ask_owner", question["question"], "owner", thing, object_id=thing)
    answer = await trial.done("ask_owner", object_id=thing, owner="It belongs to Mary.")
    assert answer["status"] == "answered" and answer["owners"] == ["Mary"], answer


async def record_scores(trial: Trial) -> None:
    scores = {"Bob": 1.0, "Mary": 0.0, "Tom": 0.0}
    result = await trial.done("record_scores", object_id=await trial.in_question(), scores=scores, model="trial")
    assert result["owners"] == ["Bob"], result


async def record_answer(trial: Trial) -> None:
    answer = {"question": "Whose is it?", "answer": "Tom's", "ownership": {"Tom": True}}
    result = await trial.done("record_answer", object_id="8", answered_by="Tom", **answer)
    assert result["status"] == "answered" and result["owners"] == ["Tom"], result
    await trial.refused("record_answer", "Ann", object_id="8", **(answer | {"ownership": {"Ann": True}}))


async def retract_answer(trial: Trial) -> None:
    await trial.done("retract_answer", object_id="8")
    assert (await trial.done("whose_is", object_id="8"))["source"] == "inferred"


async def record_usage(trial: Trial) -> None:
    line = "2025-01-19 19:00 Bob takes the Marker"
    captions = [{"object_id": "3", "caption": line}, {"object_id": "nothing", "caption": line}]
    result = await trial.done("record_usage", captions=captions)
    assert result["recorded"] == 1 and [one["index"] for one in result["rejected"]] == [1], result
    assert (await trial.done("record_usage", captions=captions[:1]))["duplicates"] == 1


async def observe_objects(trial: Trial) -> None:
    there = (await trial.done("list_objects"))["objects"][0]
    seen = {"class": there["name"], "position": there["position"], "radius": 0.1, "seen_at": "2025-01-19T19:00:00"}
    result = await trial.done("observe_objects", observations=[seen, seen | {"radius": -1.0}])
    assert [(one["object_id"], one["new"]) for one in result["results"]] == [(there["id"], False)], result
    assert [one["index"] for one in result["rejected"]] == [1], result


async def add_user(trial: Trial) -> None:
    users = (await trial.done("add_user", name="Ann", role="grandmother"))["users"]
    assert {user["name"] for user in users} == {*PEOPLE, "Ann"}, users


async def protocol_errors(trial: Trial) -> None:
    """What no program would do by design is an error of the protocol, or a refusal."""
    for request in (
        lambda: trial.client.call("no_such_tool", {}),
        lambda: trial.client.read("coin://objects/nothing"),
        lambda: trial.client.prompt("infer_ownership", {"object_id": "nothing"}),
    ):
        try:
            answer = await request()
        except Refused:
            continue
        assert isinstance(answer, Reply) and answer.is_error, answer


async def resources(trial: Trial) -> None:
    listed = [resource["uri"] for resource in await trial.client.resources()]
    assert len(listed) == THINGS + 2 and listed[:2] == ["coin://household", "coin://objects"], listed
    templates = [template["uriTemplate"] for template in await trial.client.templates()]
    objects = "coin://objects/{object_id}"
    assert sorted(templates) == [objects, objects + "/history"], templates
    histories = [template.replace("{object_id}", "3") for template in templates]
    for uri in [*listed[:3], *histories]:
        assert json.loads(await trial.client.read(uri)), uri


async def prompts(trial: Trial) -> None:
    values = {"object_id": "3", "question": "Whose is it?", "answer": "Mine", "answered_by": "Bob"}
    listed = {prompt["name"]: prompt for prompt in await trial.client.prompts()}
    assert listed.keys() == {"infer_ownership", "ask_question", "read_answer", "settle_household"}, listed
    for name, prompt in listed.items():
        wanted = [argument["name"] for argument in prompt.get("arguments", [])]
        assert await trial.client.prompt(name, {argument: values[argument] for argument in wanted}), name


async def completion(trial: Trial) -> None:
    read = {"type": "ref/prompt", "name": "read_answer"}
    assert await trial.client.complete(read, "answered_by", "b") == ["Bob"]
    thing = {"type": "ref/resource", "uri": "coin://objects/{object_id}"}
    assert "3" in await trial.client.complete(thing, "object_id", "3")


# In this order: what looks comes before what changes the home.
TOOLS = {
    step.__name__: step
    for step in (
        list_users,
        list_objects,
        get_usage_summary,
        nearby_objects,
        similar_objects,
        whose_is,
        find_object,
        next_question,
        ask_owner,
        record_scores,
        record_answer,
        retract_answer,
        record_usage,
        observe_objects,
        add_user,
    )
}

FURTHER = {
    "resources": resources,
    "prompts": prompts,
    "completion": completion,
    "protocol errors": protocol_errors,
}
