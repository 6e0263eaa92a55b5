#pragma once
/// MeanSpeed: at which speed the shafts really turn that no spring and no known motion holds at the nominal
/// one. What is held by a balance of torques alone drifts away from it.
#include <drev/solvers/run/observer.hpp>

#include <string>
#include <vector>

namespace drev {

class System;

/// Of a part that floats (contacts closed) and has a nominal speed: mean over a time, in which oscillations
/// count little (weight sin^2 over the time).
struct PartSpeed {
  std::string node;      ///< one of the part's
  double nominal = 0.0;  ///< rad/s, of the reference shaft
  double actual = 0.0;   ///< rad/s, of the reference shaft as the part's motion gives it through its ratio
  /// actual / nominal - 1; 0 where nothing turns nominally.
  double deviation() const { return nominal != 0.0 ? actual / nominal - 1.0 : 0.0; }
};

class MeanSpeed final : public Observer {
 public:
  /// Over begin to end [s], of which the run shows this a part.
  MeanSpeed(const System& system, double begin, double end);
  bool fits(const System& system) const override;
  void start(const Assembler& assembler, const EvaluatedState& point) override;
  void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) override;
  bool needs_acceleration() const override { return false; }
  bool looks_inside(const EvaluatedState& from, const EvaluatedState& to,
                    const double* beyond_cubic) override;

  /// One each part; none before a step has been seen.
  std::vector<PartSpeed> parts() const;

 private:
  struct Part {
    int node = 0;
    double ratio = 1.0, deviation = 0.0, sum = 0.0;  ///< rad
  };
  const System& system_;
  double begin_, end_, angle_ = 0.0, angle_sum_ = 0.0, weights_ = 0.0;
  std::vector<Part> parts_;
};

}  // namespace drev
