"""Models made in Python. Names, keys and units are those of model files (docs/model_file.md)."""
import difflib
import inspect
import warnings

from . import _drev, _elements, _errors, _toml
from ._case import ModelCase

_slow_was_said = False

_TOP = ("summary", "note")


class Model(ModelCase):
    """A model made in Python, node by node and element by element, with all methods of a ModelCase.

        m = drev.Model("two masses")
        m.add_node("motor")
        m.add_node("load")
        m.add_inertia("J_motor", "motor", inertia_kg_m2=0.012)
        m.add_inertia("J_load", "load", inertia_kg_m2=0.035)
        m.add_shaft_spring("shaft", ["motor", "load"], stiffness_Nm_per_rad=8500, damping_Nms_per_rad=0.5)
        print(m.modes())

    Values are numbers, arrays, texts (expressions of parameters), and dicts for tables. The model is checked when it is
    built, which every method that computes does: all faults are then raised together as ModelError.
    """

    def __init__(self, name, summary="", note=""):
        super().__init__(name)
        self._head = {"format": 1, "name": name}
        for key, given in (("summary", summary), ("note", note)):
            if given:
                self._head[key] = given
        self._include = []
        self._sections = {"parameters": {}, "lists": {}, "tables": {}, "nodes": {}, "elements": {}, "run": {}, "class": {}}
        self._faults = []
        self._callables = []
        self._whole_text = None
        self._model = name.replace("/", "_") or "model"

    @classmethod
    def _of_text(cls, name, text):
        model = cls(name)
        model._whole_text = text
        return model

    def __copy__(self):
        """What is added to a copy later is not added to this model, too."""
        model = type(self).__new__(type(self))
        model.__dict__.update(self.__dict__)
        model._sections = {
            section: {name: dict(keys) if isinstance(keys, dict) else keys for name, keys in entries.items()}
            for section, entries in self._sections.items()
        }
        model._include, model._faults, model._callables = list(self._include), list(self._faults), list(self._callables)
        return model

    # Building.
    def _enter(self, section, name, values):
        if self._whole_text is not None:
            raise TypeError(f"{self.name} was read as a whole; nothing can be added to it")
        entries = self._sections[section]
        if name in entries:
            what = {"nodes": "node", "elements": "element"}.get(section, section.rstrip("s"))
            self._faults.append(_errors.Finding(self.name, what, name, "", "is there already"))
            return name
        entries[name] = _written(name, values)
        return name

    def _change(self, section, name, values):
        entries = self._sections[section]
        if section == "nodes" and name not in entries and not self._include:  # an included file may have it
            near = difflib.get_close_matches(name, entries, 1)
            self._faults.append(
                _errors.Finding(
                    self.name, "node", name, "", "is no node of this model" + (f"; did you mean '{near[0]}'?" if near else "")
                )
            )
            return
        entries.setdefault(name, {}).update(_written(name, values))

    def add_node(self, name, kind=None, **keys):
        """Adds a node; `kind`: "rotational" (default) or "translational". Returns its name.

        Other keys: hold, constant_speed_rpm, nominal_speed_rpm, nominal_angle_deg, run_up, given_motion,
        initial_angle_deg, initial_speed_rad_per_s, when (docs/model_file.md#nodes).
        """
        return self._enter("nodes", name, {"kind": kind, **keys})

    def add_nodes(self, *names):
        """Adds several nodes, and returns their names."""
        return [self.add_node(name) for name in names]

    def hold(self, node):
        """The node follows its nominal motion exactly; without nominal motion it is at rest."""
        self._change("nodes", node, {"hold": True})

    def constant_speed(self, node, **speed):
        """The node turns at this speed: rpm=750, rad_per_s=78.5 or deg_per_s=... It becomes the reference shaft."""
        self._change("nodes", node, {f"constant_speed_{unit}": v for unit, v in speed.items()})

    def set_reference(self, node, **nominal):
        """Nominal motion of the reference shaft, through this node, which stays free: speed_rpm=..., angle_deg=..."""
        self._change("nodes", node, {f"nominal_{key}": v for key, v in nominal.items()})

    def run_up(self, node, **keys):
        """The same with constant acceleration: speed_0_rpm, speed_1_rpm, time_0_s, time_1_s."""
        self._change("nodes", node, {"run_up": keys})

    def given_motion(self, node, **keys):
        """The node's deviation is offset + amplitude cos(2 pi f t + phase): amplitude_deg, frequency_Hz, phase_deg,
        offset_deg."""
        self._change("nodes", node, {"given_motion": keys})

    def set_initial(self, node, **keys):
        """Deviation and its rate at the start: angle_deg, speed_rad_per_s; or position_mm, velocity_m_per_s."""
        self._change("nodes", node, {f"initial_{key}": v for key, v in keys.items()})

    def _add_element(self, kind, name, nodes, keys):
        given = {"node": nodes} if isinstance(nodes, str) else {"nodes": list(nodes)} if len(nodes) else {}
        return self._enter("elements", name, {"type": kind, **given, **keys})

    def add_law(self, name, nodes, torque, *, energy=None, when=None):
        """A spring, coupling or damper whose law is a Python callable. SLOW: about a microsecond per call, a thousand
        times as much as an element of the catalogue; use add_polyline_spring or C++ where possible.

        torque(x, rate, t): torque or force for the deflection x = q_b - q_a (or of the node itself, to ground) [rad or
        m], its rate and the time [s]; positive opposes a positive x. It returns a number, or (torque, its slope by x,
        its slope by rate), which saves four calls for finite differences. It must be pure: same input, same output.
        energy(x): stored energy [J], whose derivative is torque(x, 0, t). Without it the law's work counts as
        dissipated in the energy balance.
        """
        self._slow()
        return self._add_callable("python_law", name, nodes, f"law '{name}'", torque, energy, {"when": when})

    def add_load(self, name, node, torque, *, breakpoints_s=None, when=None):
        """A torque (or force) on a node, given by a Python callable. SLOW, like add_law; use add_applied_torque with a
        table or harmonics where possible.

        torque(t), or torque(t, angle, speed) with the node's actual angle and speed; positive drives the node
        forward. It returns a number; if it depends on the motion, (torque, slope by angle, slope by speed) saves four
        calls.
        breakpoints_s: times at which it has a jump or a kink; there it must give the value after the jump.
        """
        self._slow()
        of_motion = _argument_count(torque) == 3
        keys = {"of_motion": True if of_motion else None, "when": when}
        if breakpoints_s is not None:
            keys["breakpoints"] = {"time_s": list(breakpoints_s)}
        return self._add_callable("python_load", name, node, f"load '{name}'", torque, None, keys)

    def _add_callable(self, kind, name, nodes, label, function, energy, keys):
        for what, given in (("torque", function), ("energy", energy)):
            if not callable(given) and (what == "torque" or given is not None):
                raise TypeError(f"{label}: {what} must be callable, not {given!r}")
        registered = _drev.Registered(function, energy, label)
        self._callables.append(registered)
        return self._add_element(kind, name, nodes, {"callable": registered.number, **keys})

    @staticmethod
    def _slow():
        global _slow_was_said
        if not _slow_was_said:
            _slow_was_said = True
            message = "a Python callable costs about a thousand times what an element of the catalogue does"
            warnings.warn(message, _errors.SlowWarning, stacklevel=4)

    def add_parameter(self, name, default, *, min=None, max=None, whole=None, choices=None, meaning=None):
        """A number (or one of `choices`) that set(), vary() and run(parameters=...) change; elements use it by its
        name in expressions: stiffness_Nm_per_rad="2*k_Nm_per_rad". Its unit is the end of its name."""
        keys = {"default": default, "min": min, "max": max, "whole": whole, "choices": choices, "meaning": meaning}
        return self._enter("parameters", name, keys)

    def add_list(self, name, values):
        """A list of numbers for expressions, LIST[k] counted from 1."""
        self._sections["lists"][name] = _toml.written(list(values), name)
        return name

    def add_table(self, name, columns=None, **more):
        """A table of columns that elements use by its name: {"angle_deg": array, "torque_Nm": array}, or csv=FILE."""
        return self._enter("tables", name, {**(columns or {}), **more})

    def include(self, file):
        """Extends a model file: its nodes and elements come first; this model's replace those of the same names."""
        self._include.append(str(file))

    def set_run(self, name=None, **keys):
        """Defaults for run(): duration_s, record, deflection, torques, start, ...
        (docs/model_file.md#runs). name: name of a separate run, for run(run=name)."""
        if name is None:
            self._sections["run"].update(_written("run", keys))
        else:
            self._change("run", name, keys)

    def set_class(self, **keys):
        """Strength of the sections, for judge(): rated_speed_rpm, sections={name: {...}} (docs/class_report.md)."""
        self._sections["class"].update(_written("class", keys))

    # Attributes that the extension module reads.
    def _text(self):
        if self._whole_text is not None:
            return self._whole_text
        lines = [f"{key} = {_toml.value(v)}" for key, v in self._head.items()]
        if self._include:
            lines.append(f"include = {_toml.value(self._include)}")
        for section, entries in self._sections.items():
            if entries:
                lines.append(f"[{section}]")
                lines += [f"{_toml.key(name)} = {_toml.value(v, name)}" for name, v in entries.items()]
        return "\n".join(lines) + "\n"

    def _keep(self):
        return self._callables

    def _request(self, *arguments, **keywords):
        request = super()._request(*arguments, **keywords)
        if self._faults:
            raise _errors.ModelError(self._faults + self._other_faults())
        return request

    def _other_faults(self):
        """Further faults of the model."""
        faults, self._faults = self._faults, []
        try:
            self.check()
        except _errors.ModelError as error:
            return error.findings
        finally:
            self._faults = faults
        return []

    @property
    def source(self):
        """The text of the model file that describes this model, as it was given."""
        return self._text()

    def __repr__(self):
        nodes, elements = len(self._sections["nodes"]), len(self._sections["elements"])
        return f"<drev.Model {self.name!r}: {nodes} nodes, {elements} elements>"


def _written(name, values):
    """The keys with their values as text, as they are now: arrays may be used again, and what no file can hold is refused at
    once."""
    return {key: _toml.written(given, f"{name}.{key}") for key, given in values.items() if given is not None}


def _argument_count(function):
    try:
        parameters = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):
        return 1
    if any(p.kind is p.VAR_POSITIONAL for p in parameters):
        return 1
    return sum(p.default is p.empty and p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD) for p in parameters)


_elements.add_methods(Model)
