#pragma once
/// Elements with a general force, for tests: of one's own making, with history or without symmetry.
#include <drev/core/element.hpp>
#include <drev/core/general_force.hpp>

#include <algorithm>
#include <cmath>

namespace drev::problems {

/// Two nodes (x = q_b - q_a) or one (x = q): f = b y(x), y from the law's history.
class HistoryElement : public Element, public GeneralForce {
 public:
  int min_nodes() const override { return 1; }
  int max_nodes() const override { return 2; }
  void describe(int nodes, Terms& terms) const override {
    terms.generals.push_back(this);
    terms.speed_ratio_constraints.push_back({.b = relative_motion(nodes)});
  }
  void evaluate(const LocalState& s, LocalResponse& r) const override {
    const double x = s.q.size() == 1 ? s.q[0] : s.q[1] - s.q[0];
    double slope = 0.0;
    const double y = law(s.t, x, s.history, r.history, slope);
    const LocalRow b = relative_motion(static_cast<int>(s.q.size()));
    r.f = y * b;
    r.stiffness = slope * b * b.transpose();
  }

 protected:
  virtual double law(double t, double x, std::span<const double> before, std::span<double> after,
                     double& slope) const = 0;
};

/// Spring k in series with a dashpot c:  y' = k x' - (k/c) y, by the trapezoidal rule over the step.
class Maxwell final : public HistoryElement {
 public:
  struct Params {
    double stiffness = 1.0, damping = 1.0;
  };
  explicit Maxwell(Params p) : p_(p) {}
  std::string_view type() const override { return "Maxwell element"; }
  void check(ParameterCheck& check) const override {
    check.positive("stiffness", p_.stiffness, "N m/rad");
    check.positive("damping", p_.damping, "N m s/rad");
  }
  int history_size() const override { return 3; }  // t, x, y

 protected:
  double law(double t, double x, std::span<const double> before, std::span<double> after,
             double& slope) const override {
    const double a = 0.5 * (t - before[0]) * p_.stiffness / p_.damping;
    slope = p_.stiffness / (1.0 + a);
    const double y = ((1.0 - a) * before[2] + p_.stiffness * (x - before[1])) / (1.0 + a);
    after[0] = t, after[1] = x, after[2] = y;
    return y;
  }

 private:
  Params p_;
};

/// Jenkins element: spring k that slips at the torque `slip`, a dry friction coupling.
class Jenkins final : public HistoryElement {
 public:
  struct Params {
    double stiffness = 1.0, slip = 1.0;
  };
  explicit Jenkins(Params p) : p_(p) {}
  std::string_view type() const override { return "Jenkins element"; }
  void check(ParameterCheck& check) const override {
    check.positive("stiffness", p_.stiffness, "N m/rad");
    check.positive("slip", p_.slip, "N m");
  }
  int history_size() const override { return 1; }  // where the spring's far end stands

 protected:
  double law(double, double x, std::span<const double> before, std::span<double> after,
             double& slope) const override {
    const double trial = p_.stiffness * (x - before[0]);
    const double y = std::clamp(trial, -p_.slip, p_.slip);
    slope = y == trial ? p_.stiffness : 0.0;
    after[0] = x - y / p_.stiffness;
    return y;
  }

 private:
  Params p_;
};

/// Circulatory coupling f = s (q_2, -q_1): its tangent is not symmetric.
class Circulatory final : public Element, public GeneralForce {
 public:
  struct Params {
    double coupling = 1.0;
  };
  explicit Circulatory(Params p) : p_(p) {}
  std::string_view type() const override { return "circulatory coupling"; }
  int min_nodes() const override { return 2; }
  void check(ParameterCheck& check) const override { check.finite("coupling", p_.coupling, "N m/rad"); }
  void describe(int, Terms& terms) const override { terms.generals.push_back(this); }
  bool symmetric_tangent() const override { return false; }
  void evaluate(const LocalState& s, LocalResponse& r) const override {
    r.f << p_.coupling * s.q[1], -p_.coupling * s.q[0];
    r.stiffness << 0.0, p_.coupling, -p_.coupling, 0.0;
  }

 private:
  Params p_;
};

}  // namespace drev::problems
