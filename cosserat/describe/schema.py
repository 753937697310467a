"""JSON Schemas of cases, draft 2020-12, from the list of keys: for editors that complete and check TOML files.

Editors follow `anyOf` and `oneOf` but no conditions, and some ignore everything beside a `$ref`.  So each key has its
own text, and shared parts are in an `anyOf` of one.  In a file as it is written, "none" drops an inherited key.  Some
rules are left to the reader: those that join several keys, ranges of texts with units, values inherited by `like`, and
that 3.0 is no whole number.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterable
from typing import Any

from cosserat.describe.keys import LIKE, Key, Value, common_keys, described, keys, title
from cosserat.describe.spellings import accepted, refused
from cosserat.describe.text import need, thesis, type_of
from cosserat.parameters import Count, Items, Quantity
from cosserat.publications import kinds, titles
from cosserat.units import LONGEST_TEXT, what_is_in

Schema = dict[str, Any]
_NONE: Schema = {"type": "string", "const": "none"}
_DRAFT = "https://json-schema.org/draft/2020-12/schema"


def as_written() -> Schema:
    """The schema of a file of cases: tables by name, which may inherit missing keys by `like`."""
    part = {"description": "A part to build on, which is read where it is used.", "type": "object"}
    return {
        "$schema": _DRAFT,
        "title": "Cases of cosserat",
        "type": "object",
        "minProperties": 1,
        "propertyNames": {"pattern": "^(?:_.*|[A-Za-z][A-Za-z0-9_-]*)$"},
        "patternProperties": {"^_": part},
        "additionalProperties": _case_of_any_kind(),
        "$defs": _shared(whole=False),
    }


def merged() -> Schema:
    """The schema of one case with everything inherited by `like`: its `kind` determines its keys."""
    cases = [_case(kind, whole=True) for kind in kinds()]
    return {
        "$schema": _DRAFT,
        "title": "A case of cosserat",
        "oneOf": cases,
        "$defs": _shared(whole=True),
    }


def _shared(*, whole: bool) -> Schema:
    """Texts by their unit, and the problems that are parts of others."""
    every = [key for kind in described() for key in keys(kind)]
    about = [item.about for key in every for item in _scalars(key.value)]
    texts = {
        _word(what_is_in(unit)): {
            "type": "string",
            "maxLength": LONGEST_TEXT,
            "pattern": accepted(unit),
            "not": {"pattern": refused(unit)},
        }
        for unit in sorted({mark.unit for mark in about if isinstance(mark, Quantity)})
    }
    inner = sorted({key.value.problem for key in every} - {""})
    return texts | {_word(kind): _problem(kind, whole=whole) for kind in inner}


def _scalars(value: Value) -> Iterable[Value]:
    return [found for item in value.items for found in _scalars(item)] if value.items else [value]


def _word(text: str) -> str:
    """The name of a shared schema, without blanks, as in an address."""
    return text.removeprefix("a ").removeprefix("an ").replace(" ", "-")


def _case(kind: str, *, whole: bool) -> Schema:
    """A case of one kind; if it is not whole, tables directly inside it may have a `like` too."""
    common = [key for key in common_keys() if not (whole and key.name == "like")]
    nodes = {key.name: _node(key, (), whole=whole) for key in common}
    table = _table(keys(kind), "", "", whole=whole, parts=not whole)
    return {
        "title": kind,
        "description": title(kind),
        **table,
        "properties": nodes | table["properties"],
    }


def _case_of_any_kind() -> Schema:
    """A case whose `kind` may come from `like`: every key of any kind, then their combinations.

    So an editor shows a key of several kinds once, and a fault in its place.
    """
    cases = {kind: _case(kind, whole=False)["properties"] for kind in described()}
    names = dict.fromkeys(name for nodes in cases.values() for name in nodes)
    alike = {name: [node for node in cases.values() if name in node] for name in names}
    properties = {
        name: _any(list({repr(nodes[name]): nodes[name] for nodes in having}.values()))
        for name, having in alike.items()
    }
    together = [
        {"title": kind, "properties": {"kind": {"const": kind}}, "propertyNames": {"enum": list(nodes)}}
        for kind, nodes in cases.items()
    ]
    return {"type": "object", "properties": properties, "additionalProperties": False, "anyOf": together}


def _problem(kind: str, *, whole: bool) -> Schema:
    """A problem of one kind that is a part of another; its `kind` may be left out."""
    table = _table(keys(kind), "", "", whole=whole, like=not whole)
    if whole:
        table["required"].remove("kind")
    return table


def _table(
    found: tuple[Key, ...],
    before: str,
    when: str,
    *,
    whole: bool,
    like: bool = False,
    parts: bool = False,
) -> Schema:
    """The table of the keys whose paths are `before` and a name.

    whole : required keys must be present.  like, parts : the table, or the tables directly inside it, may have a
    `like`.
    """
    own = [key for key in found if key.path == before + key.name and key.when == when]
    nodes = {key.name: _node(key, found, whole=whole, like=parts) for key in own}
    if like:
        nodes[LIKE.name] = _node(LIKE, (), whole=whole)
    needed = {"required": [key.name for key in own if key.required]} if whole else {}
    return {"type": "object", "properties": nodes, "additionalProperties": False, **needed}


def _node(key: Key, found: tuple[Key, ...], *, whole: bool, like: bool = False) -> Schema:
    """The schema of a key, with its text for editors."""
    value, inside = key.value, key.inside
    described = ". ".join(
        filter(None, (f"{type_of(key)}; {need(key)}", " ".join(key.meaning.split()), thesis(key)))
    )
    shown: Schema = {"description": described[0].upper() + described[1:]}
    if key.default is not None:
        shown["default"] = tomllib.loads(f"value = {key.default}")["value"]
    if isinstance(value.innermost.about, Quantity) and value.form == "quantity":
        shown["examples"] = [_example(value.innermost.about)]
    if value.form == "table" and not value.problem:
        choices = dict.fromkeys(k.when for k in found if k.path == inside + k.name)
        tables = [_table(found, inside, when, whole=whole, like=like) for when in choices]
        form = _any([*tables, *map(_form, value.items)])
    elif value.form == "list" and value.items[0].tables:  # an inherited list is replaced as a whole
        form = {
            "type": "array",
            "items": _table(found, inside, key.when, whole=True) | _extra(value),
            **_lengths(value),
        }
    else:
        form = _form(value)
    droppable = not (whole or key.required or key.path in ("kind", LIKE.name) or "none" in value.words)
    return shown | (_or_none(form) if droppable else form)


def _extra(value: Value) -> Schema:
    """Leave for other keys in the tables of a list, if their class has it."""
    allowed = any(table.model_config.get("extra") == "allow" for table in value.items[0].tables)
    return {"additionalProperties": True} if allowed else {}


def _or_none(form: Schema) -> Schema:
    """The same, or "none"; a fault inside a table remains at its place there."""
    if form.get("type") == "object":
        return {**form, "type": ["object", "string"], "pattern": "^none$"}
    return {"anyOf": [*(form["anyOf"] if list(form) == ["anyOf"] else [form]), _NONE]}


def _any(forms: list[Schema]) -> Schema:
    flat = [inner for form in forms for inner in (form["anyOf"] if set(form) == {"anyOf"} else [form])]
    return flat[0] if len(flat) == 1 else {"anyOf": flat}


def _example(about: Quantity) -> str | float:
    return 0.3 if about.unit == "1" else f"2.5 {about.unit}"


def _form(value: Value) -> Schema:
    """The schema of a value, without its text for editors."""
    about = value.about
    if isinstance(about, Quantity):
        text = {"$ref": f"#/$defs/{_word(what_is_in(about.unit))}"}
        return {"anyOf": [{"type": "number", **_limits(about)}, text] if about.unit == "1" else [text]}
    if isinstance(about, Count):
        return {"type": "integer", "minimum": about.at_least, "maximum": about.at_most}
    if value.problem:
        return {"anyOf": [{"$ref": f"#/$defs/{_word(value.problem)}"}]}
    forms: dict[str, Schema] = {
        "word": {"enum": list(value.words)},
        "name": {
            "anyOf": [
                {"enum": list(titles())},
                {"type": "string"},
                {"type": "array", "items": {"type": "string"}},
            ]
        },
        "text": {"type": "string"},
        "names": {
            "type": "object",
            "additionalProperties": _form(value.items[0]) if value.items else {},
        },
        "keys": {"type": "object"},
        "number": {"type": "number"},
        "truth": {"type": "boolean"},
        "list": {
            "type": "array",
            "items": _form(value.items[0]) if value.items else {},
            **_lengths(value),
        },
        "either": {"anyOf": [_form(item) for item in value.items]},
        "row": {
            "type": "array",
            "prefixItems": [_form(item) for item in value.items],
            "minItems": len(value.items),
            "maxItems": len(value.items),
        },
    }
    return forms[value.form]


def _lengths(value: Value) -> Schema:
    """How many items a list has."""
    if not isinstance(value.about, Items):
        return {}
    return {"minItems": value.about.at_least, "maxItems": value.about.at_most}


def _limits(about: Quantity) -> Schema:
    lower = "exclusiveMinimum" if about.least == about.above else "minimum"
    upper = "exclusiveMaximum" if about.most == about.below else "maximum"
    return {lower: about.least, upper: about.most}
