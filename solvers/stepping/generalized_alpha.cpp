#include "solvers/stepping/generalized_alpha.hpp"

#include "solvers/linear/vector_kernels.hpp"

namespace drev {

NewtonResult GeneralizedAlpha::step(const EvaluatedState& from, double h, double t_new, double t_evaluate,
                                    EvaluatedState& to, bool accept_jump) {
  const StepScheme& c = equation_.scheme();
  equation_.clock().enter(RunSection::linear);
  equation_.assembler().set_time(t_evaluate);
  const double shift = c.alpha_m - c.alpha_f;
  const bool carries_over = shift != 0.0 && equation_.options().varying_steps && from.a_step != h;
  NewtonResult result;
  if (carries_over) {
    equation_.acceleration(from.total, a_0_);
    if (from.a_step > 0.0) {
      a_shifted_ = a_0_ + (h / from.a_step) * (from.state.a - a_0_);
    } else {
      result = step_from(from.state.a, from, h, to, accept_jump);
      if (result.status != NewtonStatus::converged) return result;
      equation_.acceleration(to.total, a_1_);
      a_shifted_ = a_0_ + shift * (a_1_ - a_0_);
      equation_.start_from(from);
    }
  }
  const int before = result.iterations;
  result = step_from(carries_over ? a_shifted_ : from.state.a, from, h, to, accept_jump);
  result.iterations += before;
  if (result.status != NewtonStatus::converged) return result;
  to.state.t = t_new;
  to.a_step = h;
  equation_.update_scale(to);
  return result;
}

NewtonResult GeneralizedAlpha::step_from(const Vector& a, const EvaluatedState& from, double h,
                                         EvaluatedState& to, bool accept_jump) {
  const StepScheme& c = equation_.scheme();
  const State& s = from.state;
  problem_.z_0.resize(s.z.size());
  problem_.v_0.resize(s.z.size());
  predict_motion(static_cast<int>(s.z.size()), h, h * h * (0.5 - c.beta), h * (1.0 - c.gamma), s.z.data(),
                 s.v.data(), a.data(), problem_.z_0.data(), problem_.v_0.data());
  // What of the residual is known: alpha_m M a0 + alpha_f F0.
  problem_.known = nullptr;
  if (c.alpha_m != 0.0 || c.alpha_f != 0.0) {
    known_ = -c.alpha_f * from.total;
    if (c.alpha_m != 0.0) {
      equation_.assembler().multiply_mass(a, scratch_);
      known_ -= c.alpha_m * scratch_;
    }
    problem_.known = &known_;
  }
  problem_.h = h;
  problem_.a_start = &s.a;
  problem_.history = &s.history;
  problem_.accept_jump = accept_jump;
  const NewtonResult result = equation_.solve(problem_, to);
  if (result.status != NewtonStatus::converged) return result;
  equation_.clock().enter(RunSection::linear);
  equation_.totals(from, a, to);
  return result;
}

void GeneralizedAlpha::estimate(const EvaluatedState& from, const EvaluatedState& to, double h, Vector& e_z,
                                Vector& e_v) {
  estimate_by_quadrature(from, to, h, e_z, e_v);
  equation_.filter(h, e_z, e_v);
}

}  // namespace drev
