#include "solvers/run/mean_speed.hpp"

#include <drev/core/assembler.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/run/evaluated_state.hpp>

#include <cmath>

namespace drev {

// Of the window: over shorter steps its weight at their middle is that of the whole step.
static constexpr double kShortStep = 1e-3;

MeanSpeed::MeanSpeed(const System& system, double begin, double end)
    : system_(system), begin_(begin), end_(end) {
  for (const std::string& name : system.floating_parts(Contact::closed)) {
    const int node = system.node(name);
    if (system.ratio(node) != 0.0) parts_.push_back({.node = node, .ratio = system.ratio(node)});
  }
}

bool MeanSpeed::fits(const System& system) const { return system.layout() == system_.layout(); }

void MeanSpeed::start(const Assembler& assembler, const EvaluatedState& point) {
  angle_ = assembler.nominal().value;
  angle_sum_ = weights_ = 0.0;
  for (Part& part : parts_) {
    part.deviation = assembler.node_motion(part.node, point.state).value;
    part.sum = 0.0;
  }
}

bool MeanSpeed::looks_inside(const EvaluatedState& from, const EvaluatedState& to, const double*) {
  return !parts_.empty() && to.state.t - from.state.t > kShortStep * (end_ - begin_);
}

void MeanSpeed::step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) {
  if (parts_.empty()) return;
  const double middle = 0.5 * (from.state.t + to.state.t);
  const double root = std::sin(0.5 * kTwoPi * (middle - begin_) / (end_ - begin_));
  const double weight = root * root, angle = assembler.nominal().value;
  weights_ += weight * (to.state.t - from.state.t);
  angle_sum_ += weight * (angle - angle_);
  angle_ = angle;
  for (Part& part : parts_) {
    const double deviation = assembler.node_motion(part.node, to.state).value;
    part.sum += weight * (deviation - part.deviation);
    part.deviation = deviation;
  }
}

std::vector<PartSpeed> MeanSpeed::parts() const {
  std::vector<PartSpeed> all;
  if (!(weights_ > 0.0)) return all;
  for (const Part& part : parts_) {
    const double nominal = angle_sum_ / weights_;
    all.push_back({system_.node_names()[static_cast<std::size_t>(part.node)], nominal,
                   nominal + part.sum / (weights_ * part.ratio)});
  }
  return all;
}

}  // namespace drev
