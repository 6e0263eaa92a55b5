#include <drev/core/ids.hpp>
#include <drev/core/law/piecewise_law.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace drev {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSameKink = 1e-14;  // relative: bounds that are one except for rounding

bool is_elastic(const LawPiece& p) { return p.elastic_0 != 0.0 || p.elastic_k != 0.0; }

/// A point between the two, either of which may be infinite.
double between(double low, double high) {
  if (low == -kInfinity) return high == kInfinity ? 0.0 : high - std::max(1.0, std::abs(high));
  return high == kInfinity ? low + std::max(1.0, std::abs(low)) : 0.5 * (low + high);
}

/// The slope of two sides: the mean, or the one that is not zero.
double of_both(double a, double b) { return a == 0.0 || b == 0.0 ? std::max(a, b) : 0.5 * (a + b); }

}  // namespace

PiecewiseLaw::PiecewiseLaw(std::vector<LawPiece> pieces) : pieces_(std::move(pieces)) {
  if (pieces_.empty()) return;
  find_kinks();
  std::vector<Line> all = lines();
  find_energies(all);
  find_candidates(all);
  find_gap();
  find_closed();
}

std::vector<LawPiece> PiecewiseLaw::scaled(double s) const {
  std::vector<LawPiece> all = pieces_;
  for (LawPiece& p : all) {
    for (double* part : {&p.y_0, &p.k, &p.elastic_0, &p.elastic_k}) *part *= s;
    for (LawBound& b : p.bounds)
      if (b.b_v != 0.0) b.a *= s, b.b_x *= s;
  }
  return all;
}

void PiecewiseLaw::find_kinks() {
  for (const LawPiece& p : pieces_)
    for (const LawBound& b : p.bounds)
      if (b.in_x_alone() && std::isfinite(b.kink())) edges_.push_back(b.kink());
  std::sort(edges_.begin(), edges_.end());
  const auto same = [](double a, double b) {
    return b - a <= kSameKink * std::max(std::abs(a), std::abs(b));
  };
  edges_.erase(std::unique(edges_.begin(), edges_.end(), same), edges_.end());
  edges_.push_back(kInfinity);
}

std::size_t PiecewiseLaw::count_below(double x) const {
  const std::span<const double> all = kinks();
  return idx(static_cast<int>(std::lower_bound(all.begin(), all.end(), x) - all.begin()));
}

void PiecewiseLaw::find_candidates(const std::vector<Line>& lines) {
  const std::size_t zones = edges_.size();
  const auto middle = [&](std::size_t zone) {
    return between(zone == 0 ? -kInfinity : edges_[zone - 1], edges_[zone]);
  };
  zone_begin_.assign(zones + 1, 0);
  std::vector<std::pair<std::size_t, std::size_t>> spans(pieces_.size());  // zones of each piece
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const Interval range = pieces_[i].x_range();
    // The zones whose middle lies in the range, whatever the rounding of its ends.
    auto& [first, end] = spans[i];
    first = range.low == -kInfinity ? 0 : count_below(range.low);
    while (first < zones && !(middle(first) > range.low)) ++first;
    for (end = first; end < zones && !(middle(end) > range.high); ++end) ++zone_begin_[end + 1];
  }
  std::partial_sum(zone_begin_.begin(), zone_begin_.end(), zone_begin_.begin());
  candidates_.resize(idx(zone_begin_.back()));
  std::vector<int> next = zone_begin_;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const auto first = static_cast<int>(bounds_.size());
    for (const LawBound& b : pieces_[i].bounds)
      if (!b.in_x_alone()) bounds_.push_back(b);
    const Candidate candidate{lines[i], static_cast<int>(i), first, static_cast<int>(bounds_.size())};
    for (std::size_t zone = spans[i].first; zone < spans[i].second; ++zone)
      candidates_[idx(next[zone]++)] = candidate;
  }
  if (candidates_.empty()) candidates_.push_back({lines.front()});  // pieces that hold nowhere
}

