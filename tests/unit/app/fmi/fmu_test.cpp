// The functions of an FMU's library, called as an importer does; tests/fmi has them called by FMPy.
// Covers solvers/exact/start_state.hpp by the outputs before the first step.
#include <drev/core/channel.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "app/fmi/fmu_instance.hpp"
#include "tests/unit/app/process.hpp"

extern "C" {
void* fmi3InstantiateCoSimulation(const char*, const char*, const char*, bool, bool, bool, bool,
                                  const std::uint32_t*, std::size_t, void*,
                                  void (*)(void*, int, const char*, const char*), void*);
void fmi3FreeInstance(void*);
int fmi3EnterInitializationMode(void*, bool, double, double, bool, double);
int fmi3ExitInitializationMode(void*);
int fmi3DoStep(void*, double, double, bool, bool*, bool*, bool*, double*);
int fmi3GetFloat64(void*, const std::uint32_t*, std::size_t, double*, std::size_t);
int fmi3SetFloat64(void*, const std::uint32_t*, std::size_t, const double*, std::size_t);
int fmi3GetFMUState(void*, void**);
int fmi3SetFMUState(void*, void*);
int fmi3FreeFMUState(void*, void**);
int fmi3DeserializeFMUState(void*, const std::uint8_t*, std::size_t, void**);
int fmi3EnterEventMode(void*);
}

namespace drev::app {
namespace {

// One inertia on a spring to ground: x'' + w^2 x = T/J, w = 20 rad/s.
constexpr const char* kOscillator = R"(format = 1
[parameters]
stiffness = { default = 4, min = 0.1, max = 100 }
[nodes]
wheel = {}
[elements]
J = { type = "inertia", node = "wheel", inertia_kg_m2 = 0.01 }
spring = { type = "ground_spring", node = "wheel", stiffness_Nm_per_rad = "stiffness" }
[run]
duration_s = 1
)";

/// The folder of resources of an FMU of the oscillator, with a torque as input. Each test program has its own: tests run side by
/// side.
std::string oscillator(const std::vector<std::string>& tunable = {}) {
  static const test::TemporaryFolder resources;
  const std::filesystem::path folder = resources / "";
  std::ofstream(folder / "model.toml") << kOscillator;
  std::ofstream(folder / "interface.toml")
      << interface_text({"model.toml", "", "token", {"wheel"}, {}, {"wheel.angle_rad"}, {}, tunable});
  return folder.string();
}

constexpr std::uint32_t kTorque = 2, kAngle = 3;  // value references: time, stiffness, torque, angle

struct Logged {
  std::string last;
  static void take(void* self, int, const char*, const char* message) {
    static_cast<Logged*>(self)->last = message;
  }
};

void* make(Logged& log, const char* token = "token") {
  return fmi3InstantiateCoSimulation("wheel", token, oscillator().c_str(), false, false, false, false,
                                     nullptr, 0, &log, &Logged::take, nullptr);
}

double angle(void* fmu) {
  double value = std::nan("");
  CHECK(fmi3GetFloat64(fmu, &kAngle, 1, &value, 1) == 0);
  return value;
}

}  // namespace

TEST_CASE("An FMU under a torque that is held moves as the closed form says") {
  Logged log;
  void* fmu = make(log);
  REQUIRE(fmu != nullptr);
  REQUIRE(fmi3EnterInitializationMode(fmu, false, 0.0, 0.0, true, 1.0) == 0);
  REQUIRE(fmi3ExitInitializationMode(fmu) == 0);
  const double torque = 0.8, w = 20.0;
  REQUIRE(fmi3SetFloat64(fmu, &kTorque, 1, &torque, 1) == 0);
  bool event = true, terminate = true, early = true;
  double last = 0.0, largest = 0.0;
  for (int i = 0; i < 100; ++i) {
    REQUIRE(fmi3DoStep(fmu, 0.01 * i, 0.01, true, &event, &terminate, &early, &last) == 0);
    const double t = 0.01 * i + 0.01;
    largest = std::max(largest, std::abs(angle(fmu) - torque / 4.0 * (1.0 - std::cos(w * t))));
  }
  CHECK(largest < 1e-11 * torque / 4.0);
  CHECK_FALSE((event || terminate || early));
  CHECK(last == Approx(1.0).epsilon(1e-15));

  // Wrong use is answered with an error and a message, and changes nothing.
  const double before = angle(fmu);
  const std::uint32_t stiffness = 1, unknown = 4;
  double value = 5.0;
  CHECK(fmi3SetFloat64(fmu, &stiffness, 1, &value, 1) == 3);
  CHECK(log.last.find("fixed") != std::string::npos);
  CHECK(fmi3GetFloat64(fmu, &unknown, 1, &value, 1) == 3);
  CHECK(log.last.find("no value reference 4") != std::string::npos);
  CHECK(fmi3GetFloat64(fmu, &kAngle, 1, &value, 2) == 3);
  CHECK(fmi3DoStep(fmu, 0.5, 0.01, true, &event, &terminate, &early, &last) == 3);
  CHECK(log.last.find("communication point") != std::string::npos);
  CHECK(fmi3DoStep(fmu, 1.0, -1.0, true, &event, &terminate, &early, &last) == 3);
  CHECK(fmi3DoStep(fmu, 1.0, 0.01, true, &event, &terminate, &early, &last) == 3);
  CHECK(log.last.find("passes the stop time, 1 s") != std::string::npos);
  CHECK(fmi3EnterInitializationMode(fmu, false, 0.0, 0.0, false, 0.0) == 3);
  CHECK(fmi3EnterEventMode(fmu) == 3);
  CHECK(angle(fmu) == before);
  fmi3FreeInstance(fmu);
  CHECK(fmi3GetFloat64(fmu, &kAngle, 1, &value, 1) == 3);
  CHECK(make(log, "another") == nullptr);
  CHECK(log.last.find("token") != std::string::npos);
}

