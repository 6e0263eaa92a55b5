"""The catalogue of elements as methods of drev.Model: keywords and docstrings come from drev's own tables and headers."""
import inspect
import json
import os

from . import _drev

_DOCS = os.path.join(os.path.dirname(__file__), "element_docs.json")
_PYTHON = ("python_law", "python_load")  # add_law and add_load


def types():
    """Every type of element with its keys, as `drev list --elements --json` gives them."""
    return [t for t in json.loads(_drev.elements_as_json())["elements"] if t["type"] not in _PYTHON]


def _docs():
    try:
        with open(_DOCS, encoding="utf-8") as file:
            return json.load(file)
    except FileNotFoundError:
        return {}


def _keys_text(keys, fields):
    lines = []
    for key in keys:
        about = fields.get(key["name"], "")
        if key["needed"]:
            about = f"needed; {about}" if about else "needed"
        elif key["default"] not in (None, ""):
            about += ("; " if about else "") + f"default {key['default']}"
        name = key["key"]
        if key["translational_key"] != name:
            name += f" ({key['translational_key']} on translational nodes)"
        lines.append(f"  {name}: {about}".rstrip(": "))
    return lines


def _method(element, docs):
    kind, keys = element["type"], element["keys"]
    least, most = element["least_nodes"], element["most_nodes"]

    def add(self, name, nodes=(), **values):
        return self._add_element(kind, name, nodes, values)

    place = inspect.Parameter.KEYWORD_ONLY
    nodes = inspect.Parameter("nodes", inspect.Parameter.POSITIONAL_OR_KEYWORD)
    parameters = [inspect.Parameter(p, inspect.Parameter.POSITIONAL_OR_KEYWORD) for p in ("self", "name")]
    parameters += [nodes] if least > 0 else [nodes.replace(default=())]
    for key in sorted(keys, key=lambda k: not k["needed"]):
        # Required keys have a default, too: they may be given in another unit, and a missing one is a finding.
        parameters.append(inspect.Parameter(key["key"], place, default=None))
    parameters.append(inspect.Parameter("other_units", inspect.Parameter.VAR_KEYWORD))
    add.__name__ = add.__qualname__ = f"add_{kind}"
    add.__signature__ = inspect.Signature(parameters)
    about = docs.get(kind, {})
    count = {(0, 0): "no nodes", (1, 1): "one node", (2, 2): "two nodes"}.get(
        (least, most), f"{least} to {most} nodes" if most < 1000 else f"{least} or more nodes"
    )
    add.__doc__ = "\n".join(
        [about.get("text", kind), "", f"nodes: {count}.", "Keys in SI; other units by the end of the key (docs/model_file.md):"]
        + _keys_text(keys, about.get("fields", {}))
    )
    return add


def add_methods(model):
    """Gives the class a method add_TYPE for each type of element."""
    docs = _docs()
    for element in types():
        setattr(model, f"add_{element['type']}", _method(element, docs))
