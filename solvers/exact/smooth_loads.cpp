#include "solvers/exact/smooth_loads.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/exact/expanded_loads.hpp"

namespace drev {

void SmoothLoads::find_loads(const MotionPoint& nominal) {
  const bool constant = ExpandedLoads::is_constant(nominal);
  if (found_ && constant == constant_) return;
  found_ = true;
  constant_ = constant;
  loads_.clear();
  for (const Added& added : all_) {
    if (added.expanded && ExpandedLoads::holds(*added.term, constant)) continue;
    loads_.emplace_back(system_, *added.term);
    loads_.back().knots = dynamic_cast<const KnottedLoad*>(added.term->load);
  }
}

void SmoothLoads::move(const Assembler& assembler, const Vector& z, const Vector& v) {
  t_ = assembler.time();
  const MotionPoint& nominal = assembler.nominal();
  nominal_ = nominal.value;
  find_loads(nominal);
  for (Place& l : loads_) {
    l.move(system_, nominal, z, v);
    const LoadResponse r = assembler.load(*l.term, z, v);
    l.torque = r.torque;
    l.slope = l.feedback ? r.dtorque_dangle : 0.0;
    if (l.knots != nullptr) l.follow(l.angle, l.speed, l.ratio * nominal.rate);
  }
}

void SmoothLoads::move_as(const SmoothLoads& other) {
  t_ = other.t_;
  nominal_ = other.nominal_;
  loads_ = other.loads_;
  found_ = other.found_;
  constant_ = other.constant_;
}

void SmoothLoads::add_to(double h, const std::array<double, 3>& phi, double* p) {
  h_ = h;
  phi_ = phi;
  for (const Place& l : loads_) l.add_to(h, phi, stride_, p);
}

void SmoothLoads::add_slopes(TaylorSeries& series) const {
  for (const Place& l : loads_) l.add_slopes(series, 0.0);
}

double SmoothLoads::differ_called(Place& l, const TaylorSeries& series, NodeForces& forces) const {
  const GaussRule& rule = gauss_rule();
  double gain = 0.0;
  const auto differ = [&](double s, double along, double rate) {
    const double turn = (phi_[1] + phi_[2] * s) * s, deviation = l.coeff * along;
    const double nominal_speed = l.ratio * (phi_[1] + 2.0 * phi_[2] * s) / h_;
    const LoadResponse r = l.term->load->evaluate({.t = t_ + h_ * s,
                                                   .nominal_angle = l.ratio * (nominal_ + turn),
                                                   .deviation = deviation,
                                                   .speed = nominal_speed + l.coeff * rate,
                                                   .nominal_speed = nominal_speed});
    if (l.feedback)
      gain = std::max(gain,
                      0.5 * h_ * h_ * std::abs(r.dtorque_dangle - l.slope) + h_ * std::abs(r.dtorque_dspeed));
    const double tangent = l.slope == 0.0 ? 0.0 : l.slope * (l.ratio * turn + deviation - l.deviation);
    return l.coeff * (r.torque - l.torque - tangent);
  };
  std::array<double, GaussRule::kNodes> at_nodes;
  for (std::size_t q = 0; q < GaussRule::kNodes; ++q) {
    const std::size_t at = q * idx(stride_) + idx(l.row);
    at_nodes[q] = differ(rule.s[q], path_[at], rate_[at]);
    forces.at(q, l.row) += at_nodes[q];
  }
  double along = 0.0, rate = 0.0;
  for (int k = series.degree(); l.feedback && k >= 0; --k) {
    rate = rate * GaussRule::kAheadOfEnd + along;
    along = along * GaussRule::kAheadOfEnd + series.coefficient(k, l.row);
  }
  l.off_at_ends = rule.off_at_ends(at_nodes, 0.0, differ(GaussRule::kAheadOfEnd, along, rate / h_));
  return gain;
}

double SmoothLoads::project(const TaylorSeries& series, bool first, LegendreProjection& projection,
                            LegendreProjection& kinks) {
  places_.clear();
  if (loads_.empty()) return 0.0;
  if (first) known_.clear();
  forces_ = known_;
  double contraction = 0.0;
  for (Place& l : loads_) {
    if (!l.feedback && !first && l.knots == nullptr) continue;
    NodeForces& forces = l.feedback || l.knots != nullptr ? forces_ : known_;
    const double gain =
        l.knots != nullptr ? differ_knotted(l, series, forces, kinks) : differ_called(l, series, forces);
    contraction = std::max(contraction, l.coeff * l.coeff * series.mobility(l.row) * gain);
  }
  projection.add_nodes(forces_);
  if (first) projection.add_nodes(known_);
  return contraction;
}

double SmoothLoads::slope_work(const TaylorSeries& series, const Vector& end) const {
  double sum = 0.0;
  for (const Place& l : loads_) {
    const double turn = l.coeff * (l.along(system_, end) - series.coefficient(0, l.row));
    sum += 0.5 * l.slope * turn * turn;
  }
  return sum;
}

}  // namespace drev