TEST_CASE("A model that only methods of steps take is no FMU, and none of them is advised") {
  const test::TemporaryFolder folder;
  const std::string model = R"(format = 1
[nodes]
wheel = {}
shaker = { given_motion = { amplitude_rad = 0.1, frequency_Hz = 5 } }
[elements]
J = { type = "inertia", node = "wheel", inertia_kg_m2 = 0.01 }
shaft = { type = "shaft_spring", nodes = ["shaker", "wheel"], stiffness_Nm_per_rad = 4 }
[run]
method = "dormand_prince"
tolerance = 1e-8
duration_s = 1
)";
  std::ofstream(folder / "model.toml") << model;
  std::ofstream(folder / "interface.toml")
      << interface_text({"model.toml", "", "token", {"wheel"}, {}, {"wheel.angle_rad"}, {}, {}});
  Logged log;
  CHECK(fmi3InstantiateCoSimulation("wheel", "token", (folder / "").string().c_str(), false, false, false,
                                    false, nullptr, 0, &log, &Logged::take, nullptr) == nullptr);
  INFO(log.last);
  CHECK(test::contains(log.last,
                       "cannot be an FMU, which is propagated exactly whatever its method: the motion "
                       "of shaker is no polynomial of time"));
  CHECK_FALSE(test::contains(log.last, "dormand_prince"));
}

TEST_CASE("The bytes of an FMU's state are read as they were written, or refused") {
  Logged log;
  void* fmu = make(log);
  REQUIRE(fmi3EnterInitializationMode(fmu, false, 0.0, 0.0, true, 1.0) == 0);
  REQUIRE(fmi3ExitInitializationMode(fmu) == 0);
  const double torque = 0.8;
  REQUIRE(fmi3SetFloat64(fmu, &kTorque, 1, &torque, 1) == 0);
  REQUIRE(fmi3DoStep(fmu, 0.0, 0.1, true, nullptr, nullptr, nullptr, nullptr) == 0);
  FmuInstance same(oscillator());
  same.enter_initialization(0.0, 1.0, 0.0);
  same.exit_initialization();
  same.set_reals(&kTorque, &torque, 1);
  same.step(0.0, 0.1);
  const std::vector<std::uint8_t> bytes = to_bytes(same.state(), "token");
  CHECK(to_bytes(from_bytes(bytes.data(), bytes.size(), "token"), "token") == bytes);
  CHECK_THROWS_WITH(from_bytes(bytes.data(), bytes.size(), "other"), Catch::Contains("another FMU"));

  void* state = nullptr;
  for (std::size_t size = 0; size < bytes.size(); ++size)
    CHECK(fmi3DeserializeFMUState(fmu, bytes.data(), size, &state) == 3);
  REQUIRE(fmi3DeserializeFMUState(fmu, bytes.data(), bytes.size(), &state) == 0);
  CHECK(fmi3SetFMUState(fmu, state) == 0);
  CHECK(angle(fmu) == same.real(kAngle));

  std::mt19937 random(1);
  int accepted = 0;
  for (int i = 0; i < 300; ++i) {  // one byte is wrong: what is then still a state may be any, but not crash
    std::vector<std::uint8_t> wrong = bytes;
    wrong[random() % wrong.size()] ^= static_cast<std::uint8_t>(1U << (random() % 8U));
    void* made = nullptr;
    if (fmi3DeserializeFMUState(fmu, wrong.data(), wrong.size(), &made) != 0) continue;
    if (fmi3SetFMUState(fmu, made) == 0) {
      ++accepted;
      double value = 0.0;
      fmi3GetFloat64(fmu, &kAngle, 1, &value, 1);
      fmi3DoStep(fmu, 0.1, 1e-3, true, nullptr, nullptr, nullptr, nullptr);
    }
    CHECK(fmi3FreeFMUState(fmu, &made) == 0);
  }
  CHECK(accepted > 0);
  CHECK(fmi3SetFMUState(fmu, state) == 0);
  CHECK(angle(fmu) == same.real(kAngle));
  CHECK(fmi3FreeFMUState(fmu, &state) == 0);
  CHECK(state == nullptr);
  fmi3FreeInstance(fmu);
}

