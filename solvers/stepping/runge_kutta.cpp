#include "solvers/stepping/runge_kutta.hpp"

#include <cmath>

namespace drev {

RungeKutta::RungeKutta(const System& system, const StepScheme& scheme, const StepOptions& options)
    : Stepper(system, scheme, options),
      tableau_(*equation_.scheme().tableau),
      rate_(static_cast<std::size_t>(tableau_.stages() + 1)),
      acceleration_(rate_.size()),
      loads_(tableau_.starts_late() ? idx(tableau_.stages()) : 0) {}

void RungeKutta::combine(const EvaluatedState& from, double h, const double* weights, Eigen::Index stride,
                         int count, Vector& z, Vector& v) const {
  z = from.state.z;
  v = from.state.v;
  for (int j = 0; j < count; ++j) {
    const double w = weights[j * stride];
    if (w == 0.0) continue;
    z += (h * w) * rate_[idx(j)];
    v += (h * w) * acceleration_[idx(j)];
  }
}

NewtonResult RungeKutta::step(const EvaluatedState& from, double h, double t_new, double t_evaluate,
                              EvaluatedState& to, bool accept_jump) {
  equation_.clock().enter(RunSection::linear);
  Assembler& assembler = equation_.assembler();
  const double g = tableau_.diagonal();
  const int s = tableau_.stages();
  const Eigen::Index stride = tableau_.a.outerStride();
  NewtonResult result;
  for (int i = 0; i < s; ++i) {
    const double c = tableau_.c[i], own = tableau_.a(i, i);
    const double* row = &tableau_.a(i, 0);
    if (c == 0.0 && own == 0.0) {
      rate_[idx(i)] = from.state.v;
      acceleration_[idx(i)] = from.state.a;
      continue;
    }
    assembler.set_time(c == 1.0 ? t_evaluate : from.state.t + c * h);
    if (own == 0.0) {
      combine(from, h, row, stride, i, stage_.state.z, stage_.state.v);
      equation_.evaluate(from.state.history, stage_);
      equation_.acceleration(stage_.total, acceleration_[idx(i)]);
      rate_[idx(i)] = stage_.state.v;
      continue;
    }
    combine(from, h, row, stride, i, problem_.z_0, problem_.v_0);
    problem_.z_0 += (g * h) * problem_.v_0;
    problem_.h = h;
    problem_.a_start = i == 0 ? &from.state.a : &acceleration_[idx(i - 1)];
    problem_.history = &from.state.history;
    problem_.accept_jump = accept_jump;
    const NewtonResult solved = equation_.solve(problem_, to);
    result.iterations += solved.iterations;
    result.inside_jump = result.inside_jump || solved.inside_jump;
    result.status = solved.status;
    if (solved.status != NewtonStatus::converged) return result;
    rate_[idx(i)] = to.state.v;
    acceleration_[idx(i)] = to.state.a;
    if (!loads_.empty()) loads_[idx(i)] = to.p;
  }
  to.state.t = t_new;
  equation_.clock().enter(RunSection::linear);
  if (g > 0.0) {
    equation_.totals(from, from.state.a, to);
  } else {
    combine(from, h, tableau_.b.data(), 1, s, to.state.z, to.state.v);
    assembler.set_time(t_evaluate);
    to.state.history = from.state.history;
    equation_.evaluate(from.state.history, to, &to.state.history);
    equation_.acceleration(to.total, to.state.a);
    rate_[idx(s)] = to.state.v;
    acceleration_[idx(s)] = to.state.a;
    if (!to.state.z.allFinite() || !to.state.v.allFinite() || !to.state.a.allFinite())
      result.status = NewtonStatus::not_finite;
  }
  equation_.update_scale(to);
  return result;
}

void RungeKutta::estimate(const EvaluatedState& from, const EvaluatedState& to, double h, Vector& e_z,
                          Vector& e_v) {
  if (tableau_.e.size() == 0) {
    estimate_by_quadrature(from, to, h, e_z, e_v);
  } else {
    e_z.setZero(from.state.z.size());
    e_v.setZero(from.state.z.size());
    for (Eigen::Index i = 0; i < tableau_.e.size(); ++i) {
      const int j = static_cast<int>(i);
      e_z += (h * tableau_.e[i]) * rate_[idx(j)];
      e_v += (h * tableau_.e[i]) * acceleration_[idx(j)];
    }
  }
  if (!loads_.empty()) add_change_before_stages(from, h, e_v);
  if (tableau_.diagonal() > 0.0) equation_.filter(h, e_z, e_v);
}

void RungeKutta::add_change_before_stages(const EvaluatedState& from, double h, Vector& e_v) {
  Vector beyond = -from.p, more;
  for (Eigen::Index i = 0; i < tableau_.to_start.size(); ++i)
    if (tableau_.to_start[i] != 0.0) beyond += tableau_.to_start[i] * loads_[static_cast<std::size_t>(i)];
  if (beyond.isZero(0.0)) return;
  equation_.acceleration(beyond, more);
  const double missed = tableau_.c.minCoeff() * h;
  for (Eigen::Index i = 0; i < e_v.size(); ++i) e_v[i] += std::copysign(missed * std::abs(more[i]), e_v[i]);
}

}  // namespace drev
