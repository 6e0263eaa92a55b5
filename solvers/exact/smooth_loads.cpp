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

double SmoothLoads::differ_called(const Place& l, NodeForces& forces) const {
  const GaussRule& rule = gauss_rule();
  double gain = 0.0;
  for (std::size_t q = 0; q < GaussRule::kNodes; ++q) {
    const double s = rule.s[q], turn = (phi_[1] + phi_[2] * s) * s;
    const std::size_t at = q * idx(stride_) + idx(l.row);
    const double deviation = l.coeff * path_[at];
    const double nominal_speed = l.ratio * (phi_[1] + 2.0 * phi_[2] * s) / h_;
    const LoadResponse r = l.term->load->evaluate({.t = t_ + h_ * s,
                                                   .nominal_angle = l.ratio * (nominal_ + turn),
                                                   .deviation = deviation,
                                                   .speed = nominal_speed + l.coeff * rate_[at],
                                                   .nominal_speed = nominal_speed});
    const double tangent = l.slope == 0.0 ? 0.0 : l.slope * (l.ratio * turn + deviation - l.deviation);
    forces.at(q, l.row) += l.coeff * (r.torque - l.torque - tangent);
    if (l.feedback)
      gain = std::max(gain,
                      0.5 * h_ * h_ * std::abs(r.dtorque_dangle - l.slope) + h_ * std::abs(r.dtorque_dspeed));
  }
  return gain;
}

double SmoothLoads::project(const TaylorSeries& series, bool first, LegendreProjection& projection,
                            LegendreProjection& kinks) {
  places_.clear();
  if (loads_.empty()) return 0.0;
  path_.resize(GaussRule::kNodes * idx(stride_));
  rate_.resize(path_.size());
  series.at_nodes(path_.data(), rate_.data());
  if (first) known_.clear();
  forces_ = known_;
  double contraction = 0.0;
  for (Place& l : loads_) {
    if (!l.feedback && !first && l.knots == nullptr) continue;
    NodeForces& forces = l.feedback || l.knots != nullptr ? forces_ : known_;
    const double gain =
        l.knots != nullptr ? differ_knotted(l, series, forces, kinks) : differ_called(l, forces);
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