std::vector<PiecewiseLaw::Line> PiecewiseLaw::lines() const {
  std::vector<Line> all;
  for (const LawPiece& p : pieces_) {
    const Interval range = p.x_range();
    const double zero = -p.elastic_0 / p.elastic_k;  // not finite for a constant force
    const double origin = std::min(std::max(std::isfinite(zero) ? zero : 0.0, range.low), range.high);
    Line l{.origin = origin, .k = p.k, .product = p.product, .half_k = 0.5 * p.elastic_k};
    l.y = p.y_0 + p.k * origin;
    l.c = p.c + p.product * origin;
    l.elastic = origin == zero ? 0.0 : p.elastic_0 + p.elastic_k * origin;
    if (p.y_0 == p.elastic_0 && p.k == p.elastic_k) l.y = l.elastic;
    l.lost = l.y - l.elastic;
    l.lost_k = p.k - p.elastic_k;
    all.push_back(l);
  }
  return all;
}

/// From piece to piece over their bounds, where the energy is continuous; then the least is made 0.
void PiecewiseLaw::find_energies(std::vector<Line>& lines) const {
  std::vector<bool> known(pieces_.size(), false);
  std::vector<std::size_t> open{0};
  known[0] = true;
  while (!open.empty()) {
    const std::size_t i = open.back();
    open.pop_back();
    for (const LawBound& b : pieces_[i].bounds) {
      if (b.next < 0 || idx(b.next) >= pieces_.size() || known[idx(b.next)]) continue;
      Line& next = lines[idx(b.next)];
      const double x = b.in_x_alone() ? b.kink() : lines[i].origin;
      next.energy += lines[i].stored(x) - next.stored(x);
      known[idx(b.next)] = true;
      open.push_back(idx(b.next));
    }
  }
  double least = kInfinity;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const Interval range = pieces_[i].x_range();
    for (const double x : {range.low, lines[i].origin, range.high})
      if (std::isfinite(x)) least = std::min(least, lines[i].stored(x));
  }
  if (!std::isfinite(least)) return;
  for (Line& l : lines) l.energy = std::max(l.energy - least, 0.0);
}

void PiecewiseLaw::find_gap() {
  if (kinks().empty() || std::none_of(pieces_.begin(), pieces_.end(), is_elastic)) return;
  for (const LawPiece& p : pieces_) {
    if (is_elastic(p)) continue;
    const Interval range = p.x_range();
    if (!gap_) gap_ = Gap{range.low, range.high};
    gap_->low = std::min(gap_->low, range.low);
    gap_->high = std::max(gap_->high, range.high);
  }
}

void PiecewiseLaw::find_closed() {
  const auto at = [&](double place, double x) -> ScalarResponse {
    const LawPiece& p = pieces_[idx(piece_at(pieces_, place, 0.0))];
    return {.dy_dx = p.k, .dy_dx_dot = p.c + p.product * x};
  };
  if (gap_) {
    const double low = kinks().front(), high = kinks().back();
    const ScalarResponse a = at(between(-kInfinity, low), low), b = at(between(high, kInfinity), high);
    closed_ = {.dy_dx = of_both(a.dy_dx, b.dy_dx), .dy_dx_dot = of_both(a.dy_dx_dot, b.dy_dx_dot)};
    return;
  }
  const auto above = std::upper_bound(edges_.begin(), edges_.end(), 0.0);
  closed_ = at(between(above == edges_.begin() ? -kInfinity : *(above - 1), *above), 0.0);
}

const PiecewiseLaw::Line& PiecewiseLaw::line_on_edge(double x, double x_dot, double s) const {
  const int piece = piece_at(pieces_, x, x_dot / s);
  const auto found = std::find_if(candidates_.begin(), candidates_.end(),
                                  [&](const Candidate& c) { return c.piece == piece; });
  return found == candidates_.end() ? candidates_.front().line : found->line;
}

}  // namespace drev
