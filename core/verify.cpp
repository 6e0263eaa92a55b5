#include <drev/core/element.hpp>
#include <drev/core/general_force.hpp>
#include <drev/core/verify.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <random>

#include "core/contradictions.hpp"
#include "core/dense/eigenvalues.hpp"
#include "core/dense/factorization.hpp"

namespace drev {

namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();
// Steps of the argument: the shorter suits curved laws, the longer those that lose digits inside.
constexpr double kSteps[] = {1e-6, 1e-4};
constexpr double kRoundOff = 16.0;  // units in the last place allowed in a difference
constexpr double kDecades = 6.0;
constexpr double kLeastArgument = 1e-6;  // about zero, steps are taken of this
constexpr int kShown = 3;                // failures of a kind that are listed

/// Collects failures, a few of each kind.
class Findings {
 public:
  explicit Findings(CheckReport& report) : report_(report) {}
  void add(const std::string& kind, const std::string& detail) {
    const int n = ++count_[kind];
    if (n <= kShown) report_.failures.push_back(place_ + kind + ": " + detail);
  }
  /// Which law or load of several is looked at.
  void set_place(std::string place) { place_ = std::move(place); }
  void require(bool good, const std::string& kind, const std::string& detail) {
    if (!good) add(kind, detail);
  }

