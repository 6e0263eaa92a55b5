#include <drev/core/control/controllers.hpp>
#include <drev/core/error.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/modes/modes.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

#include "solvers/linear/complex_stiffnesses.hpp"
#include "solvers/linear/huge_pages.hpp"
#include "solvers/modes/modal_problem.hpp"
#include "solvers/modes/own_frequency.hpp"
#include "solvers/modes/tied_system.hpp"

namespace drev {

namespace {

constexpr double kSameFrequency = 1e-8;  // relative, of lambda: copies of one mode
constexpr double kClusterEnd = 1e-5;     // the same: a count behind it meets no tiny pivots
constexpr double kLargestError = 0.1;    // of a frequency: beyond, modes may be missing or of another number

int modes_wanted(const System& system, const ModesOptions& options, int elastic) {
  const std::string place = system.name() + "/modes";
  std::vector<Finding> findings;
  ParameterCheck check(place, findings);
  const int count = options.count.value_or(std::min(10, elastic));
  if (options.count && *options.count < 1)
    check.fail("count", std::to_string(count), "", "must be >= 1");
  else if (count > elastic)
    check.fail("count", std::to_string(count), "",
               "must not exceed the number of elastic modes, which is " + std::to_string(elastic));
  if (options.dense_limit < 0)
    check.fail("dense_limit", std::to_string(options.dense_limit), "", "must be >= 0");
  if (!findings.empty()) throw ModelError(findings);
  return count;
}

[[noreturn]] void refuse_spread(const System& system, const std::string& what, double lambda, double error) {
  throw SolverError("modes of " + system.name() + ": " + what + " omega^2 = " + to_text(lambda) +
                    " (rad/s)^2, where rounding of the stiffest parts leaves an error of up to " +
                    to_text(error) +
                    ": stiffnesses over inertias spread too widely; tie the stiffest parts together ideally");
}

void check_rigid(const System& system, Contact contact, const ModalProblem& problem,
                 const ModalPairs& pairs) {
  const std::vector<std::string> parts = system.floating_parts(contact);
  const int expected = static_cast<int>(parts.size());
  int found = 0, lost = 0;  // may store no energy; so little that rounding hides it
  for (int j = 0; j < pairs.count(); ++j) {
    lost += std::abs(pairs.lambda[j]) <= pairs.error[j];
    if (pairs.rigid[idx(j)])
      ++found;
    else if (pairs.lambda[j] < -pairs.error[j])
      throw SolverError("modes of " + system.name() + ": omega^2 = " + to_text(pairs.lambda[j]) +
                        " (rad/s)^2 < 0 at " + problem.largest_entry(pairs.vectors.col(j)) +
                        ": statically unstable, an element has negative stiffness there");
  }
  if (found >= expected && lost <= expected) return;
  if (found > expected) found = lost;
  if (found < expected && pairs.lambda[expected - 1] <= problem.hidden())
    refuse_spread(system, "a part free to turn seems to have", pairs.lambda[expected - 1], problem.hidden());
  std::string names;
  for (const std::string& part : parts) names += (names.empty() ? "" : ", ") + part;
  throw SolverError(
      "modes of " + system.name() + ": " + std::to_string(found) +
      " modes store no elastic energy, but the model has " + std::to_string(expected) +
      " parts free to turn" + (names.empty() ? "" : " (with node " + names + ")") +
      (found > expected
           ? ": an element that should connect has stiffness 0 in this contact state, "
             "or one too small beside the others"
           : ": an element ties a part to ground without saying so in its speed_ratio_constraints"));
}

/// First index beyond the modes [0, total) that lies above the one before it by more than `apart`,
/// relatively; -1 if unknown yet.
int next_distinct(const Vector& lambda, int total, double apart = kSameFrequency) {
  for (int j = total; j < lambda.size(); ++j)
    if (lambda[j] > lambda[j - 1] * (1.0 + apart)) return j;
  return -1;
}

/// Compares a Sturm count between pairs[cut - 1] and pairs[cut] with cut; returns the surplus of
/// the count, nullopt where tiny pivots make it worth nothing.
std::optional<int> sturm_surplus(ModalProblem& problem, const Vector& lambda, int cut,
                                 ModesSummary& summary) {
  for (const double fraction : {0.5, 0.382, 0.618, 0.236, 0.764}) {
    const double s = lambda[cut - 1] + fraction * (lambda[cut] - lambda[cut - 1]);
    const SturmCount count = problem.sturm().count_below(s);
    ++summary.factorizations;
    if (!count.trusted) continue;
    summary.sturm_point = s;
    summary.sturm_count = count.below;
    return count.below - cut;
  }
  return std::nullopt;
}

void fill(const System& system, const ModalProblem& problem, ModalPairs& pairs, int first, int count,
          ModeSet& modes) {
  modes.summary.largest_residual = problem.check_residuals(pairs, first, count);
  modes.rigid_vectors = pairs.vectors.leftCols(first);
  modes.vectors = std::move(pairs.vectors);
  for (int j = 0; first > 0 && j < count; ++j) modes.vectors.col(j) = modes.vectors.col(first + j);
  modes.vectors.conservativeResize(Eigen::NoChange, count);
  modes.shapes.resize(system.node_count(), count);
  prefer_huge_pages(modes.shapes);
  for (int j = 0; j < count; ++j) {
    auto vector = modes.vectors.col(j);
    auto shape = modes.shapes.col(j);
    double largest = 0.0;
    for (int i = 0; i < system.node_count(); ++i) {
      const NodeMap& map = system.node_map(i);
      shape[i] = map.unknown >= 0 ? map.coeff * vector[map.unknown]
                 : map.row >= 0   ? map.coeff * system.rows().row(map.row).dot(vector)
                                  : 0.0;
      largest = std::max(largest, std::abs(shape[i]));
    }
    // The first of the largest entries (ties within rounding) decides the sign.
    Eigen::Index decides = 0;
    while (!(std::abs(shape[decides]) > largest * (1.0 - 1e-6))) ++decides;
    if (shape[decides] < 0.0) shape *= -1.0, vector *= -1.0;
    const double lambda = pairs.lambda[first + j];
    if (!(pairs.error[first + j] <= 2.0 * kLargestError * lambda))
      refuse_spread(system, "mode " + std::to_string(j + 1) + " has", lambda, pairs.error[first + j]);
    modes.frequency_Hz.push_back(to_hz(std::sqrt(lambda)));
    modes.error_Hz.push_back(
        to_hz(std::sqrt(lambda) - std::sqrt(std::max(0.0, lambda - pairs.error[first + j]))));
  }
}

}  // namespace

const char* to_text(ModesMethod method) {
  return method == ModesMethod::dense ? "dense" : "shift-invert Lanczos";
}

std::string ModesSummary::brief() const {
  return std::string(to_text(method)) + ", shift " + to_text(shift) + " (rad/s)^2, " +
         (sturm_point > 0.0 ? std::to_string(sturm_count) + " modes below " +
                                  to_text(to_hz(std::sqrt(sturm_point))) + " Hz by Sturm count"
                            : std::string("all modes computed")) +
         ", " + std::to_string(solves) + " solves";
}

double ModeSet::omega(int mode) const { return hz(frequency_Hz[idx(mode)]); }

ModeSet solve_modes(const System& system, const ModesOptions& options) {
  refuse_controllers(system, "the solution for modes");
  if (const auto tied = tied_system(system)) {
    ModeSet modes = solve_modes(tied->system, options);
    modes.vectors = tied->basis * modes.vectors;
    if (modes.rigid_vectors.size() > 0) modes.rigid_vectors = tied->basis * modes.rigid_vectors;
    return modes;
  }
  if (!options.in_time && !system.frequency_terms().empty()) return modes_at_own_frequency(system, options);
  const int n = system.size();
  ModeSet modes;
  modes.contact = options.contact;
  modes.rigid_modes = system.rigid_mode_count(options.contact);
  const int wanted = modes_wanted(system, options, n - modes.rigid_modes);
  if (wanted == 0) {
    modes.shapes.resize(system.node_count(), 0);
    modes.vectors.resize(n, 0);
    return modes;
  }
  const int total = modes.rigid_modes + wanted;
  ModesSummary& summary = modes.summary;

  ModalProblem problem(system, options.contact, summary);
  const bool prefer_dense = n <= options.dense_limit;
  constexpr int kRounds = 12;
  int ask = std::min(n, total + 1);
  problem.find_shift(modes.rigid_modes, ask, prefer_dense);
  for (int round = 0; round < kRounds; ++round) {
    ModalPairs pairs = problem.lowest(ask, round, prefer_dense);
    check_rigid(system, options.contact, problem, pairs);
    const int next = next_distinct(pairs.lambda, total);
    int cut = next, surplus = 0;
    while (cut >= 0) {
      if (const auto counted = sturm_surplus(problem, pairs.lambda, cut, summary)) {
        surplus = *counted;
        break;
      }
      cut = next_distinct(pairs.lambda, cut + 1, kClusterEnd);  // behind the cluster that it was inside of
    }
    if (surplus < 0 || (surplus > 0 && pairs.count() == n))
      throw SolverError("modes of " + system.name() + ": " + std::to_string(cut) + " modes found below " +
                        to_text(summary.sturm_point) + " (rad/s)^2, but the Sturm count is " +
                        std::to_string(summary.sturm_count) +
                        ": the matrices are too badly scaled to separate modes there");
    if (surplus == 0 && (cut >= 0 || pairs.count() == n)) {
      summary.copies_not_returned = (next < 0 ? n : next) - total;
      fill(system, problem, pairs, modes.rigid_modes, wanted, modes);
      return modes;
    }
    ++summary.widened;
    int more = surplus + 1;
    if (cut < 0) {  // copies of the last mode, or its cluster, up to the end: how many says the count
      const SturmCount count =
          problem.sturm().count_below(pairs.lambda[pairs.count() - 1] * (1.0 + kClusterEnd));
      ++summary.factorizations;
      more = std::max(count.trusted ? count.below + 1 - ask : 0, 1 + ask / 4);
    }
    ask = std::min(n, ask + more);
  }
  throw SolverError("modes of " + system.name() + ": modes found and Sturm count did not agree after " +
                    std::to_string(kRounds) + " rounds");
}

int elastic_mode_count(const System& system, Contact contact) {
  if (const auto tied = tied_system(system)) return elastic_mode_count(tied->system, contact);
  const ComplexStiffnesses stiffnesses(system);
  const auto held = std::count(stiffnesses.held().begin(), stiffnesses.held().end(), true);
  return system.size() - static_cast<int>(held) - system.rigid_mode_count(contact);
}

}  // namespace drev
