#pragma once
/// Random trains with clutches, brakes, joints, bearings, freewheels, lossy gears and backlash, and their motion by a code of its
/// own: classical Runge-Kutta in short steps, each event placed by bisection, and which contacts stick behind it found
/// by trying every combination over a trial step. It shares nothing with drev but the description below.
#include <drev/core/model.hpp>

#include <string>
#include <vector>

namespace drev::test {

struct FrictionTrain {
  struct Spring {
    int a, b;  ///< nodes; b = -1: ground
    double stiffness, damping, half_gap;
  };
  struct Contact {
    enum class Kind { clutch, brake, joint, bearing, freewheel } kind;
    int a, b;  ///< slip = speed of b less that of a; b = -1: speed of a
    double torque, break_away;
    double knot_speed, far_torque;  ///< sliding torque at that slip speed and beyond; 0: constant
    std::vector<double> times = {}, parts = {};  ///< of the engagement; empty: 1
  };
  /// Speed of b = ratio times that of a. Efficiencies and bearing torques (at a) of a and b driving; at that speed of
  /// a and beyond those of `far`, linear between; 0: constant.
  struct Gear {
    struct Loss {
      double forward, backward, bearing_forward, bearing_backward;
    };
    int a, b;
    double ratio;
    Loss loss;
    double knot_speed = 0.0;
    Loss far = {};
  };
  struct Drive {
    double mean, amplitude, frequency_Hz;
  };
  std::vector<double> inertia, angle, speed;
  std::vector<Drive> drives;  ///< of every node
  std::vector<Spring> springs;
  std::vector<Contact> contacts;
  std::vector<Gear> gears;
  double duration = 0.2;  ///< s
};

/// The same train for the same seed, anywhere. Where contacts close a loop (side by side, or over the ground), rigid bodies do
/// not tell how they share a torque at rest: break-away ratios are left out there unless they are asked for.
FrictionTrain random_friction_train(unsigned seed, bool break_away_in_loops = false);
Model to_model(const FrictionTrain& train);

struct FrictionMotion {
  std::vector<double> angle, speed;  ///< at the end
  long events = 0;                   ///< contacts that stick, slide or turn round
};
FrictionMotion integrate(const FrictionTrain& train, double step);

/// What became of a train in drev beside integrate().
struct FrictionVerdict {
  double difference = 0.0;    ///< of angles and speeds at the end, relative to the largest of each
  double sensitivity = 0.0;   ///< the same between two runs of drev whose speeds at the start differ by 1e-9
  double energy_error = 0.0;  ///< relative; 0 for a train without 1e-9 J, which friction holds at rest
  long changes = 0, events = 0, steps = 0;
  std::string failure;  ///< empty: it ran, its balance closed
  /// The motions agree to 1e-7, or as well as the train's sensitivity allows.
  bool agrees() const { return failure.empty() && difference <= 1e-7 + 1e3 * sensitivity; }
};
FrictionVerdict judge(const FrictionTrain& train);
/// The same without the other code: that the train runs, ends, and its balance closes.
FrictionVerdict judge_alone(const FrictionTrain& train);

}  // namespace drev::test
