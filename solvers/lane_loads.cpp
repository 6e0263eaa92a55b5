#include "solvers/lane_loads.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace drev {

namespace {
constexpr int kBits = 62;  // loads that are watched in one word a lane
}

LaneLoads::LaneLoads(const std::array<const System*, kLanes>& systems)
    : base_(at(systems[0]->size())) {
  const System& first = *systems[0];
  for (std::size_t i = 0; i < first.loads().size(); ++i) {
    if (first.node_map(first.loads()[i].node).unknown < 0) continue;
    Place place;
    bool stretches = true;
    for (int lane = 0; lane < kLanes; ++lane) {
      const System& system = *systems[at(lane)];
      const LoadTerm& term = system.loads()[i];
      const NodeMap& map = system.node_map(term.node);
      place.row = map.unknown;
      place.loads[at(lane)] = term.load;
      place.coeff.v[lane] = place.feedback.v[lane] = map.coeff;
      place.ratio.v[lane] = system.ratio(term.node);
      place.moves = place.moves || term.load->depends_on_motion();
      stretches = stretches && term.load->stretch(0.0, 0.0, 1.0).has_value();
    }
    const auto in_row = std::count_if(places_.begin(), places_.end(),
                                      [&](const Place& p) { return p.row == place.row; });
    if (stretches && in_row < kBits) {
      if (!place.moves) place.feedback = {};
      places_.push_back(place);
    } else {
      evaluated_.push_back({place, {}});
      want_rates_ = want_rates_ || place.moves;
    }
    depend_on_motion_ = depend_on_motion_ || place.moves;
  }
  const auto by_row = [](const Place& a, const Place& b) { return a.row < b.row; };
  std::stable_sort(places_.begin(), places_.end(), by_row);
  stretches_.resize(places_.size());
  time_slopes_.resize(places_.size());
  bool common = true;
  for (const Place& p : places_) {
    for (const LaneRow* factor : {&p.coeff, &p.feedback, &p.ratio})
      for (int lane = 1; lane < kLanes; ++lane) common = common && factor->v[lane] == factor->v[0];
    factors_.push_back({p.coeff.v[0], p.feedback.v[0], p.ratio.v[0]});
  }
  if (!common) factors_.clear();
  std::stable_sort(evaluated_.begin(), evaluated_.end(), by_row);
  std::size_t s = 0, e = 0;
  for (int k = 0; k < first.size(); ++k) {
    Row row{k, static_cast<int>(s), 0, static_cast<int>(e), 0};
    while (s < places_.size() && places_[s].row == k) ++s;
    while (e < evaluated_.size() && evaluated_[e].row == k) ++e;
    row.end = static_cast<int>(s), row.end_evaluated = static_cast<int>(e);
    if (row.end > row.first || row.end_evaluated > row.first_evaluated)
      rows_.push_back(row);
    else
      unloaded_.push_back(k);
  }
  for (std::size_t r = 0; r < rows_.size(); ++r)
    if (groups_.empty() || rows_[r].end - rows_[at(groups_.back())].first > kBits)
      groups_.push_back(static_cast<int>(r));
  groups_.push_back(static_cast<int>(rows_.size()));
  for (const System* system : systems)
    always_base_ = always_base_ || system->any_prescribed_moves() || !system->nominal_drag().isZero(0.0);
}

void LaneLoads::restart(double t) {
  start_ = t;
  for (Stretch& s : stretches_) s.width.v = Lanes{} - 1.0;
}

void LaneLoads::set_time(const std::vector<Assembler>& assemblers) {
  t_ = assemblers[0].time();
  bool base = always_base_;
  for (int lane = 0; lane < kLanes; ++lane) {
    const MotionPoint& nominal = assemblers[at(lane)].nominal();
    phi_.v[lane] = nominal.value;
    phi_rate_.v[lane] = nominal.rate;
    base = base || nominal.acceleration != 0.0;
  }
  moved_ = true;
  if (!base && base_is_zero_) return;
  base_largest_ = {};
  for (int lane = 0; lane < kLanes; ++lane) {
    assemblers[at(lane)].external_of_motions(motions_);
    for (std::size_t i = 0; i < base_.size(); ++i)
      base_[i].v[lane] = motions_[static_cast<Eigen::Index>(i)];
    base_largest_.v[lane] = motions_.lpNorm<Eigen::Infinity>();
  }
  base_is_zero_ = !base;
}

double LaneLoads::angle(std::size_t load, int lane, const LaneRow* z) const {
  const Place& p = places_[load];
  return p.ratio.v[lane] * phi_.v[lane] + p.feedback.v[lane] * z[p.row].v[lane];
}

void LaneLoads::look_up(std::size_t load, int lane, double angle, double direction) {
  const auto found = places_[load].loads[at(lane)]->stretch(t_, angle, direction);
  if (!found) return;  // a load that has stretches at some times only: it keeps the last one
  const double below = angle - found->low, above = found->high - angle;
  const bool bounded = std::isfinite(below) && std::isfinite(above);
  const double centre = bounded ? 0.5 * (found->low + found->high) : angle;
  Stretch& s = stretches_[load];
  s.angle_0.v[lane] = centre;
  s.width.v[lane] = bounded ? 0.5 * (found->high - found->low) : std::max(0.0, std::min(below, above));
  s.slope.v[lane] = found->angle_slope;
  s.torque.v[lane] =
      found->torque + found->angle_slope * (centre - angle) - found->time_slope * (t_ - start_);
  time_slopes_[load].v[lane] = found->time_slope;
  timed_ = timed_ || found->time_slope != 0.0;
}