 private:
  CheckReport& report_;
  std::string place_;
  std::map<std::string, int> count_;
};

/// Random numbers that are the same on every platform (std distributions are not).
class Draw {
 public:
  explicit Draw(unsigned seed) : engine_(seed) {}
  double unit() { return static_cast<double>(engine_()) / 4294967296.0; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  /// Either sign, evenly over the decades below `largest`.
  double magnitude(double largest) {
    const double value = largest * std::pow(10.0, -kDecades * unit());
    return unit() < 0.5 ? -value : value;
  }

 private:
  std::mt19937 engine_;
};

/// Slope of f at x by differences, and how far it can be trusted.
struct Difference {
  double slope = 0.0, doubt = 0.0;
};

Difference difference(const std::function<double(double)>& f, double x, double step, double tolerance) {
  const double h = step * std::max(std::abs(x), kLeastArgument);
  const double high = x + h, low = x - h;
  const double at = f(x), up = f(high), down = f(low);
  const double right = (up - at) / (high - x), left = (at - down) / (x - low);
  const double size = std::max(std::abs(right), std::abs(left));
  const double biggest = std::max({std::abs(at), std::abs(up), std::abs(down)});
  return {(up - down) / (high - low),
          std::abs(right - left) + tolerance * size + kRoundOff * kEps * biggest / h};
}

/// Does a returned slope agree with the differences over either step?
struct SlopeCheck {
  bool good = false;
  double expected = 0.0;
};

SlopeCheck check_slope(const std::function<double(double)>& f, double x, double returned, double tolerance,
                       double more_doubt = 0.0) {
  SlopeCheck check;
  for (const double step : kSteps) {
    const Difference d = difference(f, x, step, tolerance);
    const double rounding = more_doubt / (step * std::max(std::abs(x), kLeastArgument));
    if (std::abs(returned - d.slope) <= d.doubt + rounding) check.good = true;
    check.expected = d.slope;
  }
  return check;
}

std::string compare_text(const char* what, double returned, double expected, const std::string& where) {
  return std::string(what) + " = " + to_text(returned) + ", differences give " + to_text(expected) + " at " +
         where;
}

template <class T>
bool same_bits(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}

bool finite(const ScalarResponse& r) {
  return std::isfinite(r.y) && std::isfinite(r.dy_dx) && std::isfinite(r.dy_dx_dot) &&
         std::isfinite(r.dy_dangle) && std::isfinite(r.stored_energy) && std::isfinite(r.dissipated_power);
}

std::string place(const ScalarInput& in) {
  return "x = " + to_text(in.x) + ", x_dot = " + to_text(in.x_dot) + ", t = " + to_text(in.t) +
         ", angle = " + to_text(in.angle);
}

double draw_deflection(Draw& draw, std::span<const double> kinks, double largest) {
  if (kinks.empty() || draw.unit() < 0.5) return draw.magnitude(largest);
  const auto count = static_cast<double>(kinks.size());
  const double kink = kinks[std::min(static_cast<std::size_t>(count * draw.unit()), kinks.size() - 1)];
  const double reach = std::max(std::abs(kink), kinks.back() - kinks.front());
  return kink + draw.magnitude(reach > 0.0 ? 2.0 * reach : largest);
}

void check_law_slopes(const ScalarForce& law, const ScalarInput& in, bool phased, const CheckOptions& o,
                      Findings& out) {
  const ScalarResponse r = law.evaluate(in);
  const auto y_of = [&](double ScalarInput::*argument) {
    return [&law, in, argument](double value) {
      ScalarInput moved = in;
      moved.*argument = value;
      return law.evaluate(moved).y;
    };
  };
  const auto slope = [&](const char* name, double returned, double ScalarInput::*argument) {
    const SlopeCheck d = check_slope(y_of(argument), in.*argument, returned, o.tolerance);
    out.require(d.good, "wrong tangent", compare_text(name, returned, d.expected, place(in)));
  };
  slope("dy_dx", r.dy_dx, &ScalarInput::x);
  slope("dy_dx_dot", r.dy_dx_dot, &ScalarInput::x_dot);
  if (phased) slope("dy_dangle", r.dy_dangle, &ScalarInput::angle);
}

void check_law_energy(const ScalarForce& law, const ScalarInput& in, const CheckOptions& o, Findings& out) {
  const ScalarResponse r = law.evaluate(in);
  ScalarInput rest = in;
  rest.x_dot = 0.0;
  const double elastic = law.evaluate(rest).y;
  const auto energy = [&law, rest](double x) {
    ScalarInput moved = rest;
    moved.x = x;
    return law.evaluate(moved).stored_energy;
  };
  const SlopeCheck d = check_slope(energy, in.x, elastic, o.tolerance);
  out.require(d.good, "energy does not match the force",
              compare_text("y at x_dot = 0", elastic, d.expected, place(in)) + " (dV/dx)");
  out.require(r.stored_energy >= 0.0, "negative stored energy",
              to_text(r.stored_energy) + " J at " + place(in));

  const double power = (r.y - elastic) * in.x_dot;
  const double size = (std::abs(r.y) + std::abs(elastic)) * std::abs(in.x_dot);
  out.require(r.dissipated_power >= -kRoundOff * kEps * size, "negative dissipated power",
              to_text(r.dissipated_power) + " W at " + place(in));
  out.require(power >= -kRoundOff * kEps * size, "active damper",
              "(y - y at rest) x_dot = " + to_text(power) + " W at " + place(in));
  out.require(std::abs(r.dissipated_power - power) <= o.tolerance * std::abs(power) + kRoundOff * kEps * size,
              "dissipated power does not match the force",
              to_text(r.dissipated_power) + " W, but (y - y at rest) x_dot = " + to_text(power) + " W at " +
                  place(in));
}

void check_law(const ScalarSpec& spec, const CheckOptions& o, Draw& draw, Findings& out) {
  const ScalarForce& law = *spec.force;
  const bool phased = spec.phase_node >= 0;
  const std::span<const double> kinks = law.kinks();
  out.require(std::is_sorted(kinks.begin(), kinks.end()), "kinks", "must ascend");
  if (const auto gap = law.gap()) out.require(gap->low < gap->high, "gap", "low must be less than high");
  const double k = law.closed_stiffness(), c = law.closed_damping();
  out.require(std::isfinite(k) && k >= 0.0, "closed_stiffness", to_text(k) + ", must be >= 0");
  out.require(std::isfinite(c) && c >= 0.0, "closed_damping", to_text(c) + ", must be >= 0");

  std::vector<std::pair<ScalarInput, ScalarResponse>> seen;
  for (int i = 0; i < o.samples; ++i) {
    const ScalarInput in{.x = draw_deflection(draw, kinks, o.deflection),
                         .x_dot = draw.magnitude(o.rate),
                         .t = draw.between(0.0, o.time),
                         .angle = phased ? draw.between(-o.angle, o.angle) : 0.0};
    const ScalarResponse r = law.evaluate(in);
    if (!finite(r)) {
      out.add("not finite", place(in));
      continue;
    }
    seen.emplace_back(in, r);
    check_law_slopes(law, in, phased, o, out);
    check_law_energy(law, in, o, out);
    ScalarInput later = in;
    later.t += draw.between(0.0, o.time);
    if (phased) later.angle += draw.between(0.0, o.angle);
    if (!law.varies())
      out.require(law.evaluate(later).stored_energy == r.stored_energy, "varies() is false",
                  "but the stored energy follows t or the angle at " + place(in));
    if (phased) {
      const double slope = law.offset(in.angle).de_dangle;
      const SlopeCheck d =
          check_slope([&law](double a) { return law.offset(a).e; }, in.angle, slope, o.tolerance);
      out.require(d.good, "wrong offset slope", compare_text("de_dangle", slope, d.expected, place(in)));
    }
  }
  for (const auto& [in, before] : seen)
    out.require(same_bits(law.evaluate(in), before), "impure",
                "the same input gave another response at " + place(in));
  std::vector<ScalarInput> inputs;
  for (const auto& [in, response] : seen) inputs.push_back(in);
  for (const Contradiction& c : contradictions(law, inputs)) out.add(c.what, c.detail);
}

void check_load(const Load& load, const CheckOptions& o, Draw& draw, Findings& out) {
  std::vector<std::pair<LoadInput, LoadResponse>> seen;
  for (int i = 0; i < o.samples; ++i) {
    const LoadInput in{.t = draw.between(0.0, o.time),
                       .nominal_angle = draw.between(-o.angle, o.angle),
                       .deviation = draw.magnitude(o.deflection),
                       .speed = draw.magnitude(o.rate),
                       .nominal_speed = draw.magnitude(o.rate)};
    const LoadResponse r = load.evaluate(in);
    const std::string where = "t = " + to_text(in.t) + ", angle = " + to_text(in.nominal_angle) + " + " +
                              to_text(in.deviation) + ", speed = " + to_text(in.speed);
    if (!std::isfinite(r.torque) || !std::isfinite(r.dtorque_dangle) || !std::isfinite(r.dtorque_dspeed)) {
      out.add("not finite", where);
      continue;
    }
    seen.emplace_back(in, r);
    const auto slope = [&](const char* name, double returned, double LoadInput::*argument) {
      const auto torque = [&load, in, argument](double value) {
        LoadInput moved = in;
        moved.*argument = value;
        return load.evaluate(moved).torque;
      };
      // The angle is a sum: rounding of the larger part limits the difference too.
      const double rounding = std::abs(returned) * kRoundOff * kEps * o.angle;
      const SlopeCheck d = check_slope(torque, in.*argument, returned, o.tolerance, rounding);
      out.require(d.good, "wrong tangent", compare_text(name, returned, d.expected, where));
    };
    slope("dtorque_dangle", r.dtorque_dangle, &LoadInput::deviation);
    slope("dtorque_dspeed", r.dtorque_dspeed, &LoadInput::speed);
    LoadInput moved = in;
    moved.deviation = draw.magnitude(o.deflection);
    moved.speed = draw.magnitude(o.rate);
    if (!load.depends_on_motion())
      out.require(same_bits(load.evaluate(moved), r) && r.dtorque_dangle == 0.0 && r.dtorque_dspeed == 0.0,
                  "depends_on_motion() is false", "but the torque follows the motion at " + where);
  }
  for (const auto& [in, before] : seen)
    out.require(same_bits(load.evaluate(in), before), "impure",
                "the same input gave another response at t = " + to_text(in.t));
  std::vector<LoadInput> inputs;
  for (const auto& [in, response] : seen) inputs.push_back(in);
  for (const Contradiction& c : contradictions(load, inputs)) out.add(c.what, c.detail);
}

/// One general force with room for its response.
struct GeneralTrial {
  GeneralTrial(const GeneralForce& f, int n)
      : force(f), nodes(n), history(static_cast<std::size_t>(f.history_size()), 0.0) {
    state.q.setZero(n);
    state.v.setZero(n);
    f.initial_history(history);
    state.history = history;
  }
  LocalResponse respond(const LocalState& at) {
    history_new.assign(history.size(), 0.0);
    LocalResponse r;
    r.f.setZero(nodes);
    r.stiffness.setZero(nodes, nodes);
    r.damping.setZero(nodes, nodes);
    r.history = history_new;
    force.evaluate(at, r);
    return r;
  }

