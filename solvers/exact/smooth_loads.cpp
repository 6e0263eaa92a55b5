#include "solvers/exact/smooth_loads.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/exact/series_kernels.hpp"

namespace drev {

void SmoothLoads::add(const LoadTerm& term) {
  const NodeMap& map = system_.node_map(term.node);
  Place place{&term, system_.place(map), map.coeff, system_.ratio(term.node), term.load->depends_on_motion()};
  if (const auto* harmonic = dynamic_cast<const HarmonicLoad*>(term.load)) {
    place.cells = static_cast<int>(cells_.size());
    cells_.emplace_back(harmonic->orders());
  } else {
    calls_ = true;
    place.knots = dynamic_cast<const KnottedLoad*>(term.load);
    if (place.knots != nullptr) place.curves = system_.knotted_loads().curves_of(*term.load);
  }
  loads_.push_back(std::move(place));
}

void SmoothLoads::move(const Assembler& assembler, const Vector& z, const Vector& v) {
  t_ = assembler.time();
  for (Place& l : loads_) {
    l.deviation = l.feedback ? l.coeff * along(l.row, z) : 0.0;
    l.angle = l.ratio * assembler.nominal().value + l.deviation;
    if (l.knots != nullptr) {
      move_knotted(l, assembler, z, v);
      continue;
    }
    const LoadResponse r =
        l.cells >= 0 ? HarmonicCells::value(cells_[idx(l.cells)].at(l.angle)) : assembler.load(*l.term, z, v);
    l.torque = r.torque;
    l.slope = l.feedback ? r.dtorque_dangle : 0.0;
  }
  nominal_ = assembler.nominal().value;
}

void SmoothLoads::move_as(const SmoothLoads& other) {
  t_ = other.t_;
  nominal_ = other.nominal_;
  for (std::size_t i = 0; i < loads_.size(); ++i) {
    const int cells = loads_[i].cells;
    loads_[i] = other.loads_[i];
    loads_[i].cells = cells;
  }
}

void SmoothLoads::add_to(double h, const std::array<double, 3>& phi, double* p) {
  h_ = h;
  phi_ = phi;
  for (const Place& l : loads_) {
    p[l.row] += l.coeff * l.torque;
    if (l.speed_slope != 0.0) p[stride_ + l.row] += l.coeff * l.speed_slope * l.ratio * 2.0 * phi[2] / h;
    if (l.slope == 0.0) continue;
    for (int k = 1; k < 3; ++k) p[k * stride_ + l.row] += l.coeff * l.slope * l.ratio * phi[idx(k)];
  }
}

void SmoothLoads::add_slopes(TaylorSeries& series) const {
  for (const Place& l : loads_) {
    if (l.speed_slope != 0.0) {
      const double damping = -l.coeff * l.coeff * l.speed_slope;
      series.add_row_damping(l.row, damping);
      series.widen(l.row, 0.0, damping);
      series.right_side(0)[l.row] -= l.coeff * l.speed_slope * l.rate;
    }
    if (l.slope == 0.0) continue;
    const double slope = l.coeff * l.coeff * l.slope;
    series.add_row_stiffness(l.row, -slope);
    series.widen(l.row, slope, 0.0);
    // The slope acts on the change of the deviation over the step.
    series.right_side(0)[l.row] -= l.coeff * l.slope * l.deviation;
  }
}

/// A load in its cells: its polynomial at all nodes at once. Returns the largest change of its slope.
double SmoothLoads::differ_cells(const Place& l, NodeForces& forces) {
  constexpr std::size_t n = GaussRule::kNodes, room = whole_lanes(GaussRule::kNodes);
  const GaussRule& rule = gauss_rule();
  HarmonicCells& cells = cells_[idx(l.cells)];
  const HarmonicCells::Place start = cells.at(l.angle);
  std::array<double, room> turn, distance{}, torque, slope;
  double farthest = 0.0;
  for (std::size_t q = 0; q < n; ++q) {
    turn[q] = l.ratio * (phi_[1] + phi_[2] * rule.s[q]) * rule.s[q];
    if (l.feedback) turn[q] += l.coeff * path_[q * idx(stride_) + idx(l.row)] - l.deviation;
    distance[q] = start.distance + turn[q];
    farthest = std::max(farthest, std::abs(distance[q]));
  }
  if (farthest <= cells.reach()) {
    polynomial_values(room, HarmonicCells::kTerms, start.cell->terms.data(), distance.data(), torque.data(),
                      slope.data());
  } else {
    for (std::size_t q = 0; q < n; ++q) {
      const LoadResponse r = HarmonicCells::value(cells.at(l.angle + turn[q]));
      torque[q] = r.torque;
      slope[q] = r.dtorque_dangle;
    }
  }
  double change = 0.0;
  for (std::size_t q = 0; q < n; ++q) {
    forces.at(q, l.row) += l.coeff * (torque[q] - l.torque - l.slope * turn[q]);
    change = std::max(change, std::abs(slope[q] - l.slope));
  }
  return l.feedback ? 0.5 * h_ * h_ * change : 0.0;
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
    double tangent = l.slope == 0.0 ? 0.0 : l.slope * (l.ratio * turn + deviation - l.deviation);
    if (l.speed_slope != 0.0) tangent += l.speed_slope * (nominal_speed + l.coeff * rate_[at] - l.speed);
    forces.at(q, l.row) += l.coeff * (r.torque - l.torque - tangent);
    if (l.feedback)
      gain = std::max(gain, 0.5 * h_ * h_ * std::abs(r.dtorque_dangle - l.slope) +
                                h_ * std::abs(r.dtorque_dspeed - l.speed_slope));
  }
  return gain;
}

