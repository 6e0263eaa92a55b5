#include <drev/core/assembler.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/modes/damped_modes.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/dense/factorization.hpp"

namespace drev {

namespace {

constexpr int kMostUnknownsToGrow = 400;  // 4 s
constexpr double kGrows = 1e-6;           // Re lambda over |lambda| from which a mode grows
constexpr double kRealGrows = 1e-9;  // real lambda over the largest |lambda| from which it is no rounding
constexpr double kNoDamping = 1e-9;  // negative damping beside a node's own that is rounding

/// Whether K and C take energy or keep it: both symmetric, C positive semidefinite (C with its diagonal raised is definite).
bool is_passive(const System& system, const Vector& damping) {
  const Assembler assembler(system);
  Vector values;
  const auto matrix = [&](const Weights& weights) {
    assembler.contact_values(weights, Contact::closed, values);
    if (damping.size() > 0) values += weights.c * damping;
    SparseMatrix a = system.pattern();
    std::copy(values.begin(), values.end(), a.valuePtr());
    return Eigen::MatrixXd(a);
  };
  const auto is_symmetric = [](const Eigen::MatrixXd& a) {
    return ((a - a.transpose()).array().abs() <= kNoDamping * (a.array().abs() + a.transpose().array().abs()))
        .all();
  };
  Eigen::MatrixXd c = matrix({0.0, 1.0, 0.0});
  if (!is_symmetric(c) || !is_symmetric(matrix({0.0, 0.0, 1.0}))) return false;
  for (Eigen::Index i = 0; i < c.rows(); ++i)
    c(i, i) = c.row(i).isZero(0.0) ? 1.0 : (1.0 + kNoDamping) * c(i, i);
  return CholeskyFactor(c).positive_definite();
}

}  // namespace

void Growth::note(std::complex<double> lambda) {
  if (!(lambda.real() > rate) || !(lambda.real() > kGrows * std::abs(lambda))) return;
  rate = lambda.real();
  frequency_Hz = to_hz(lambda.imag());
}

std::string Growth::text() const {
  std::ostringstream text;
  text.precision(4);
  text << "a mode ";
  if (frequency_Hz > 0.0)
    text << "at " << frequency_Hz << " Hz";
  else
    text << "that does not swing";
  text << " grows at " << rate << " 1/s (Re lambda)";
  return text.str();
}

Growth fastest_growth(const System& system, const DampedModeSet& modes) {
  Growth growth;
  double fastest = 0.0;
  for (const DampedMode& mode : modes.modes) {
    growth.note(mode.lambda);
    fastest = std::max(fastest, std::abs(mode.lambda));
  }
  for (const double lambda : modes.real_lambda) fastest = std::max(fastest, std::abs(lambda));
  if (!system.floating_parts(modes.contact).empty()) return growth;
  for (const double lambda : modes.real_lambda)
    if (lambda > kRealGrows * fastest) growth.note(lambda);
  return growth;
}

Growth find_growth(const System& system, const Vector& damping) {
  if (system.size() > kMostUnknownsToGrow || is_passive(system, damping)) return {};
  return fastest_growth(system, solve_damped_modes(system, {.damping = damping, .in_time = true}));
}

}  // namespace drev