  const GeneralForce& force;
  int nodes;
  std::vector<double> history, history_new;
  LocalState state;
};

void check_general(const GeneralForce& force, int nodes, const CheckOptions& o, Draw& draw, Findings& out) {
  if (nodes > kMaxLocalDofs)
    return out.add("general force", "has " + std::to_string(nodes) + " nodes; at most " +
                                        std::to_string(kMaxLocalDofs) + " fit");
  GeneralTrial trial(force, nodes);
  const int samples = std::max(1, o.samples / 10);  // each costs 8 n^2 evaluations
  std::vector<std::pair<LocalState, LocalResponse>> seen;
  std::vector<std::vector<double>> histories;
  for (int i = 0; i < samples; ++i) {
    trial.state.t = draw.between(0.0, o.time);
    for (int a = 0; a < nodes; ++a) {
      trial.state.q[a] = draw.magnitude(o.deflection);
      trial.state.v[a] = draw.magnitude(o.rate);
    }
    const LocalState state = trial.state;
    const LocalResponse r = trial.respond(state);
    const std::string where = "sample " + std::to_string(i);
    if (!r.f.allFinite() || !r.stiffness.allFinite() || !r.damping.allFinite()) {
      out.add("not finite", where);
      continue;
    }
    seen.emplace_back(state, r);
    histories.push_back(trial.history_new);
    out.require(r.stored_energy >= 0.0, "negative stored energy", where);
    out.require(r.dissipated_power >= 0.0, "negative dissipated power", where);
    for (int a = 0; a < nodes; ++a)
      for (int b = 0; b < nodes; ++b) {
        const auto moved = [&](LocalVector LocalState::*part) {
          return [&trial, state, part, a, b](double value) {
            LocalState s = state;
            (s.*part)[b] = value;
            return trial.respond(s).f[a];
          };
        };
        const std::string entry = "(" + std::to_string(a) + "," + std::to_string(b) + "), " + where;
        const auto compare = [&](const char* name, LocalVector LocalState::*part, double at,
                                 double returned) {
          const SlopeCheck d = check_slope(moved(part), at, returned, o.tolerance);
          out.require(d.good, "wrong tangent", compare_text(name, returned, d.expected, entry));
        };
        compare("stiffness", &LocalState::q, state.q[b], r.stiffness(a, b));
        compare("damping", &LocalState::v, state.v[b], r.damping(a, b));
      }
    if (force.symmetric_tangent())
      out.require(r.stiffness.isApprox(r.stiffness.transpose()) && r.damping.isApprox(r.damping.transpose()),
                  "symmetric_tangent() is true", "but a tangent is not symmetric, " + where);
  }
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const LocalResponse again = trial.respond(seen[i].first), &before = seen[i].second;
    out.require(again.f == before.f && again.stiffness == before.stiffness &&
                    again.damping == before.damping && again.stored_energy == before.stored_energy &&
                    again.dissipated_power == before.dissipated_power && trial.history_new == histories[i],
                "impure", "the same state gave another response, sample " + std::to_string(i));
  }
}

void check_matrix(const char* name, const Eigen::MatrixXd& m, double tolerance, Findings& out) {
  if (m.size() == 0) return;
  if (!m.allFinite()) return out.add("not finite", std::string(name) + " matrix");
  out.require(m == m.transpose(), "unsymmetric matrix", name);
  const double size = m.cwiseAbs().maxCoeff();
  const double least = symmetric_eigen(m).values.minCoeff();
  out.require(least >= -tolerance * size, "matrix not positive semi-definite",
              std::string(name) + ", least eigenvalue " + to_text(least));
}

/// Columns: nominal motions n with b^T n = 0 for every speed ratio constraint and constraint.
Eigen::MatrixXd nominal_motions(const Terms& terms, int nodes) {
  const auto rows = terms.speed_ratio_constraints.size() + terms.constraints.size();
  if (rows == 0) return Eigen::MatrixXd::Identity(nodes, nodes);
  Eigen::MatrixXd all(static_cast<Eigen::Index>(rows), nodes);
  Eigen::Index r = 0;
  // Scaled: base radii of a few millimetres are no rounding errors.
  for (const SpeedRatioConstraint& c : terms.speed_ratio_constraints)
    all.row(r++) = c.b.normalized().transpose();
  for (const LocalRow& b : terms.constraints) all.row(r++) = b.normalized().transpose();
  return null_space(all);
}

void check_closures(const Terms& terms, int nodes, double tolerance, Findings& out) {
  const Eigen::MatrixXd n = nominal_motions(terms, nodes);
  if (n.cols() == 0) return;
  const double strain = (terms.stiffness * n).cwiseAbs().maxCoeff();
  const double size = terms.stiffness.cwiseAbs().maxCoeff() * n.cwiseAbs().maxCoeff();
  out.require(strain <= tolerance * size, "speed_ratio_constraints",
              "a nominal motion that satisfies them strains the stiffness matrix: K n = " + to_text(strain));
  for (const ScalarSpec& s : terms.scalars) {
    const double x = (s.b.transpose() * n).cwiseAbs().maxCoeff();
    // A law that only damps may slip nominally, as a dashpot does.
    if (s.force->evaluate({.x = 1.0}).y == s.force->evaluate({.x = -1.0}).y) continue;
    out.require(x <= tolerance * s.b.cwiseAbs().maxCoeff() * n.cwiseAbs().maxCoeff(),
                "speed_ratio_constraints",
                "a nominal motion that satisfies them deflects a law: b^T n = " + to_text(x));
  }
}

/// Sizes and node numbers; what follows relies on them.
bool check_description(const Terms& terms, int nodes, Findings& out) {
  const std::string expected = "must have " + std::to_string(nodes) + " entries, one a node";
  bool usable = true;
  const auto require = [&](bool good, const char* what, const std::string& detail) {
    out.require(good, what, detail);
    usable = usable && good;
  };
  for (const Eigen::MatrixXd* m : {&terms.mass, &terms.damping, &terms.stiffness})
    require(m->rows() == nodes && m->cols() == nodes, "matrix size",
            "must be n x n over " + std::to_string(nodes) + " nodes");
  for (const ScalarSpec& s : terms.scalars) {
    require(s.b.size() == nodes, "scalar row", expected);
    require(s.force != nullptr, "scalar law", "has none");
    require(s.phase_node >= -1 && s.phase_node < nodes, "phase node", "is no local node");
  }
  for (const LoadSpec& l : terms.loads)
    require(l.load != nullptr && l.node >= 0 && l.node < nodes, "load", "has no law or no node");
  for (const GeneralForce* g : terms.generals) require(g != nullptr, "general force", "has no law");
  for (const SpeedRatioConstraint& c : terms.speed_ratio_constraints) {
    require(c.b.size() == nodes, "speed ratio constraint", expected);
    const auto entries = (c.b.array() != 0.0).count();
    require(entries == 1 || entries == 2, "speed ratio constraint",
            "ties " + std::to_string(entries) + " nodes; it must tie one or two");
  }
  for (const LocalRow& b : terms.constraints) require(b.size() == nodes, "constraint row", expected);
  for (const OutputSpec& s : terms.outputs)
    require(s.stiffness.size() == nodes && s.damping.size() == nodes, "output row", expected);
  return usable;
}

}  // namespace