TEST_CASE("A tunable parameter of an FMU changes while it runs, from where the motion has come to") {
  CHECK(FmuInstance(oscillator()).find_tunable() == std::vector<std::string>{"stiffness"});
  FmuInstance fmu(oscillator({"stiffness"}));
  const unsigned stiffness = 1;
  const double torque = 0.8, soft = 1.0;
  fmu.set_reals(&kTorque, &torque, 1);
  fmu.enter_initialization(0.0, std::nullopt, 1e-12);
  fmu.exit_initialization();
  fmu.step(0.0, 0.25);
  fmu.set_reals(&stiffness, &soft, 1);
  CHECK(fmu.real(kAngle) == Approx(torque / 4 * (1 - std::cos(5.0))).epsilon(1e-11));
  fmu.step(0.25, 0.1);
  // From x_0, v_0 of w = 20 rad/s on with w = 10 rad/s about T/k = 0.8 rad.
  const double x_0 = torque / 4 * (1 - std::cos(5.0)), v_0 = torque / 4 * 20 * std::sin(5.0);
  CHECK(fmu.real(kAngle) ==
        Approx(0.8 + (x_0 - 0.8) * std::cos(1.0) + v_0 / 10 * std::sin(1.0)).epsilon(1e-11));
  const double wrong = 1e3;
  CHECK_THROWS_WITH(fmu.set_reals(&stiffness, &wrong, 1), Catch::Contains("0.1 to 100"));
  CHECK(fmu.real(stiffness) == soft);
}

TEST_CASE("An FMU with dry friction knows its torque and acceleration before the first step") {
  const test::TemporaryFolder resources;
  const std::filesystem::path folder = resources / "";
  std::ofstream(folder / "model.toml") << R"(format = 1
[nodes]
a = { initial_speed_rad_per_s = 5 }
[elements]
J = { type = "inertia", node = "a", inertia_kg_m2 = 1 }
brake = { type = "brake", node = "a", torque_Nm = 3 }
)";
  std::ofstream(folder / "interface.toml") << interface_text(
      {"model.toml", "", "token", {}, {}, {"a.acceleration_rad_per_s2", "brake.torque_Nm"}, {}, {}});
  FmuInstance fmu(folder.string());
  fmu.enter_initialization(1.0, 2.0, 0.0);
  CHECK(fmu.real(1) == Approx(-3.0));
  CHECK(fmu.real(2) == Approx(3.0));
  fmu.exit_initialization();
  CHECK(fmu.real(1) == Approx(-3.0));
  fmu.reset();
  CHECK_THROWS_WITH(fmu.enter_initialization(1.0, 0.5, 0.0),
                    Catch::Contains("must be >= the start time, 1 s"));
}

TEST_CASE("Parameters of an FMU are set before its initialization ends, and refused out of their range") {
  FmuInstance fmu(oscillator());
  const unsigned stiffness = 1;
  const double soft = 1.0, wrong = 1e3, torque = 0.8;
  CHECK_THROWS_WITH(fmu.set_reals(&stiffness, &wrong, 1), Catch::Contains("0.1 to 100"));
  fmu.set_reals(&stiffness, &soft, 1);
  fmu.set_reals(&kTorque, &torque, 1);
  fmu.enter_initialization(0.0, std::nullopt, 1e-12);
  fmu.exit_initialization();
  const double slope = 2.0;
  fmu.set_input_slopes(&kTorque, &slope, 1);
  fmu.step(0.0, 0.25);
  // T = T_0 + s t: x = (T_0 (1 - cos wt) + s (t - sin(wt)/w)) / k, w = 10 rad/s.
  CHECK(fmu.real(kAngle) ==
        Approx(torque * (1 - std::cos(2.5)) + slope * (0.25 - std::sin(2.5) / 10)).epsilon(1e-11));
  fmu.reset();
  CHECK(fmu.real(stiffness) == 4.0);
}

}  // namespace drev::app
