#!/usr/bin/env python3
"""Makes the JSON Schemas of the requests that language-model providers publish, from their official Python SDKs.

    python3 -m venv venv && venv/bin/pip install 'openai==3.57.0' 'anthropic==0.125.0' 'pydantic==2.14.4'
    venv/bin/python make.py

The SDKs describe a request as typed dicts, which are generated from the providers' own OpenAPI documents. Pydantic
turns these into JSON Schema. What is dropped afterwards: titles and documentation, the lists of model names (any
string is allowed beside them), and content that the project never sends, such as pictures and built-in tools. What is
added: a typed dict allows no other keys.
"""

import json
from importlib.metadata import version
from pathlib import Path

from anthropic.types.message_create_params import MessageCreateParamsNonStreaming as Anthropic
from openai.types.chat.completion_create_params import CompletionCreateParamsNonStreaming as OpenAI
from openai.types.embedding_create_params import EmbeddingCreateParams as OpenAIEmbeddings
from pydantic import TypeAdapter

# The members of unions that are kept; a union keeps everything else that is not a reference.
KEPT = {
    "openai": {
        "ChatCompletionAssistantMessageParam",
        "ChatCompletionContentPartTextParam",
        "ChatCompletionContentPartRefusalParam",
        "ChatCompletionDeveloperMessageParam",
        "ChatCompletionFunctionToolParam",
        "ChatCompletionMessageFunctionToolCallParam",
        "ChatCompletionStreamOptionsParam",
        "ChatCompletionSystemMessageParam",
        "ChatCompletionToolMessageParam",
        "ChatCompletionUserMessageParam",
        "FunctionDefinition",
        "JSONSchema",
        "ResponseFormatJSONObject",
        "ResponseFormatJSONSchema",
        "ResponseFormatText",
    },
    "openai-embeddings": set(),
    "anthropic": {
        "CacheControlEphemeralParam",
        "InputSchemaTyped",
        "JSONOutputFormatParam",
        "MessageParam",
        "MetadataParam",
        "OutputConfigParam",
        "TextBlockParam",
        "ThinkingConfigAdaptiveParam",
        "ThinkingConfigDisabledParam",
        "ThinkingConfigEnabledParam",
        "ToolChoiceAnyParam",
        "ToolChoiceAutoParam",
        "ToolChoiceNoneParam",
        "ToolChoiceToolParam",
        "ToolParam",
        "ToolResultBlockParam",
        "ToolUseBlockParam",
    },
}


def target(schema):
    """The name of the definition that a schema refers to, if it is a bare reference."""
    return schema["$ref"].rsplit("/", 1)[1] if isinstance(schema, dict) and set(schema) == {"$ref"} else None


def without_dropped(members, kept):
    members = [member for member in members if target(member) is None or target(member) in kept]
    if {"type": "string"} in members:
        members = [member for member in members if not (member.get("type") == "string" and "enum" in member)]
    return members


def tidy(schema, kept):
    """Drops documentation and what is not kept; closes typed dicts."""
    if isinstance(schema, list):
        return [tidy(item, kept) for item in schema]
    if not isinstance(schema, dict):
        return schema
    tidied = {}
    for key, value in schema.items():
        if key in ("properties", "$defs"):
            tidied[key] = {name: tidy(inner, kept) for name, inner in value.items()}
        elif key in ("title", "description", "deprecated", "discriminator"):
            continue
        else:
            tidied[key] = tidy(value, kept)
    for union in ("anyOf", "oneOf"):
        if union in tidied:
            tidied[union] = without_dropped(tidied[union], kept)
            if len(tidied[union]) == 1:
                tidied.update(tidied.pop(union)[0])
    if "properties" in tidied:
        tidied.setdefault("additionalProperties", False)
        tidied["properties"] = {
            name: inner for name, inner in tidied["properties"].items() if not is_empty(inner, kept)
        }
    return tidied


def is_empty(schema, kept):
    """Whether nothing but null is left that a property could be."""
    name = target(schema)
    if name is not None:
        return name not in kept
    for union in ("anyOf", "oneOf"):
        if union in schema and all(is_empty(member, kept) for member in schema[union]):
            return True
    items = schema.get("items")
    if schema == {"type": "null"}:
        return True
    return isinstance(items, dict) and is_empty(items, kept)


def references(schema):
    if isinstance(schema, list):
        return {name for item in schema for name in references(item)}
    if not isinstance(schema, dict):
        return set()
    found = {name for value in schema.values() for name in references(value)}
    if "$ref" in schema:
        found.add(schema["$ref"].rsplit("/", 1)[1])
    return found


def reachable(schema):
    definitions = schema.pop("$defs", {})
    wanted, queue = set(), list(references(schema))
    while queue:
        name = queue.pop()
        if name not in wanted:
            wanted.add(name)
            queue.extend(references(definitions[name]))
    schema["$defs"] = {name: definitions[name] for name in sorted(wanted)}
    return schema


def make(name, package, typed_dict):
    kept = KEPT[name]
    if name == "openai":
        # Long module paths stand before names that occur twice.
        kept = kept | {name for name in TypeAdapter(typed_dict).json_schema()["$defs"] if name.endswith("__Function")}
    schema = reachable(tidy(TypeAdapter(typed_dict).json_schema(), kept))
    schema = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$comment": f"Made by make.py from the Python package {package} {version(package)}.",
        **schema,
    }
    path = Path(__file__).parent / f"{name}.json"
    path.write_text(json.dumps(schema, indent=1) + "\n", encoding="utf-8")
    print(f"{path.name}: {path.stat().st_size} bytes, {len(schema['$defs'])} definitions")


make("openai", "openai", OpenAI)
make("openai-embeddings", "openai", OpenAIEmbeddings)
make("anthropic", "anthropic", Anthropic)
