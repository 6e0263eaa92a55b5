#pragma once
/// Models of any size for the benchmarks, of inertias J = 1 kg m^2 on shafts k = 1e6 N m/rad, and what
/// a process's memory is.
///
///   chain     held by a shaft at one end, a sine torque at the other: f_j = 2 sqrt(k/J)
///             sin((2j - 1) pi/(4n + 2))/(2 pi)
///   branched  the same with a branch of 4 inertias at every sixth of its trunk
///   looped    two such chains side by side, geared together at every tenth inertia by meshes without
///             backlash
#include <drev/core/system.hpp>
#include <drev/elements/catalogue.hpp>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <malloc.h>
#include <string>

namespace drev::benchmark {

constexpr double kInertia = 1.0, kStiffness = 1e6;

class LargeModel {
 public:
  LargeModel(const std::string& shape, int n) : model_(shape) {
    if (shape == "branched")
      branched(n);
    else if (shape == "looped")
      looped(n);
    else
      load(chain("n", n, -1));
  }
  System build() const { return model_.build(); }

 private:
  NodeId inertia(const std::string& name) {
    const NodeId node = model_.add_node(name);
    model_.add<Inertia>("J" + name, {node}, {.inertia = kInertia});
    return node;
  }
  void shaft(const std::string& name, NodeId a, NodeId b) {
    model_.add<ShaftSpring>("k" + name, {a, b}, {.stiffness = kStiffness});
  }
  NodeId attached(const std::string& name, int to) {
    const NodeId node = inertia(name);
    if (to >= 0)
      shaft(name, NodeId{to}, node);
    else
      model_.add<GroundSpring>("k" + name, {node}, {.stiffness = kStiffness});
    return node;
  }
  NodeId chain(const std::string& prefix, int n, int from) {
    for (int i = 0; i < n; ++i) from = index(attached(prefix + std::to_string(i), from));
    return NodeId{from};
  }
  void branched(int n) {
    int trunk = -1;
    for (int i = 0; 10 * i < n; ++i) {
      trunk = index(chain("t" + std::to_string(i) + "_", 6, trunk));
      chain("b" + std::to_string(i) + "_", 4, trunk);
    }
    load(NodeId{trunk});
  }
  void looped(int n) {
    int a = -1, b = -1;
    for (int i = 0; 20 * i < n; ++i) {
      const std::string place = std::to_string(i);
      a = index(chain("a" + place + "_", 10, a));
      if (b >= 0)
        b = index(chain("b" + place + "_", 10, b));
      else
        b = index(chain("b" + place + "_", 9, index(inertia("b_first"))));
      model_.add<GearMesh>("mesh" + place, {NodeId{a}, NodeId{b}},
                           {.base_radius_1 = 0.1, .base_radius_2 = 0.1, .stiffness = 1e8});
    }
    load(NodeId{a});
  }
  void load(NodeId node) {
    model_.add<AppliedTorque>("drive", {node},
                              {.torque = [](double t) { return 100.0 * std::sin(200.0 * t); }});
  }

  Model model_;
};

inline double chain_frequency(int n, int mode) {
  return 2.0 * std::sqrt(kStiffness / kInertia) * std::sin((2 * mode - 1) * kPi / (4.0 * n + 2.0)) / kTwoPi;
}

/// "VmRSS:" or "VmHWM:" of this process [B]; 0 where /proc is not there.
inline double process_memory(const char* what) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(what)) return 1024.0 * std::stod(line.substr(std::strlen(what)));
  return 0.0;
}

/// Gives freed memory back and starts VmHWM again.
inline void forget_memory_peak() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}

}  // namespace drev::benchmark
