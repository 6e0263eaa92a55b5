"""A train of three inertias as a whole, and cut at its middle: the left half takes the torque of the shaft to the
right and gives the speed of its node, the right half takes that speed and gives back the torque."""

HEAD = "format = 1\n"
SHAFTS = """
shaft_1 = { type = "shaft_spring", nodes = ["motor", "hub"], stiffness_Nm_per_rad = 900, damping_Nms_per_rad = 0.05 }
"""
RIGHT = """
shaft_2 = { type = "shaft_spring", nodes = ["%s", "load"], stiffness_Nm_per_rad = 400, damping_Nms_per_rad = 0.05 }
J_load = { type = "inertia", node = "load", inertia_kg_m2 = 0.05 }
"""
LEFT = SHAFTS + """
J_motor = { type = "inertia", node = "motor", inertia_kg_m2 = 0.02 }
J_hub = { type = "inertia", node = "hub", inertia_kg_m2 = 0.03 }
drive = { type = "applied_torque", node = "motor", harmonics = { frequency_Hz = [11], amplitude_Nm = [5], phase_deg = [-90] } }
"""
RUN = "[run]\nduration_s = 0.2\n"

WHOLE_FILE = HEAD + "[nodes]\nmotor = {}\nhub = {}\nload = {}\n[elements]" + LEFT + RIGHT % "hub" + RUN
LEFT_FILE = HEAD + "[nodes]\nmotor = {}\nhub = {}\n[elements]" + LEFT + RUN
RIGHT_FILE = HEAD + "[nodes]\nport = { hold = true }\nload = {}\n[elements]" + RIGHT % "port" + RUN
