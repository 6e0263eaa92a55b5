"""The commands of drev as functions: keywords, defaults and docstrings come from the command's own table."""
import difflib
import inspect
import numbers
import os

from . import _drev, _errors

_SUFFIX = {"SECONDS": "_s", "RPM": "_rpm"}
_NAMES = {"--for": "figure", "--only": "only"}
#: Options that are functions of their own, or part of the name of a model.
_LEFT_OUT = {"--plugin", "--vary", "--jobs", "--damped", "--table", "--sample", "--correlate", "--resume"}


class Option:
    """One keyword of a function, and the option of the command that it represents."""

    def __init__(self, row):
        self.flag, self.type, self.meaning, self.values, self.choices = row
        self.keyword = _NAMES.get(self.flag) or self.flag[2:].replace("-", "_") + _SUFFIX.get(self.type, "")
        self.meaning = _errors._in_python(self.meaning)

    def texts(self, value):
        """The texts on the command line; None: there are none."""
        if self.values == "flag":
            if not isinstance(value, (bool, type(None))):
                raise TypeError(f"{self.keyword} must be True or False, not {value!r}")
            return [] if value else None
        if self.values == "several":
            if not hasattr(value, "__iter__"):
                raise TypeError(f"{self.keyword} must be a text or a sequence of texts, not {value!r}")
            return [value] if isinstance(value, str) else [_text(self.keyword, v) for v in value]
        if not isinstance(value, (str, bytes)) and hasattr(value, "__iter__"):
            return [",".join(_text(self.keyword, v) for v in value)]
        return [_text(self.keyword, value)]


def _text(keyword, value):
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    if isinstance(value, numbers.Integral) and not isinstance(value, bool):
        return str(int(value))
    if isinstance(value, numbers.Real) and not isinstance(value, bool):
        return repr(float(value))
    raise TypeError(f"{keyword} must be a number or a text, not {value!r}")


def _table():
    table = {}
    for name, summary, rows in _drev.command_table():
        for row in rows:
            option = Option(row)
            _errors.keyword_of.setdefault(option.flag, option.keyword)
        table[name] = summary, rows
    return {
        name: (summary, {o.keyword: o for o in map(Option, rows) if o.flag.startswith("--") and o.flag not in _LEFT_OUT})
        for name, (summary, rows) in table.items()
    }


#: name -> (summary, {keyword: Option})
TABLE = _table()


def options(command, keywords, function=None):
    """The command's options from the keywords of a function. Raises TypeError for an unknown keyword."""
    known = TABLE[command][1]
    found = {}
    for keyword, value in keywords.items():
        if keyword not in known:
            near = difflib.get_close_matches(keyword, known, 1, 0.5)
            raise TypeError(
                f"{function or command}() has no argument {keyword!r}"
                + (f"; did you mean {near[0]!r}?" if near else f"; there are {', '.join(known)}")
            )
        if value is not None:
            texts = known[keyword].texts(value)
            if texts is not None:
                found[known[keyword].flag] = texts
    return found


def documented(command, text, *more):
    """A decorator: the function's signature and docstring get the command's options. more: (keyword, meaning)."""

    def decorate(function):
        given = list(inspect.signature(function).parameters.values())
        plain = [p for p in given if p.kind is not p.VAR_KEYWORD]
        known = TABLE[command][1]
        names = [p.name for p in plain]
        keywords = [
            inspect.Parameter(k, inspect.Parameter.KEYWORD_ONLY, default=None) for k in known if k not in names
        ]
        function.__signature__ = inspect.Signature(plain + keywords)
        lines = [text, "", "Arguments (all may be left out unless they say otherwise):"]
        lines += [f"  {k}: {option.meaning}" for k, option in known.items()]
        lines += [f"  {k}: {meaning}" for k, meaning in more]
        function.__doc__ = "\n".join(lines)
        return function

    return decorate
