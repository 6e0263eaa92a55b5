#include "solvers/batch/lane_loads.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace drev {

namespace {

constexpr int kBits = 62;  // tables that are watched in one word a lane

/// Smallest distance between two neighbouring knots.
double closest(const LoadTable& table) {
  double least = table.arguments.front() + table.period - table.arguments.back();
  for (std::size_t i = 1; i < table.arguments.size(); ++i)
    least = std::min(least, table.arguments[i] - table.arguments[i - 1]);
  return least;
}

}  // namespace

LaneLoads::LaneLoads(const std::array<const System*, kLanes>& systems) : base_(idx(systems[0]->size())) {
  const System& first = *systems[0];
  std::vector<std::size_t> order;  // of the loads, by row
  const auto row_of = [&](std::size_t i) { return first.node_map(first.loads()[i].node).unknown; };
  for (std::size_t i = 0; i < first.loads().size(); ++i)
    if (row_of(i) >= 0) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return row_of(a) < row_of(b); });
  bool common = true;
  for (const std::size_t i : order) {
    Evaluated load;
    Factors<LaneRow> factors;
    std::array<std::optional<LoadTable>, kLanes> tables;
    load.row = row_of(i);
    for (int lane = 0; lane < kLanes; ++lane) {
      const System& system = *systems[idx(lane)];
      const LoadTerm& term = system.loads()[i];
      const double coeff = system.node_map(term.node).coeff;
      load.loads[idx(lane)] = term.load;
      load.coeff.v[lane] = coeff;
      load.ratio.v[lane] = factors.ratio.v[lane] = system.ratio(term.node);
      factors.gain.v[lane] = term.load->depends_on_motion() ? coeff : 0.0;
      load.moves = load.moves || term.load->depends_on_motion();
      tables[idx(lane)] = term.load->table();
    }
    depend_on_motion_ = depend_on_motion_ || load.moves;
    const auto in_row = std::count(table_row_.begin(), table_row_.end(), load.row);
    if (in_row == kBits ||
        !std::all_of(tables.begin(), tables.end(), [](const auto& t) { return t && t->evenly_spaced; })) {
      evaluated_.push_back(load);
      evaluated_move_ = evaluated_move_ || load.moves;
      continue;
    }
    for (int lane = 0; lane < kLanes; ++lane) {
      const LoadTable& table = *tables[idx(lane)];
      tables_.add(table, load.row, load.coeff.v[lane], factors.ratio.v[lane], factors.gain.v[lane]);
      factors.width.v[lane] = 0.5 * table.period / static_cast<double>(table.values.size());
      reach_.push_back(closest(table));
    }
    table_row_.push_back(load.row);
    factors_.push_back(factors);
    for (const LaneRow* f : {&factors.ratio, &factors.gain, &factors.width})
      for (int lane = 1; lane < kLanes; ++lane) common = common && f->v[lane] == f->v[0];
    common_factors_.push_back({factors.ratio.v[0], factors.gain.v[0], factors.width.v[0]});
  }
  if (!common) common_factors_.clear();
  steepness_known_ = !evaluated_move_;
  knots_.resize(table_row_.size());
  for (Knot& k : knots_) k.angle.v = Lanes{} + std::numeric_limits<double>::infinity();  // none yet
  steepness_.resize(table_row_.size());
  std::size_t s = 0, e = 0;
  for (int k = 0; k < first.size(); ++k) {
    Row row{k, static_cast<int>(s), 0, static_cast<int>(e), 0};
    while (s < table_row_.size() && table_row_[s] == k) ++s;
    while (e < evaluated_.size() && evaluated_[e].row == k) ++e;
    row.end = static_cast<int>(s), row.end_evaluated = static_cast<int>(e);
    if (row.end > row.first || row.end_evaluated > row.first_evaluated)
      rows_.push_back(row);
    else
      unloaded_.push_back(k);
  }
  for (std::size_t r = 0; r < rows_.size(); ++r)
    if (groups_.empty() || rows_[r].end - rows_[idx(groups_.back())].first > kBits)
      groups_.push_back(static_cast<int>(r));
  groups_.push_back(static_cast<int>(rows_.size()));
  for (const System* system : systems)
    always_base_ = always_base_ || system->any_prescribed_moves() || !system->nominal_drag().isZero(0.0);
}

void LaneLoads::set_time(const std::vector<Assembler>& assemblers) {
  t_ = assemblers[0].time();
  bool base = always_base_;
  for (int lane = 0; lane < kLanes; ++lane) {
    const MotionPoint& nominal = assemblers[idx(lane)].nominal();
    phi_.v[lane] = nominal.value;
    phi_rate_.v[lane] = nominal.rate;
    base = base || nominal.acceleration != 0.0;
  }
  moved_ = true;
  if (!base && base_is_zero_) return;
  for (int lane = 0; lane < kLanes; ++lane) {
    assemblers[idx(lane)].external_of_motions(motions_);
    for (std::size_t i = 0; i < base_.size(); ++i) base_[i].v[lane] = motions_[static_cast<Eigen::Index>(i)];
  }
  base_is_zero_ = !base;
}

