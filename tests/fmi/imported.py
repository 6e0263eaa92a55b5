"""FMUs in models: drev's own, of one half of a train, coupled back to the other half by drev run."""
import os
import subprocess
import zipfile

import halves
from client import difference, run

ELEMENT = """
[elements.right]
type = "fmu"
node = "hub"
file = "%s"
step_s = %r
hold = "%s"
interpolate_inputs = %s
inputs = [{ variable = "port.input_speed_rad_per_s", channel = "hub.actual_speed_rad_per_s" }]
outputs = [{ variable = "port.reaction_Nm", factor = -1 }]
"""
LEFT_NODES = "[nodes]\nmotor = {}\nhub = {}\n[elements]"


def left_with(fmu, h, hold="zero_order", interpolate="false"):
    return halves.HEAD + LEFT_NODES + halves.LEFT + ELEMENT % (fmu, h, hold, interpolate) + halves.RUN


def coupled_back(drev, export, write, folder):
    """The left half in drev, the right half as an FMU in it, against the whole train. What is held is the only error: of
    first order where torques are held, of second where both torques and speeds follow straight lines."""
    channels = ["motor.angle_rad"]
    whole = write("whole_import.toml", halves.WHOLE_FILE)
    expected = run(drev, whole, channels, 0.1, 1e-3, os.path.join(folder, "run_whole"))
    right = write("right_import.toml", halves.RIGHT_FILE)
    rows = {}
    for fmi in "32":
        export(right, "right_" + fmi, "--fmi", fmi, "--speed", "port", "--record", "port.reaction_Nm")
    for fmi, hold, interpolate, order in (("3", "zero_order", "false", 1), ("2", "zero_order", "false", 1),
                                          ("2", "first_order", "true", 2)):
        errors = []
        for h in (2e-4, 1e-4, 5e-5):
            model = write("left_import.toml", left_with(f"right_{fmi}.fmu", h, hold, interpolate))
            found = run(drev, model, channels, 0.1, 1e-3, os.path.join(folder, "run_left"))
            rows[fmi, hold, h] = found
            errors.append(difference(found, expected))
        print(f"a half as FMU {fmi}, {hold}, steps of 200, 100, 50 us:", " ".join(f"{e:.1e}" for e in errors))
        for coarse, fine in zip(errors, errors[1:]):
            assert 0.8 * 2**order < coarse / fine < 1.25 * 2**order, f"not of order {order}"
    assert (rows["3", "zero_order", 1e-4] == rows["2", "zero_order", 1e-4]).all(), "FMI 2 and 3 differ"
    # Steps by another method, exact where the torque is constant but for its own error.
    model = write("left_import.toml", left_with("right_3.fmu", 1e-4))
    stepped = run(drev, model, channels, 0.1, 1e-3, os.path.join(folder, "run_stepped"),
                  ["--tolerance", "1e-9"], method="dormand_prince")
    assert difference(stepped, rows["3", "zero_order", 1e-4]) < 1e-6


