"""Elements of one's own from a plugin, in models made in Python."""
import os
import subprocess
import sys

CODE = """
import drev, sys
drev.load_plugins(sys.argv[1])
m = drev.Model("plugged")
m.add_nodes("a", "b")
m.add_inertia("J_a", "a", inertia_kg_m2=1.0)
m.add_inertia("J_b", "b", inertia_kg_m2=2.0)
m.add_hardening_coupling("c", ["a", "b"], stiffness_Nm_per_rad=600.0)
print(m.modes().frequency_Hz[0])
try:
    drev.load_plugins(sys.argv[1])
except drev.ModelError as error:
    print(error)
called = drev.Model("called")
called.add_node("a")
called.add_inertia("J", "a", inertia_kg_m2=1.0)
called.add_load("p", "a", lambda t: 3.0)
for model in (m, called):
    try:
        model.export_fmu("refused.fmu")
    except drev.ModelError as error:
        print(str(error).replace("\\n", " "))
"""


def test_a_plugin_brings_its_elements(tmp_path):
    plugin = os.path.join(os.environ["DREV_PLUGINS"], "libhardening.so")
    printed = subprocess.run([sys.executable, "-c", CODE, plugin], capture_output=True, text=True, cwd=tmp_path)
    assert printed.returncode == 0, printed.stderr
    frequency, again, *refused = printed.stdout.splitlines()
    assert abs(float(frequency) - 30 / 6.283185307179586) < 1e-12  # sqrt(600 (1 + 1/2)) = 30 rad/s
    assert "registered already" in again
    # The library of an FMU has neither.
    assert "plugged/c" in refused[0] and "it is of the plugin" in refused[0]
    assert "called/p" in refused[1] and "no model file can hold the element" in refused[1]
