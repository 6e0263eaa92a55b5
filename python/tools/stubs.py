"""Writes the stubs of the package: python stubs.py FOLDER, where FOLDER contains the package as installed."""
import inspect
import pathlib
import sys


def signature(function):
    parts = []
    star = False
    for p in inspect.signature(function).parameters.values():
        if p.kind is p.KEYWORD_ONLY and not star:
            parts.append("*")
            star = True
        if p.kind is p.VAR_POSITIONAL:
            parts.append(f"*{p.name}: Any")
            star = True
        elif p.kind is p.VAR_KEYWORD:
            parts.append(f"**{p.name}: Any")
        elif p.name in ("self", "cls"):
            parts.append(p.name)
        else:
            parts.append(f"{p.name}: {kind(p)}" + ("" if p.default is p.empty else " = ..."))
    return ", ".join(parts)


def kind(parameter):
    name = parameter.name
    if name in ("name", "node") and parameter.kind is not parameter.KEYWORD_ONLY:
        return "str"
    if name == "nodes":
        return "str | Sequence[str]"
    return "Value"


def docstring(doc, indent):
    lines = inspect.cleandoc(doc).replace("\\", "\\\\").replace('"""', "'''").split("\n")
    pad = " " * indent
    return f'{pad}r"""' + ("\n" + pad).join(lines).rstrip() + ('"""' if len(lines) == 1 else f'\n{pad}"""')


RESULTS = {"run": "Run", "modes": "Modes", "damped_modes": "DampedModes", "sweep": "Sweep", "campbell": "Campbell",
           "judge": "Judgement", "advise": "Advice", "chart": "Chart", "study": "Study",
           "optimise": "Optimum", "vary": "Variants", "build": "System",
           "load": "ModelCase", "import_model": "Model", "accuracy": "dict[str, Figure]", "to_pandas": "Any",
           "to_toml": "str", "set": "ModelCase", "models": "dict[str, str]", "check": "dict[str, Any]",
           "force": "np.ndarray", "acceleration": "np.ndarray"}


def function(name, member, indent):
    member = inspect.unwrap(member)
    pad = " " * indent
    result = RESULTS.get(name) or ("str" if name.startswith("add_") and name != "add_nodes" else "Any")
    text = f"{pad}def {name}({signature(member)}) -> {result}:"
    doc = member.__doc__
    return text + (f"\n{docstring(doc, indent + 4)}\n{pad}    ..." if doc else " ...")


def class_stub(name, cls):
    bases = ", ".join(b.__name__ for b in cls.__bases__ if b is not object and not b.__name__.startswith("_"))
    lines = [f"class {name}({bases}):" if bases else f"class {name}:"]
    if cls.__doc__:
        lines.append(docstring(cls.__doc__, 4))
    for key, kind_ in getattr(cls, "__annotations__", {}).items():
        lines.append(f"    {key}: Any")
    for key, member in vars(cls).items():
        if (key.startswith("_") and key not in ("__init__", "__getitem__", "__len__", "__contains__")) or key in (
                getattr(cls, "__annotations__", {})):
            continue
        if isinstance(member, property) or type(member).__name__ == "cached_property":
            lines.append(f"    @property\n    def {key}(self) -> Any:")
            doc = (member.fget if isinstance(member, property) else member.func).__doc__
            lines.append(docstring(doc, 8) + "\n        ..." if doc else "        ...")
        elif inspect.isfunction(member):
            lines.append(function(key, member, 4))
    return "\n".join(lines if len(lines) > 1 else [lines[0] + " ..."])


def main(folder):
    sys.path.insert(0, str(pathlib.Path(folder).parent))
    import drev

    parts = ['"""Stubs of drev, written by python/tools/stubs.py from the package itself."""',
             "from typing import Any, Sequence\n\nimport numpy as np\n\nValue = Any\n__version__: str\n"]
    for name in sorted(drev.__all__):
        member = getattr(drev, name)
        if inspect.isclass(member):
            parts.append(class_stub(name, member))
        elif callable(member):
            parts.append(function(name, member, 0))
    (pathlib.Path(folder) / "__init__.pyi").write_text("\n\n".join(parts) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1])
