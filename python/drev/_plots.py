"""Plots, each with matplotlib (an Axes or a Figure comes back) or Plotly (its Figure comes back).

A plot is a list of panels; both libraries draw the same panels.
"""
from dataclasses import dataclass, field

import numpy as np


@dataclass
class Curve:
    """x and y, with a name; `style`: "line", "dashed", "points" or "bar"."""

    x: object
    y: object
    name: str = ""
    style: str = "line"


@dataclass
class Panel:
    x_label: str
    y_label: str
    curves: list = field(default_factory=list)
    title: str = ""
    x_names: object = None  #: names of the ticks at 0, 1, ...
    log: bool = False


def _matplotlib(panels, axes=None):
    from matplotlib import pyplot

    if axes is None:
        figure, axes = pyplot.subplots(len(panels), 1, sharex=len(panels) > 1, squeeze=False,
                                       figsize=(9, 2.2 + 2.2 * len(panels)), layout="constrained")
        axes = axes[:, 0]
    else:
        axes = np.atleast_1d(axes)
        figure = axes[0].figure
    for panel, ax in zip(panels, axes):
        for curve in panel.curves:
            if curve.style == "bar":
                ax.bar(curve.x, curve.y, label=curve.name)
            else:
                style = {"line": "-", "dashed": "--", "points": "o"}[curve.style]
                ax.plot(curve.x, curve.y, style, label=curve.name, linewidth=1.1, markersize=4)
        if panel.log:
            ax.set_xscale("log")
            ax.set_yscale("log")
        ax.set_ylabel(panel.y_label)
        ax.set_title(panel.title)
        if panel.x_names is not None:
            ax.set_xticks(range(len(panel.x_names)), panel.x_names, rotation=90 if len(panel.x_names) > 6 else 0)
        if len([c for c in panel.curves if c.name]) > 1:
            ax.legend(fontsize="small")
        ax.grid(True, alpha=0.3)
    axes[len(panels) - 1].set_xlabel(panels[-1].x_label)
    return figure


def _plotly(panels):
    from plotly import graph_objects
    from plotly.subplots import make_subplots

    figure = make_subplots(rows=len(panels), cols=1, shared_xaxes=True, subplot_titles=[p.title for p in panels])
    for row, panel in enumerate(panels, 1):
        for curve in panel.curves:
            x = panel.x_names if panel.x_names is not None else curve.x
            if curve.style == "bar":
                trace = graph_objects.Bar(x=x, y=curve.y, name=curve.name)
            else:
                trace = graph_objects.Scatter(
                    x=x, y=curve.y, name=curve.name, mode="markers" if curve.style == "points" else "lines",
                    line={"dash": "dash"} if curve.style == "dashed" else None)
            figure.add_trace(trace, row=row, col=1)
        figure.update_yaxes(title_text=panel.y_label, row=row, col=1, type="log" if panel.log else None)
        figure.update_xaxes(type="log" if panel.log else None, row=row, col=1)
    figure.update_xaxes(title_text=panels[-1].x_label, row=len(panels), col=1)
    figure.update_layout(height=180 + 240 * len(panels))
    return figure


def _draw(panels, backend, **more):
    if backend == "matplotlib":
        return _matplotlib(panels, **more)
    if backend == "plotly":
        return _plotly(panels, **more)
    raise ValueError(f'backend must be "matplotlib" or "plotly", not {backend!r}')


def history(run, channels, backend, **more):
    panels = {}
    for channel in channels:
        values = run[channel]
        unit = run.units[channel]
        panels.setdefault(unit, Panel("time [s]", f"[{unit}]")).curves.append(Curve(run.time, values, channel))
    for panel in panels.values():
        if len(panel.curves) == 1:
            panel.y_label = f"{panel.curves[0].name} {panel.y_label}"
    return _draw(list(panels.values()), backend, **more)


