#include <drev/core/element.hpp>
#include <drev/elements/applied_torque.hpp>
#include <drev/elements/cam_torque.hpp>
#include <drev/elements/engine_order_torque.hpp>

#include <complex>
#include <limits>
#include <map>

namespace drev {

namespace {

/// One harmonic of each order, sum_i A_i exp(i phase_i). Where these cancel but for rounding there is none: exact
/// propagation would resolve what is left of them.
std::vector<Harmonic> combined(const std::vector<Harmonic>& harmonics) {
  struct Sum {
    std::complex<double> phasor = 0.0;
    double size = 0.0;
    const Harmonic* only = nullptr;
  };
  std::map<double, Sum> sums;
  for (const Harmonic& h : harmonics) {
    Sum& sum = sums[h.order];
    sum.only = sum.size > 0.0 ? nullptr : &h;
    sum.phasor += std::polar(1.0, h.phase) * h.amplitude;
    sum.size += std::abs(h.amplitude) * std::max(1.0, std::abs(h.phase));
  }
  std::vector<Harmonic> all;
  for (const auto& [order, sum] : sums)
    if (sum.only != nullptr)
      all.push_back(*sum.only);
    else if (std::abs(sum.phasor) > 4.0 * std::numeric_limits<double>::epsilon() * sum.size)
      all.push_back({order, std::abs(sum.phasor), std::arg(sum.phasor)});
  return all;
}

}  // namespace

AppliedTorque::AppliedTorque(Params params) : params_(std::move(params)), sum_(combined(params_.harmonics)) {}

void AppliedTorque::check(ParameterCheck& check) const {
  const int given =
      int(bool(params_.torque)) + int(params_.table.has_value()) + int(!params_.harmonics.empty());
  if (given != 1)
    check.fail("torque", given == 0 ? "nothing" : "several", "",
               "exactly one of torque, table and harmonics must be given");
  check.all_finite("breakpoints", params_.breakpoints, "s");
  if (params_.table) params_.table->check(check, "table", "N m");
  check_harmonics(check, "harmonics", params_.harmonics, "N m", false, "frequency", "Hz");
}

void AppliedTorque::describe(int /*nodes*/, Terms& terms) const { terms.loads.push_back({0, this}); }

void CamTorque::check(ParameterCheck& check) const {
  curve_.check(check, "angle_table", "rad", "N m");
  check.finite("phase", params_.phase, "rad");
  check.finite("scale", params_.scale, "");
}

void CamTorque::describe(int /*nodes*/, Terms& terms) const { terms.loads.push_back({0, this}); }

void EngineOrderTorque::check(ParameterCheck& check) const {
  check.finite("mean", params_.mean, "N m");
  check_harmonics(check, "harmonics", params_.harmonics, "N m", false);
}

void EngineOrderTorque::describe(int /*nodes*/, Terms& terms) const { terms.loads.push_back({0, this}); }

}  // namespace drev
