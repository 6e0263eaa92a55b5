#include "solvers/stepping/coarse_steps.hpp"

#include <drev/core/error.hpp>
#include <drev/core/units.hpp>

#include <cmath>
#include <sstream>

#include "solvers/stepping/step_polynomial.hpp"

namespace drev {

namespace {

constexpr long kOfEach = 32;           // steps looked at before only every other one of them is
constexpr double kFewestSteps = 14.0;  // a period
const double kMotion = kTwoPi / kFewestSteps;
const double kLoads = kMotion * kMotion / 12.0;

}  // namespace

CoarseSteps::CoarseSteps(const System& system) : mass_(system.size()) {
  for (int i = 0; i < system.size(); ++i) mass_[i] = system.mass_values()[system.diagonal_slots()[idx(i)]];
}

void CoarseSteps::look(Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to, double h) {
  const double share = static_cast<double>(stride_) * h;
  if (++taken_ % kOfEach == 0) stride_ *= 2;
  change_ += share * (to.state.a - from.state.a).cwiseAbs2().dot(mass_);
  size_ += 0.5 * share * (to.state.a.cwiseAbs2() + from.state.a.cwiseAbs2()).dot(mass_);

  const double far = std::sqrt(0.15);
  off_.setZero(mass_.size());
  largest_ = from.p.cwiseAbs().cwiseMax(to.p.cwiseAbs());
  const StepPolynomial motion(from.state, to.state, h, 3);
  for (const auto& [s, weight] : {std::pair{0.5 - far, 5.0 / 18}, {0.5, 8.0 / 18}, {0.5 + far, 5.0 / 18}}) {
    motion.at(s, inside_.state);
    assembler.set_time(inside_.state.t);
    assembler.external(inside_.state.z, inside_.state.v, inside_.p);
    off_ += weight * (inside_.p - (1.0 - s) * from.p - s * to.p).cwiseAbs();
    largest_ = largest_.cwiseMax(inside_.p.cwiseAbs());
  }
  load_off_ += share * std::sqrt((off_.array().square() / mass_.array()).sum());
  load_size_ += share * std::sqrt((largest_.array().square() / mass_.array()).sum());
}

void CoarseSteps::warn(RunSummary& summary, double step) const {
  const auto add = [&](const std::string& what, double per_period) {
    std::ostringstream text;
    text.precision(2);
    text << "the step, " << to_text(step) << " s, is too long for " << what << ": about " << per_period
         << " steps a period, fewer than " << kFewestSteps << "; take a shorter step, or ask for a tolerance";
    summary.warnings.push_back(text.str());
  };
  if (load_off_ > kLoads * load_size_)
    add("what acts on the model, which changes between the steps",
        kTwoPi / std::sqrt(12.0 * load_off_ / load_size_));
  if (change_ > kMotion * kMotion * size_)
    add("the vibration that carries the motion", kTwoPi / std::sqrt(change_ / size_));
}

}  // namespace drev