def contacts(run, backend, **more):
    found = run.contacts
    if not found:
        raise ValueError(f"{run.summary['model']} has no contact with a gap")
    names = [c["element"] for c in found]
    places = np.arange(len(names))

    def bars(y_label, *columns):
        # Bars of front and back are side by side.
        width = 0.8 / len(columns)
        curves = [
            Curve(places + (i - 0.5 * (len(columns) - 1)) * width, [np.nan if v is None else v for v in values], name, "bar")
            for i, (name, values) in enumerate(columns)
        ]
        return Panel("", y_label, curves, x_names=names)

    impacts = bars("impacts", ("front", [c["front_contacts"] for c in found]), ("back", [c["back_contacts"] for c in found]))
    separated = bars("time separated [%]", ("", [100 * (c["time_separated_share"] or 0) for c in found]))
    unit = found[0]["impact_speed"]["unit"]
    speed = bars(
        f"impact speed [{unit}]",
        *((key, [c["impact_speed"]["both"][key] for c in found]) for key in ("p50", "p90", "max")),
    )
    if backend == "matplotlib":
        for panel in (impacts, separated, speed):
            for curve in panel.curves:
                curve.y = np.asarray(curve.y, dtype=float)
    return _draw([impacts, separated, speed], backend, **more)


def modes(modes_, numbers, backend, **more):
    numbers = numbers or range(1, min(4, len(modes_)) + 1)
    for number in numbers:
        if not 1 <= number <= len(modes_):
            raise ValueError(f"mode {number} is none of 1 to {len(modes_)}")
    panel = Panel("node", "shape", x_names=modes_.nodes)
    for number in numbers:
        shape = modes_.shapes[:, number - 1]
        shape = np.real(shape) if np.isrealobj(shape) else np.abs(shape)
        name = f"{number}: {modes_.frequency_Hz[number - 1]:.4g} Hz"
        panel.curves.append(Curve(np.arange(len(shape)), shape / np.max(np.abs(shape)), name))
    return _draw([panel], backend, **more)


def sweep(sweep_, names, backend, **more):
    panels = {}
    if sweep_.is_linear:
        for name in names or sweep_.sections:
            section = sweep_.sections[name]
            panel = panels.setdefault(section.unit, Panel("speed [rpm]", f"half range [{section.unit}]"))
            panel.curves.append(Curve(sweep_.speeds_rpm, section.half_range, name))
        return _draw(list(panels.values()), backend, **more)
    units = {s["name"]: s["unit"] for s in sweep_.data["sections"]}
    for name in names or units:
        panel = panels.setdefault(units[name], Panel("speed [rpm]", f"half range [{units[name]}]"))
        for i, branch in enumerate(sweep_.branches, 1):
            for label, wanted, style in (("stable", True, "line"), ("unstable", False, "dashed")):
                if np.any(branch.stable == wanted):
                    y = np.where(branch.stable == wanted, branch.half_range[name], np.nan)
                    panel.curves.append(Curve(branch.speed_rpm, y, f"{name}, curve {i}, {label}", style))
    return _draw(list(panels.values()), backend, **more)


def campbell(diagram, backend, **more):
    low, high = diagram.data["from_rpm"], diagram.data["to_rpm"]
    panel = Panel("speed [rpm]", "frequency [Hz]")
    for mode, frequency in enumerate(diagram.frequency_Hz, 1):
        constant = len(diagram.speeds_rpm) == 1
        x = [low, high] if constant else diagram.speeds_rpm
        panel.curves.append(Curve(x, np.repeat(frequency, 2) if constant else frequency, f"mode {mode}"))
    top = 1.1 * np.nanmax(diagram.frequency_Hz) if len(diagram.frequency_Hz) else 1.0
    for order in sorted({c["order"] for c in diagram.criticals}):
        end = min(high, 60 * top / order)
        panel.curves.append(Curve([low, end], [low / 60 * order, end / 60 * order], f"order {order:g}", "dashed"))
    if diagram.criticals:
        x = [c["speed_rpm"] for c in diagram.criticals]
        panel.curves.append(Curve(x, [c["frequency_Hz"] for c in diagram.criticals], "criticals", "points"))
    return _draw([panel], backend, **more)


def chart(chart_, backend, **more):
    panel = Panel("processor time [s]", f"error of {chart_.data['quantity']}", log=True)
    for curve in chart_.data["curves"]:
        points = [p for p in curve["points"] if p.get("error") and p.get("processor_time_s")]
        if points:
            panel.curves.append(Curve([p["processor_time_s"] for p in points], [p["error"] for p in points], curve["method"]))
    return _draw([panel], backend, **more)