void LaneLoads::evaluate_by_lane(const LaneRow* z, const LaneRow* v, const LaneMask& open, bool moving) {
  for (Evaluated& load : evaluated_)
    for (int lane = 0; lane < kLanes; ++lane)
      if (open[lane] && load.moves == moving) {
        const double n = load.ratio.v[lane], c = load.coeff.v[lane];
        load.torque.v[lane] = load.loads[at(lane)]
                                  ->evaluate({t_, n * phi_.v[lane], c * z[load.row].v[lane],
                                              n * phi_rate_.v[lane] + c * v[load.row].v[lane]})
                                  .torque;
      }
}

struct LaneLoadKernels {
  /// The sum of a row, with its loads on the stretches that they have. Bit (load - begin) of left: the load
  /// has left its stretch.
  template <bool common>
  [[gnu::always_inline]] static inline void row(const LaneLoads& l, const LaneLoads::Row& row,
                                                const LaneRow* z, int begin, Lanes& sum, LaneMask& left) {
    sum = l.base_.data()[row.row].v;
    for (int i = row.first; i < row.end; ++i) {
      const LaneLoads::Stretch& s = l.stretches_.data()[i];
      Lanes u, torque;
      if constexpr (common) {
        const LaneLoads::Factors& f = l.factors_.data()[i];
        u = (f.ratio * l.phi_.v - s.angle_0.v) + f.feedback * z[row.row].v;
      } else {
        const LaneLoads::Place& p = l.places_.data()[i];
        u = (p.ratio.v * l.phi_.v - s.angle_0.v) + p.feedback.v * z[row.row].v;
      }
      left |= ((u < 0.0 ? -u : u) > s.width.v) & (LaneMask{} + (std::int64_t{1} << (i - begin)));
      torque = s.torque.v + s.slope.v * u;
      if (l.timed_) torque += l.time_slopes_.data()[i].v * (l.t_ - l.start_);
      if constexpr (common)
        sum += l.factors_.data()[i].coeff * torque;
      else
        sum += l.places_.data()[i].coeff.v * torque;
    }
    for (int i = row.first_evaluated; i < row.end_evaluated; ++i)
      sum += l.evaluated_.data()[i].coeff.v * l.evaluated_.data()[i].torque.v;
  }

  template <bool common>
  [[gnu::always_inline]] static inline void rows(const LaneLoads& l, int first, int end, const LaneRow* z,
                                                 const LaneMask& open, const LaneRow* before, LaneRow* p,
                                                 LaneMask& left, LaneRow& change, LaneRow& largest) {
    Lanes changed = change.v, most = largest.v;
    LaneMask out{};
    const int begin = l.rows_.data()[first].first;
    for (int r = first; r < end; ++r) {
      const LaneLoads::Row& place = l.rows_.data()[r];
      Lanes sum;
      row<common>(l, place, z, begin, sum, out);
      sum = open ? sum : p[place.row].v;
      p[place.row].v = sum;
      if (before) {
        Lanes d = sum - before[place.row].v;
        d = d < 0.0 ? -d : d;
        changed = changed < d ? d : changed;
      }
      const Lanes size = sum < 0.0 ? -sum : sum;
      most = most < size ? size : most;
    }
    change.v = changed;
    largest.v = most;
    left = out & open;
  }

  DREV_WIDEST static void evaluate(const LaneLoads& l, int first, int end, const LaneRow* z,
                                   const LaneMask& open, const LaneRow* before, LaneRow* p, LaneMask& left,
                                   LaneRow& change, LaneRow& largest) {
    if (!l.factors_.empty())
      rows<true>(l, first, end, z, open, before, p, left, change, largest);
    else
      rows<false>(l, first, end, z, open, before, p, left, change, largest);
  }
};

void LaneLoads::evaluate(const LaneRow* z, const LaneRow* v, const LaneMask& open, const LaneRow* before,
                         LaneRow* p, LaneRow& change, LaneRow& largest) {
  if (!evaluated_.empty()) {
    if (moved_) evaluate_by_lane(z, v, open, false);
    if (want_rates_) evaluate_by_lane(z, v, open, true);
  }
  moved_ = false;
  for (const int i : unloaded_) p[i] = base_[at(i)];
  change = {};
  largest = base_largest_;
  for (std::size_t g = 0; g + 1 < groups_.size(); ++g) {
    const int first = groups_[g], end = groups_[g + 1];
    const LaneRow change_before = change, largest_before = largest;
    LaneMask left;
    LaneLoadKernels::evaluate(*this, first, end, z, open, before, p, left, change, largest);
    if (!any(left)) continue;
    const auto begin = at(rows_[at(first)].first);
    for (int lane = 0; lane < kLanes; ++lane)
      for (auto bits = static_cast<std::uint64_t>(left[lane]); bits != 0; bits &= bits - 1) {
        const std::size_t i = begin + static_cast<std::size_t>(std::countr_zero(bits));
        const double theta = angle(i, lane, z);
        const bool none = stretches_[i].width.v[lane] < 0.0;
        look_up(i, lane, theta, none ? 1.0 : theta - stretches_[i].angle_0.v[lane]);
      }
    change = change_before, largest = largest_before;
    LaneLoadKernels::evaluate(*this, first, end, z, open, before, p, left, change, largest);
  }
}

}  // namespace drev
