// Modes and damped modes against eigenvalues in extended precision: Jacobi's method, and the QR algorithm on
// the companion matrix of lambda^2 M + lambda C + K.
#include <drev/core/error.hpp>
#include <drev/solvers/modes/damped_modes.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "tests/stability/coverage/cover.hpp"
#include "tests/stability/coverage/linear_model.hpp"
#include "tests/stability/coverage/to_drev.hpp"

namespace coverage {

namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();
constexpr double kCritical = 1e-3;  // of |lambda|: closer to another one it has half the digits
constexpr double kSlow = 1e-6;      // of the largest |lambda|: beside the double zero of a free part
constexpr Real kRigid = 1e-14L;     // of the largest omega^2

void cover_undamped(const LinearModel& linear, const drev::System& system, const std::string& where,
                    Table& table) {
  std::vector<Real> squares = symmetric_eigenvalues(linear);
  std::sort(squares.begin(), squares.end());
  std::size_t rigid = 0;
  while (rigid < squares.size() && squares[rigid] < kRigid * squares.back()) ++rigid;
  const int elastic = static_cast<int>(squares.size() - rigid);
  if (elastic == 0) return;
  const drev::ModeSet modes = drev::solve_modes(system, {.count = elastic});
  table.add_claim("modes: number of rigid ones", where, static_cast<std::size_t>(modes.rigid_modes) == rigid);
  table.add_claim("modes: number of elastic ones", where, modes.count() == elastic);
  for (std::size_t i = 0; i + rigid < squares.size() && i < modes.frequency_Hz.size(); ++i) {
    const Real square = squares[i + rigid];
    const double truth = static_cast<double>(std::sqrt(square) / kTurn);
    // solvers/modes/modes.hpp, "Accuracy": eps lambda_max/(2 lambda), and rounding of the solution beside it.
    const double stated =
        2.0 * kEps * static_cast<double>(squares.back() / square) * truth + 4.0 * kEps * truth;
    table.add("modes: frequency",
              {where + " mode " + std::to_string(i), modes.frequency_Hz[i], stated, truth, 1e-17 * truth});
  }
}

void cover_damped(const LinearModel& linear, const drev::System& system, const std::string& where,
                  Table& table) {
  const std::vector<std::complex<Real>> truth = quadratic_eigenvalues(linear);
  Real largest = 0;
  for (const auto& l : truth) largest = std::max(largest, std::abs(l));
  const drev::DampedModeSet modes = drev::solve_damped_modes(system);
  std::vector<std::complex<double>> found;
  for (const drev::DampedMode& m : modes.modes)
    found.push_back(m.lambda), found.push_back(std::conj(m.lambda));
  for (const double real : modes.real_lambda) found.emplace_back(real, 0.0);
  table.add_claim("damped modes: number", where,
                  found.size() + static_cast<std::size_t>(modes.rigid_modes) == truth.size());
  for (const auto& l : found) {
    const std::complex<Real> here(l.real(), l.imag());
    std::vector<Real> distance;
    for (const auto& t : truth) distance.push_back(std::abs(t - here));
    std::nth_element(distance.begin(), distance.begin() + 1, distance.end());
    const double nearest = static_cast<double>(distance[0]);
    const bool critical = distance[1] < kCritical * std::abs(here) || std::abs(here) < kSlow * largest;
    // solvers/modes/damped_modes.hpp, "Accuracy": about eps w_0, half the digits at a double lambda.
    const double stated = (critical ? std::sqrt(kEps) : 32.0 * kEps) * static_cast<double>(largest);
    table.add("damped modes: lambda",
              {where + " lambda " + std::to_string(l.real()) + " " + std::to_string(l.imag()), nearest,
               stated, 0.0, 1e-17 * static_cast<double>(largest)});
  }
}

}  // namespace

void cover_modes(const Spec& spec, Table& table) {
  const std::string where = spec.name + " (" + spec.family + ")";
  try {
    const drev::System system = to_drev(spec);
    const LinearModel linear(spec);
    cover_undamped(linear, system, where, table);
    cover_damped(linear, system, where, table);
  } catch (const drev::SolverError& e) {
    table.add_claim("modes: found", where + " " + e.what(), false);
  }
}

}  // namespace coverage
