"""100 random sequences of calls, most of them wrong.   hostile.py FMU
Every status must be one of the standard's, and a well-behaved simulation afterwards the same as before."""
import ctypes
import random
import sys

from fmpy.fmi3 import fmi3LogMessageCallback

from client import Fmu, simulate

fmu = Fmu(sys.argv[1])
names = ["wheel.angle_rad", "mesh.force_N"]
before = simulate(fmu, names, 0.01, 1e-3)
library = ctypes.CDLL(str(fmu.folder) + "/binaries/x86_64-linux/"
                      + fmu.description.coSimulation.modelIdentifier + ".so")
log = fmi3LogMessageCallback(lambda *_: None)
random.seed(1)
counts = {}
token = fmu.description.guid.encode()
resources = (str(fmu.folder) + "/resources/").encode()
library.fmi3InstantiateCoSimulation.restype = ctypes.c_void_p


def doubles(count):
    pick = [0.0, 1.0, 300.0, -20.0, -1e300, float("nan"), float("inf"), 1e-320, 5e-4]
    return (ctypes.c_double * max(count, 1))(*[random.choice(pick) for _ in range(count)])


def instantiate():
    return library.fmi3InstantiateCoSimulation(
        b"x", random.choice([token] * 20 + [b"wrong", None]),
        random.choice([resources] * 20 + [b"/nowhere", None]), False, False,
        random.random() < 0.03, False, None, ctypes.c_size_t(random.random() < 0.03), None,
        random.choice([log, None]), None)


def references(count):
    pick = [0, 1, 2, 3, 4, 5, 6, 7] * 4 + [8, 2**32 - 1]
    return (ctypes.c_uint32 * max(count, 1))(*[random.choice(pick) for _ in range(count)])


for sequence in range(100):
    instance, states = ctypes.c_void_p(instantiate()), []
    time = 0.0
    if random.random() < 0.8:  # else what follows is ahead of initialization, or amid it
        library.fmi3EnterInitializationMode(instance, False, ctypes.c_double(), ctypes.c_double(), False,
                                            ctypes.c_double())
        if random.random() < 0.9:
            library.fmi3ExitInitializationMode(instance)
    for _ in range(60):
        n = random.choice([0, 1, 1, 2, 5])
        m = ctypes.c_size_t(n if random.random() < 0.9 else n + 1)
        size = ctypes.c_size_t(n)
        given = random.choice([instance] * 12 + [ctypes.c_void_p(), ctypes.c_void_p(0xdead)])
        state = ctypes.c_void_p(random.choice(states + [None, 0xbeef]))
        h = random.choice([1e-3, 1e-3, 1e-4, 0.0, -1.0, float("nan"), 1e-30])
        flags = [ctypes.byref(ctypes.c_bool()) for _ in range(3)]
        last = ctypes.c_double()
        buffer = (ctypes.c_uint8 * 4096)(*[random.randrange(256) for _ in range(64)])
        real = ctypes.c_double
        calls = {
            "fmi3EnterInitializationMode": (random.random() < 0.5, real(random.choice([1e-10, 1e-8, 7.0, float("nan")])),
                                            real(random.choice([0.0, 0.0, float("nan")])), True, real(1.0)),
            "fmi3ExitInitializationMode": (),
            "fmi3GetFloat64": (references(n), size, doubles(n + 1), m),
            "fmi3SetFloat64": (references(n), size, doubles(n + 1), m),
            "fmi3GetInt32": (references(n), size, (ctypes.c_int32 * 8)(), m),
            "fmi3SetInt32": (references(n), size, (ctypes.c_int32 * 8)(), m),
            "fmi3GetString": (references(n), size, (ctypes.c_char_p * 8)(), m),
            "fmi3SetString": (references(n), size, (ctypes.c_char_p * 8)(), m),
            "fmi3GetBoolean": (references(n), size, (ctypes.c_bool * 8)(), m),
            "fmi3GetFMUState": (ctypes.byref(state),), "fmi3SetFMUState": (state,),
            "fmi3FreeFMUState": (ctypes.byref(state),),
            "fmi3SerializedFMUStateSize": (state, ctypes.byref(size)),
            "fmi3SerializeFMUState": (state, buffer, ctypes.c_size_t(random.choice([0, 10, 4096]))),
            "fmi3DeserializeFMUState": (buffer, ctypes.c_size_t(random.choice([0, 8, 64, 4096])), ctypes.byref(state)),
            "fmi3EnterEventMode": (), "fmi3EnterStepMode": (), "fmi3EnterConfigurationMode": (),
            "fmi3SetDebugLogging": (True, ctypes.c_size_t(1), (ctypes.c_char_p * 1)(b"nothing")),
            "fmi3DoStep": (real(random.choice([time, time, time, 0.5, float("nan")])), real(h), True, *flags,
                           ctypes.byref(last)),
        }
        if random.random() < 0.03:
            calls.update({"fmi3Terminate": (), "fmi3Reset": ()})
        name = random.choice(list(calls) + ["fmi3DoStep"] * 10)
        status = getattr(library, name)(given, *calls[name])
        assert status in (0, 1, 3), (name, status)
        counts[status] = counts.get(status, 0) + 1
        if given.value is None or given.value == 0xdead:
            assert status == 3, (name, status)
        if name == "fmi3DoStep" and status < 2:
            time = last.value
        if name == "fmi3Reset" and status == 0:
            time = 0.0
        if name == "fmi3GetFMUState" and status == 0:
            states.append(state.value)
        if name == "fmi3FreeFMUState" and status == 0:
            states = [s for s in states if s != state.value and s is not None] if state.value else []
    library.fmi3FreeInstance(instance)
    library.fmi3FreeInstance(instance)  # once more: it is no instance any longer
assert (simulate(fmu, names, 0.01, 1e-3) == before).all()
print("100 hostile sequences, statuses:", dict(sorted(counts.items())))