def refused_imports(drev, write, folder):
    """What is wrong with an FMU is said with the file, the variable, the place and what the FMU logged; nothing of an FMU
    stays behind in the folder of temporary files."""
    temporary = os.path.join(folder, "temporary")
    os.makedirs(temporary)

    def answer(text, command="check", *options):
        path = write("refused.toml", text)
        done = subprocess.run([drev, command, path, *options], check=False, capture_output=True, text=True,
                              env=dict(os.environ, TMPDIR=temporary))
        assert os.listdir(temporary) == [], os.listdir(temporary)
        return done.returncode, done.stdout + done.stderr

    good = left_with("right_3.fmu", 1e-3)
    assert answer(good)[0] == 0
    for text, words in ((left_with("missing.fmu", 1e-3), "is no file"),
                        (left_with("refused.toml", 1e-3), "is no ZIP archive"),
                        (left_with("right_3.fmu", -1e-3), "step = -0.001 s, must be"),
                        (left_with("right_3.fmu", 1e-3, interpolate="true"), "canInterpolateInputs"),
                        (good.replace("port.reaction_Nm", "port.reacton_Nm"), "did you mean 'port.reaction_Nm'"),
                        (good.replace("port.input_speed", "port.speed"), "did you mean 'port.input_speed_rad_per_s'"),
                        (good.replace("hub.actual", "hb.actual"), "is no channel of this model")):
        code, said = answer(text)
        assert code == 2 and words in said and "refused.toml:" in said, said
    for command, options in (("modes", ()), ("sweep", ("--speeds", "100:100:300")), ("modes", ("--damped",))):
        code, said = answer(good, command, *options)
        assert code != 0 and "right is a controller that is sampled every 0.001 s (FMU)" in said, said
    code, said = answer(good, "export", "--fmu", os.path.join(folder, "nested.fmu"))
    assert code != 0 and "right is a controller" in said, said
    # A parameter out of the range that the FMU declares; and one that it refuses itself, and logs.
    limited = halves.RIGHT_FILE.replace("stiffness_Nm_per_rad = 400", 'stiffness_Nm_per_rad = "stiffness"')
    for limits, command, words in ((", min = 1", "check", "stiffness = -3, must be >= 1, as the FMU declares"),
                                   ("", "run", "answered 'error'; the FMU logged:")):
        parameters = "[parameters]\nstiffness = { default = 400%s }\n[nodes]" % limits
        write("limited.toml", limited.replace("[nodes]", parameters))
        subprocess.run([drev, "export", os.path.join(folder, "limited.toml"), "--fmu",
                        os.path.join(folder, "limited.fmu"), "--speed", "port", "--record", "port.reaction_Nm"], check=True)
        text = left_with("limited.fmu", 1e-3).replace("factor = -1 }]", 'factor = -1 }]\nparameters = '
                                                      '[{ variable = "stiffness", value = -3 }]')
        code, said = answer(text, command)
        said = " ".join(said.split())
        assert code != 0 and words in said, said


def hostile_archives(drev, write, folder):
    """Archives that reach out of their folder, or hold more than fits, are refused and leave nothing."""
    description = zipfile.ZipFile(os.path.join(folder, "right_3.fmu")).read("modelDescription.xml")
    link = zipfile.ZipInfo("resources/link")
    link.external_attr = 0o120777 << 16

    def refused(name, words, *entries, size=None):
        path = os.path.join(folder, name)
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
            for entry, content in entries:
                archive.writestr(entry, content)
        if size is not None:  # unpacked, as the archive's directory says of its first file
            with open(path, "rb") as file:
                content = bytearray(file.read())
            at = content.index(b"PK\1\2") + 24
            content[at:at + 4] = size.to_bytes(4, "little")
            with open(path, "wb") as file:
                file.write(content)
        done = subprocess.run([drev, "check", write("hostile.toml", left_with(name, 1e-3)), "--json"], check=False,
                              capture_output=True, text=True)
        assert done.returncode == 2 and words in done.stdout + done.stderr, (done.stdout, done.stderr)

    refused("up.fmu", "leads out of it", ("modelDescription.xml", description), ("../up.txt", "x"))
    refused("root.fmu", "leads out of it", ("/tmp/root.txt", "x"))
    refused("deep.fmu", "leads out of it", ("resources/../../deep.txt", "x"))
    refused("link.fmu", "holds the link", (link, "/etc/passwd"))
    refused("none.fmu", "is no FMU", ("readme.txt", "x"))
    refused("old.fmu", "is of FMI 1.0", ("modelDescription.xml", '<fmiModelDescription fmiVersion="1.0"/>'))
    refused("broken.fmu", "modelDescription.xml: line 1", ("modelDescription.xml", "<fmiModelDescription"))
    refused("exchange.fmu", "has no co-simulation", ("modelDescription.xml", '<fmiModelDescription fmiVersion="3.0"/>'))
    laughs = '<!DOCTYPE x [<!ENTITY a "aaaaaaaaaa">' + "".join(
        f'<!ENTITY {chr(98 + i)} "{("&" + chr(97 + i) + ";") * 10}">' for i in range(12)) + "]><x>&m;</x>"
    refused("laughs.fmu", "modelDescription.xml: line", ("modelDescription.xml", laughs))
    refused("bomb.fmu", "holds more than 1073741824 bytes", ("resources/zeros", b"\0" * 4096), size=1 << 31)
    assert not os.path.exists(os.path.join(folder, "up.txt"))
    assert "root.txt" not in os.listdir("/tmp")
