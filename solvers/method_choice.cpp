#include <drev/core/assembler.hpp>
#include <drev/core/error.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>
#include <drev/solvers/method.hpp>
#include <drev/solvers/modes/modes.hpp>
#include <drev/solvers/stepping/step_scheme.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "solvers/linear/extreme_eigenvalue.hpp"
#include "solvers/linear/sparse_cholesky.hpp"
#include "solvers/method_costs.hpp"

namespace drev {

namespace {

constexpr int kPowerSteps = 20;
constexpr double kRipple = 0.3;         // amplitude of the ripple that the power iteration starts from
constexpr double kRateTimesStep = 3.0;  // omega h of exact propagation, and where dormand_prince is stable
constexpr double kMostWork = 1.5e10;    // products times the cost of one: half a minute

/// Size of the largest eigenvalue of M^-1 A, A on the system's pattern.
double largest_of(const Assembler& assembler, SparseCholesky& mass, const Vector& values) {
  Vector ax(assembler.system().size());
  const auto product = [&](const Vector& x, Vector& y) {
    assembler.multiply(values, x, ax);
    mass.solve(ax, y);
  };
  return extreme_eigenvalue(ax.size(), product, {.steps = kPowerSteps, .ripple = kRipple});
}

const char* kind_of(const System& system) {
  bool linear = !system.loads_depend_on_motion(), pieces = true;
  for (const ScalarTerm& s : system.scalars()) {
    linear &= linear_pieces(s).size() == 1;
    pieces &= !linear_pieces(s).empty();
  }
  return linear ? "linear" : pieces ? "piecewise linear" : "smooth between contact changes";
}

std::string counted(long n, const std::string& thing) {
  return std::to_string(n) + " " + thing + (n == 1 ? "" : "s");
}

}  // namespace

long contact_count(const System& system) {
  return std::count_if(system.scalars().begin(), system.scalars().end(),
                       [](const ScalarTerm& s) { return s.force->gap() || s.force->pieces().size() > 1; });
}

double fastest_rate(const System& system) {
  if (system.size() == 0) return 0.0;
  const Assembler assembler(system);
  SparseCholesky mass(system.pattern());
  if (const FactorStatus status = mass.factorize(system.pattern(), system.mass_values());
      status != FactorStatus::success)
    throw SolverError(system.name() + ": the mass matrix: " + to_text(status));
  Vector values;
  const auto largest = [&](const auto& fill) {
    fill(Weights{.k = 1.0});
    const double elastic = std::sqrt(largest_of(assembler, mass, values));
    fill(Weights{.c = 1.0});
    return std::max(elastic, largest_of(assembler, mass, values));
  };
  double rate = largest([&](const Weights& w) { assembler.contact_values(w, Contact::closed, values); });
  if (!system.generals().empty()) {
    const State start = State::initial(system);
    rate = std::max(rate, largest([&](const Weights& w) {
                      assembler.tangent_values(w, start.z, start.v, start.history, false, values);
                    }));
  }
  return rate;
}

double least_steps(const System& system, const Method& method, double duration) {
  if (method.step > 0.0 && !method.controlled()) return duration / method.step;
  try {
    double rate = 0.0;
    if (method.exact() || step_scheme(method.name).is_explicit()) {
      rate = fastest_rate(system);
    } else if (const ModeSet slowest = solve_modes(system, {.in_time = true}); slowest.count() > 0) {
      rate = slowest.omega(0);
    }
    return rate * duration / kRateTimesStep;
  } catch (const SolverError&) {
    return 0.0;
  }
}

MethodChoice choose_method(const System& system, double duration, double step) {
  const Method constant{.step = step};
  const std::optional<std::string> why_not = why_not_exact(system);
  const std::string refused = why_not ? "exact propagation cannot be used: " + *why_not : "";
  if (!system.frictions().empty()) {
    if (why_not)
      throw ModelError(
          {{system.name(), "method", "", "", "dry friction needs exact propagation, but " + *why_not}});
    return {{.name = kExact, .tolerance = ExactOptions{}.tolerance},
            "the model has dry friction, whose sticking only exact propagation locates"};
  }
  if (system.history_size() > 0)
    return {constant, refused + "; no estimate of an error sees a history: constant steps"};
  double rate = 0.0;
  try {
    rate = fastest_rate(system);
  } catch (const SolverError& error) {
    return {constant, std::string("exact propagation cannot be used: ") + error.what()};
  }
  const long contacts = contact_count(system);
  const double steps = std::max(1.0, rate * duration / kRateTimesStep);
  const double cost = kUnknownsOfStep + system.size() + kUnknownsOfContact * static_cast<double>(contacts);
  const auto work = [&](double products_in_step) { return steps * products_in_step * cost; };
  if (why_not) {
    if (work(kProductsOfStages) <= kMostWork)
      return {{.name = "dormand_prince", .tolerance = kControlledTolerance},
              refused + "; steps controlled by their error"};
    std::ostringstream text;
    text.precision(2);
    text << refused << "; its fastest mode, " << to_hz(rate) << " Hz, would cost explicit methods " << steps
         << " steps; controlled steps of an implicit method";
    return {{.name = "sdirk4", .tolerance = kControlledTolerance}, text.str()};
  }
  const std::string model = "the model is " + std::string(kind_of(system)) + ", with " +
                            counted(system.size(), "unknown") + " and " + counted(contacts, "contact");
  return {{.name = kExact, .tolerance = ExactOptions{}.tolerance},
          model + ": exact between located changes",
          work(kProductsInStep)};
}

}  // namespace drev