double SmoothLoads::project(const TaylorSeries& series, bool first, LegendreProjection& projection,
                            LegendreProjection& kinks) {
  places_.clear();
  if (loads_.empty()) return 0.0;
  path_.resize(GaussRule::kNodes * idx(stride_));
  if (calls_) rate_.resize(path_.size());
  series.at_nodes(path_.data(), calls_ ? rate_.data() : nullptr);
  if (first) known_.clear();
  forces_ = known_;
  double contraction = 0.0;
  for (Place& l : loads_) {
    if (!l.feedback && !first && l.knots == nullptr) continue;
    NodeForces& forces = l.feedback || l.knots != nullptr ? forces_ : known_;
    const double gain = l.knots != nullptr ? differ_knotted(l, series, forces, kinks)
                        : l.cells >= 0     ? differ_cells(l, forces)
                                           : differ_called(l, forces);
    contraction = std::max(contraction, l.coeff * l.coeff * series.mobility(l.row) * gain);
  }
  projection.add_nodes(forces_);
  if (first) projection.add_nodes(known_);
  return contraction;
}

double SmoothLoads::slope_work(const TaylorSeries& series, double s, const Vector& end) const {
  const GaussRule& rule = gauss_rule();
  double sum = 0.0;
  for (const Place& l : loads_) {
    if (l.slope != 0.0) {
      const double turn = l.coeff * (along(l.row, end) - series.coefficient(0, l.row));
      sum += 0.5 * l.slope * turn * turn;
    }
    if (l.speed_slope == 0.0) continue;
    double integral = 0.0;  // of (w - w_0) w over s, w from the deviation
    for (std::size_t q = 0; q < GaussRule::kNodes; ++q) {
      double rate = 0.0;
      if (s == 1.0)
        rate = rate_[q * idx(stride_) + idx(l.row)];
      else
        for (int k = series.degree(); k > 0; --k)
          rate = rate * s * rule.s[q] + k * series.coefficient(k, l.row) / h_;
      integral += rule.weight[q] * (l.coeff * rate - l.rate) * l.coeff * rate;
    }
    sum += l.speed_slope * h_ * s * integral;
  }
  return sum;
}

}  // namespace drev
