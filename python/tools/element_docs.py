"""The comments in headers of elements, for docstrings: python element_docs.py FOLDER_OR_HEADER... element_docs.json

For each header the comment above its class (equation, sign, limits, source), and for each field of its Params and of
the structs next to it the comment with unit and range.
"""
import json
import pathlib
import re
import sys


def block_above_includes(text):
    lines = []
    for line in text.splitlines()[1:]:
        if not line.startswith("///"):
            break
        lines.append(line[4:] if line.startswith("/// ") else line[3:])
    return "\n".join(lines).strip()


def fields(text):
    found = {}
    above = []
    for line in text.splitlines():
        stripped = line.strip()
        if stripped.startswith("///") and not stripped.startswith("///<"):
            above.append(stripped[3:].strip())
            continue
        match = re.match(r"[\w:<>, ]+? &?(\w+)(?: = [^;]*)?;\s*(?:///< ?(.*))?$", stripped)
        if match:
            comment = match.group(2) or " ".join(above)
            if comment:
                found.setdefault(match.group(1), comment)
        above = []
    return found


def main(*paths):
    *sources, target = map(pathlib.Path, paths)
    docs = {}
    for header in [h for s in sources for h in (sorted(s.rglob("*.hpp")) if s.is_dir() else [s])]:
        text = header.read_text(encoding="utf-8")
        docs[header.stem] = {"text": block_above_includes(text), "fields": fields(text)}
    pathlib.Path(target).write_text(json.dumps(docs, indent=0, sort_keys=True), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