/// The knot nearest to where the table is now. False: the one before does not serve for this angle.
bool LaneLoads::take_nearest(std::size_t table, int lane, const LaneMotion& motion) {
  const Factors<LaneRow>& f = factors_[table];
  Knot& k = knots_[table];
  const double angle = f.ratio.v[lane] * phi_.v[lane] + f.gain.v[lane] * motion.z(table_row_[table], lane);
  const std::size_t entry = table * kLanes + idx(lane);
  const bool serves = std::abs(angle - k.angle.v[lane]) <= reach_[entry];
  const TableLoads::Nearest found = tables_.nearest(static_cast<int>(entry), angle);
  k.angle.v[lane] = found.angle;
  k.value.v[lane] = found.value, k.left.v[lane] = found.left, k.right.v[lane] = found.right;
  steepness_[table].v[lane] =
      std::max(std::abs(found.left), std::abs(found.right)) * std::abs(f.gain.v[lane]);
  taken_ = true;
  return serves;
}

void LaneLoads::evaluate_by_lane(const LaneMotion& motion, const LaneMask& open, bool moving) {
  for (Evaluated& load : evaluated_)
    for (int lane = 0; lane < kLanes; ++lane)
      if (open[lane] && load.moves == moving) {
        const double n = load.ratio.v[lane], c = load.coeff.v[lane], rate = n * phi_rate_.v[lane];
        load.torque.v[lane] = load.loads[idx(lane)]
                                  ->evaluate({t_, n * phi_.v[lane], c * motion.z(load.row, lane),
                                              rate + c * motion.v(load.row, lane), rate})
                                  .torque;
      }
}

struct LaneLoadKernels {
  /// The sums of some rows, with their tables about the knots that they have. Bit (table - first) of left: it
  /// is nearer to another one.
  template <class T>
  [[gnu::always_inline]] static inline void rows(const LaneLoads& l, const LaneLoads::Factors<T>* factors,
                                                 int first, int end, const LaneMotion& motion,
                                                 const LaneMask& open, LaneRow* p, LaneMask& left) {
    const LaneLoads::Row* row = l.rows_.data() + first;
    const LaneLoads::Row* const behind = l.rows_.data() + end;
    const LaneLoads::Knot* knots = l.knots_.data();
    const LaneRow* base = l.base_is_zero_ ? nullptr : l.base_.data();
    const Lanes phi = l.phi_.v;
    const LaneMask in = open;
    LaneMask out{}, bit = LaneMask{} + 1;
    for (; row != behind; ++row) {
      const Lanes z = motion.z_0[row->row].v + motion.kappa_z * motion.a[row->row].v;
      Lanes sum = base ? base[row->row].v : Lanes{};
      for (int i = row->first; i < row->end; ++i) {
        const LaneLoads::Knot& k = knots[i];
        const LaneLoads::Factors<T>& f = factors[i];
        const Lanes d = (each(f.ratio) * phi - k.angle.v) + each(f.gain) * z;
        Lanes distance = d;
        magnitude(distance);
        out = distance > each(f.width) ? out | bit : out;
        bit += bit;
        sum += k.value.v + (d < 0.0 ? k.left.v : k.right.v) * d;
      }
      for (int i = row->first_evaluated; i < row->end_evaluated; ++i)
        sum += l.evaluated_.data()[i].coeff.v * l.evaluated_.data()[i].torque.v;
      p[row->row].v = in ? sum : p[row->row].v;
    }
    left = out & in;
  }

  DREV_WIDEST static bool evaluate(const LaneLoads& l, int first, int end, const LaneMotion& motion,
                                   const LaneMask& open, LaneRow* p, LaneMask& left) {
    if (!l.common_factors_.empty())
      rows(l, l.common_factors_.data(), first, end, motion, open, p, left);
    else
      rows(l, l.factors_.data(), first, end, motion, open, p, left);
    return any(left);
  }

  DREV_WIDEST static void most(const LaneArray& of, LaneRow& out) {
    Lanes m{};
    for (const LaneRow& x : of) m = m < x.v ? x.v : m;
    out.v = m;
  }
};

void LaneLoads::evaluate(const LaneMotion& motion, const LaneMask& open, LaneArray& p) {
  if (!evaluated_.empty()) {
    if (moved_) evaluate_by_lane(motion, open, false);
    if (evaluated_move_) evaluate_by_lane(motion, open, true);
  }
  if (moved_)
    for (const int i : unloaded_) p[idx(i)] = base_[idx(i)];
  moved_ = false;
  for (std::size_t g = 0; g + 1 < groups_.size(); ++g) {
    const int first = groups_[g], end = groups_[g + 1];
    LaneMask left;
    if (!LaneLoadKernels::evaluate(*this, first, end, motion, open, p.data(), left)) continue;
    const auto begin = idx(rows_[idx(first)].first);
    LaneMask leapt{};  // a lane that did not keeps its sum: it does not depend on its neighbours
    for (int lane = 0; lane < kLanes; ++lane)
      for (auto bits = static_cast<std::uint64_t>(left[lane]); bits != 0; bits &= bits - 1)
        if (!take_nearest(begin + static_cast<std::size_t>(std::countr_zero(bits)), lane, motion))
          leapt[lane] = -1;
    if (any(leapt)) LaneLoadKernels::evaluate(*this, first, end, motion, leapt, p.data(), left);
  }
}

void LaneLoads::steepness(LaneRow& out) {
  if (taken_) LaneLoadKernels::most(steepness_, steepest_);
  taken_ = false;
  out = steepest_;
}

}  // namespace drev
