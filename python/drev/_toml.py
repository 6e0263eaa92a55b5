"""Conversion of Python values to those of a model file (TOML)."""
import math
import numbers

import numpy as np


def key(name):
    plain = name != "" and all(c.isascii() and (c.isalnum() or c in "_-") for c in name)
    return name if plain else text(name)


def text(value):
    quoted = value.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + "".join(c if c >= " " and c != "\x7f" else f"\\u{ord(c):04x}" for c in quoted) + '"'


def number(value):
    if math.isnan(value):
        return "nan"
    return repr(value) if math.isfinite(value) else ("inf" if value > 0 else "-inf")


class Written(str):
    """TOML text of a value: what is changed later in the value does not change it."""


def written(given, where):
    return Written(value(given, where))


def value(given, where=""):
    """The value as TOML text. Raises TypeError for a value that a model file cannot hold."""
    if isinstance(given, Written):
        return str(given)
    if isinstance(given, (bool, np.bool_)):
        return "true" if given else "false"
    if isinstance(given, str):
        return text(given)
    if isinstance(given, numbers.Integral):
        return str(int(given))
    if isinstance(given, numbers.Real):
        return number(float(given))
    if isinstance(given, dict):
        inside = ", ".join(f"{key(str(k))} = {value(v, f'{where}.{k}')}" for k, v in given.items())
        return "{ " + inside + " }"
    if np.ma.is_masked(given):
        raise TypeError(f"{where or 'value'}: entries are masked; a model has a number in each place")
    if isinstance(given, np.ndarray) and given.ndim == 1 and given.dtype.kind == "f":
        return "[" + ", ".join(map(number, given.tolist())) + "]"
    if hasattr(given, "tolist"):  # other arrays, and series of pandas
        given = given.tolist()
        if not isinstance(given, list):
            return value(given, where)
    if isinstance(given, (list, tuple, range)):
        return "[" + ", ".join(value(v, where) for v in given) + "]"
    raise TypeError(f"{where or 'value'}: {type(given).__name__} is no number, text, list, dict or array")