std::string CheckReport::text() const {
  std::string all;
  for (const std::string& line : failures) all += (all.empty() ? "" : "\n") + line;
  return all;
}

CheckReport check_element(const Element& element, int nodes, const CheckOptions& options) {
  CheckReport report;
  Findings out(report);
  std::vector<Finding> findings;
  ParameterCheck parameters(std::string(element.type()), findings);
  element.check(parameters);
  for (const Finding& f : findings) report.failures.push_back(f.text());
  out.require(nodes >= element.min_nodes() && nodes <= element.max_nodes(), "nodes",
              std::to_string(nodes) + " given, takes " + std::to_string(element.min_nodes()) + " to " +
                  std::to_string(element.max_nodes()));
  if (!report.ok()) return report;

  const int n = nodes + static_cast<int>(element.internal_nodes().size());
  Terms terms(n);
  element.describe(n, terms);
  if (!check_description(terms, n, out)) return report;
  for (const Contradiction& c : contradictions(element, n, terms)) out.add(c.what, c.detail);
  check_matrix("mass", terms.mass, options.tolerance, out);
  check_matrix("damping", terms.damping, options.tolerance, out);
  check_matrix("stiffness", terms.stiffness, options.tolerance, out);
  if (n > 0) check_closures(terms, n, options.tolerance, out);

  Draw draw(options.seed);
  for (std::size_t i = 0; i < terms.scalars.size(); ++i) {
    out.set_place(terms.scalars.size() > 1 ? "law " + std::to_string(i) + ": " : "");
    check_law(terms.scalars[i], options, draw, out);
  }
  for (std::size_t i = 0; i < terms.loads.size(); ++i) {
    out.set_place(terms.loads.size() > 1 ? "load " + std::to_string(i) + ": " : "");
    check_load(*terms.loads[i].load, options, draw, out);
  }
  out.set_place("");
  for (const GeneralForce* g : terms.generals) check_general(*g, n, options, draw, out);
  return report;
}

}  // namespace drev
