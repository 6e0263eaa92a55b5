#include "solvers/exact/kink_response.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "solvers/linear/lane_pair.hpp"

namespace drev {

namespace {

constexpr int kLeastSwept = 8, kMostCuts = 20;
// Largest motion that kinks may add in a step, relative to all: moments of a few powers tell the loss by one that bends so only in part.
constexpr double kMostResponse = 0.01;
constexpr int kMostKinks = 1000;  // kinks in a step; what they do to each other is bounded pair by pair
// Part of what is allowed that pairs of kinks may add up to by their bound.
constexpr double kMostRowsApart = 0.5;
constexpr double kOfShare = 0.1;      // part of a step's share that a sweep of finite degree may leave out
constexpr double kRuleMargin = 10.0;  // margin on what Gauss's rule leaves out, since angles bend, too
constexpr double kOfRule = 0.1;       // part of what a sweep may leave out that cut series of angles may take
constexpr double kPlace = 1e-4;       // largest error of a knot's place, relative to the step
// Factor on the part of the step behind a kink over which slopes change little enough.
constexpr double kShortened = 0.9;
// Part of the share of a motion that is not found exactly that a first sweep alone may be off by; where it has to be exact, more is.
constexpr double kOfInexact = 0.25;

/// sum_ik gain_i pull_k (beside d^6 + apart d^8) where place_i < end is d > 0 behind place_k, of kinks in whole lanes with gains and
/// pulls of zero behind the last one.
struct RowsApart {
  template <class L>
  [[gnu::always_inline]] static double run(int count, double end, const double* place, const double* pull,
                                           const double* gain, double beside, double apart) {
    L sum{};
    for (int k = 0; k < count; k += kLanes) {
      L from, of_all{}, x;
      load(place + k, from);
      for (int i = 0; i < count; ++i) {
        if (place[i] >= end) continue;
        L d{};
        raise(d, place[i] - from);
        d *= d;
        of_all += (gain[i] * (d * d * d)) * (beside + apart * d);
      }
      load(pull + k, x);
      sum += x * of_all;
    }
    return sum_of(sum);
  }
};

}  // namespace

void KinkResponse::undo() {
  return_slopes();
  found_ = false;
}

void KinkResponse::return_slopes() {
  if (slopes_changed_) {
    laws_.return_slopes(series_);
    loads_.return_slopes(series_);
  }
  slopes_changed_ = false;
}

/// Lists the kinks up to s = end. False: some are none of this kind, or too much for a sweep.
bool KinkResponse::list(double end, const double* z_end, double share) {
  listed_to_ = -1.0;
  if (!loads_.list_sweep_kinks(series_, end, z_end) || !find_size(end, share)) return false;
  listed_to_ = end;
  return true;
}

bool KinkResponse::look(double share) {
  found_ = slopes_changed_ = limited_ = corrects_ = false;
  limit_ = 1.0;
  rate_step_ = series_.rate() * series_.step();
  return list(1.0, nullptr, share);
}

bool KinkResponse::find_size(double end, double share) {
  const int count = loads_.kinks().count();
  if (count == 0) return true;
  if (count > kMostKinks) return false;
  // |y| <= pull end^3/6, and each degree of the sweep adds rate h end/(j + 3) of the one before.
  const double h = series_.step(), growth = rate_step_ * end;
  double scale = 0.0;
  for (std::size_t kind = 0; kind < 2; ++kind)
    if (series_.z_scale()[kind] > 0.0)
      scale = std::max(scale, h / std::min(series_.z_scale()[kind] / h, series_.v_scale()[kind]));
  if (!(scale > 0.0) || !std::isfinite(scale)) return false;  // nothing has moved before
  const double response = loads_.kink_sizes().most_pull() * 0.5 * scale * end * end;
  double rest = response;
  if (response > kMostResponse) return false;
  int degree = 0;
  while (degree < TaylorSeries::kMostSwept && (degree < kLeastSwept || rest > kOfShare * share))
    rest *= growth * kInverse[idx(++degree + 2)];
  size_ = {scale, response, rest, degree};
  return !(rest > kOfShare * share);
}

bool KinkResponse::find(double end, const double* z_end, double share) {
  undo();
  if (listed_to_ != end && !list(end, z_end, share)) return false;
  end_ = end;
  KinkMoments& kinks = loads_.kinks();
  if (kinks.count() == 0) return limited_ = found_ = true;
  loads_.use_slopes(series_, end);
  laws_.use_slopes(series_, end);
  slopes_changed_ = true;
  const int degree = size_.degree;
  const Rule rule = rule_for(size_.response, rate_step_ * end, kOfShare * share, size_.scale, end);
  loads_.expand_kinks(series_, rule.terms);
  TaylorSeries::RowMoments moments = kinks.find_moments(end, degree, rule.nodes, rule.place_terms);
  moments.own_rows = !loads_.kinks_share_rows();
  if (laws_.active()) {  // which read all parts of the motion
    moments_.resize(idx((TaylorSeries::kMostSwept + 1) * series_.stride()), 0.0);
    series_.add_to_columns(moments, degree, moments_.data());
    series_.sweep(moments_.data(), degree);
  } else {
    series_.sweep(moments, degree);
  }
  const bool holds = limited_ || find_limit(end, share - size_.rest, size_.scale);
  limited_ = true;
  if (!holds || !corrects_ || uncorrected_ <= kOfInexact * share) return found_ = holds;
  series_.add_to_columns(moments, degree, moments_.data());
  laws_.add_changes(series_, degree, moments_.data());
  series_.sweep(moments_.data(), degree);
  return found_ = true;
}

/// The rule for kinks that respond by no more than `response` of the motion, with an error of `allowed`: n nodes of Gauss leave
/// (n!)^4/((2 n + 1) (2 n)!^3) growth^(2 n) of an integral with exp(rate h s); so many terms of the angles that the force behind
/// the knot is right; and so many that its place is, of whose error the square counts.
KinkResponse::Rule KinkResponse::rule_for(double response, double growth, double allowed, double scale,
                                          double end) const {
  Rule rule;
  const KinkMoments& kinks = loads_.kinks();
  if (!kinks.straight()) return rule;
  constexpr std::array<double, 2> kLeaves{5.6e-10, 1.9e-16};
  const double square = growth * growth, fourth = square * square;
  const std::array<double, 2> powers{fourth * fourth, fourth * fourth * fourth};  // 2 kSweepRules[i]
  static_assert(KinkMoments::kSweepRules[0] == 4 && KinkMoments::kSweepRules[1] == 6);
  for (std::size_t i = 0; i < kLeaves.size(); ++i)
    if (kRuleMargin * response * kLeaves[i] * powers[i] <= allowed) {
      rule.nodes = KinkMoments::kSweepRules[i];
      break;
    }
  const double gain = loads_.kink_sizes().most_gain(), rate = loads_.kink_sizes().least_rate();
  const double z = std::max(series_.z_scale()[0], series_.z_scale()[1]);
  rule.terms = idx(series_.terms_within(kOfRule * allowed / (gain * scale * end * z)));
  const double place = std::min(kPlace, end * std::sqrt(kOfRule * allowed / response));
  rule.place_terms = idx(series_.terms_within(place * rate / z));
  return rule;
}

/// Finds where the step, found up to s = end, has to end for what is left out to be below `allowed` over the scale. False: nowhere.
bool KinkResponse::find_limit(double end, double allowed, double scale) {
  const double most = allowed / scale;
  double limit = end;
  const bool slopes = loads_.expanded().active() || laws_.active();
  ExpandedLoads::SlopeChange change = loads_.expanded().slope_change(series_);
  change.by_angle += loads_.slope_behind();
  for (int cuts = 0; cuts < kMostCuts; ++cuts) {
    const Others bends = slopes ? error_of_slopes(limit, change, 0.5 * most) : Others{};
    if (bends.error > 0.5 * most && !corrects_ && laws_.active()) {
      uncorrected_ = scale * bends.error;  // here, the limit is the end still
      corrects_ = true;
      continue;
    }
    if (bends.error > 0.5 * most) {
      const double behind = limit - bends.between;
      limit = bends.between + behind * kShortened * std::pow(0.5 * most / bends.error, 0.2);
      continue;
    }
    const Others others = error_of_others(limit, most);
    if (others.error + bends.error <= most) {
      limit_ = limit < end ? limit : 1.0;
      return true;
    }
    limit = others.between;
  }
  return false;
}

/// Of the motion of a row that a force on it sets in, what the deflection of a law moves in d of the step: all of it where the
/// law acts on the row; else k/m h^2 d^2/20 one row away, about (rate h)^4/16 d^4/840 further off (error_of_others()).
double KinkResponse::nearness(int row, const ScalarTerm& law, double d) const {
  const double h = series_.step(), quarter = quarter_rate_square(), d_2 = d * d;
  double coupling = 0.0;
  for (const Entry& e : law.z) {
    if (e.index == row) return 1.0;
    coupling = std::max(coupling, series_.coupling(row, e.index));
  }
  return std::min(1.0, h * h * coupling * d_2 / 20.0 + quarter * quarter * (d_2 * d_2) / 840.0);
}

/// What slopes of smooth loads and laws that change towards the end make of y = pull u^3/6 at u behind a kink, d of the step before
/// the end: int (d - u) (d - u) u^3/6 du = d^6/360 of what the slope changes, of one by speed d^5/60, and d^5/120 of a slope that is
/// left out. Where add_changes() has been, of laws the square of that over y, and what the derivative behind those makes, the fourth:
/// int (d - u) (d - u)^4/24 u^3/6 du = d^9/72576, by speed d^8/8064. between: the s of the kink that makes most of it. Behind
/// add_changes(), nearness is found where it is needed to come below `enough`.
KinkResponse::Others KinkResponse::error_of_slopes(double end, const ExpandedLoads::SlopeChange& change,
                                                   double enough) const {
  Others sum = error_of_slopes(end, change, !corrects_);
  if (corrects_ && sum.error > enough) sum = error_of_slopes(end, change, true);
  return sum;
}

KinkResponse::Others KinkResponse::error_of_slopes(double end, const ExpandedLoads::SlopeChange& change,
                                                   bool by_nearness) const {
  static_assert(ExpandedLaws::kChanges == 3);
  const KinkMoments& kinks = loads_.kinks();
  const double h = series_.step(), square = h * h;
  const auto first_order = [&](double by_angle, double by_speed, double d) {
    return square * by_angle * d * (1.0 / 360.0) + h * by_speed * (1.0 / 60.0);
  };
  Others sum;
  double most = -1.0;
  for (int i = 0; i < kinks.count(); ++i) {
    const double d = std::max(0.0, end - kinks.place(i)), d_2 = d * d;
    double of_slopes = first_order(change.by_angle, change.by_speed, d);
    for (const ExpandedLaws::SlopeChange& law : laws_.slope_changes()) {
      double of_law = first_order(law.by_angle, law.by_speed, d);
      if (corrects_) {
        const double behind =
            square * law.by_angle_behind * d * (1.0 / 72576.0) + h * law.by_speed_behind * (1.0 / 8064.0);
        of_law = 6.0 * of_law * of_law * d_2 + d_2 * d * behind;
      }
      of_law += square * law.left_out * (1.0 / 120.0);
      if (by_nearness) of_law *= nearness(kinks.row(i), *law.term, d);
      of_slopes = std::max(of_slopes, of_law);
    }
    const double error = loads_.kink_sizes().pull()[i] * (d_2 * d_2 * d) * of_slopes;
    sum.error += error;
    if (error > most) {
      most = error;
      sum.between = kinks.place(i);
    }
  }
  return sum;
}

/// What kinks add to rows of later kinks ahead of these, and what these make of it, up to s = end: of a kink ahead by d in
/// the same row pull d^3/6, one row away k/m h^2 pull d^5/120, two rows away about (rate h)^4/16 pull d^7/5040, three or more
/// (rate h)^6/64 pull d^9/362880, as in a chain of equal rows, whose couplings are a quarter of (rate h)^2.
KinkResponse::Others KinkResponse::error_of_others(double end, double allowed) {
  const KinkMoments& kinks = loads_.kinks();
  const double *gain = loads_.kink_sizes().gain(), *pull = loads_.kink_sizes().pull();
  const double h = series_.step(), square = h * h;
  // (2 j + 4)! of rows j apart.
  const double quarter = quarter_rate_square(), beside = square / 720.0, two = quarter * quarter / 40320.0,
               more = quarter * quarter * quarter / 3628800.0;
  Others others;
  if (!loads_.kinks_share_rows()) {
    const double apart = std::max(two, more);
    for (const bool coarse : {true, false}) {
      others.error = square * bound_of_rows_apart(end, beside, apart, coarse);
      if (others.error <= kMostRowsApart * allowed) return others;
    }
    others.error = 0.0;
  }
  double most = 0.0;
  for (int i = 0; i < kinks.count(); ++i) {
    if (kinks.place(i) >= end) continue;
    for (int k = 0; k < kinks.count(); ++k) {
      const double d = kinks.place(i) - kinks.place(k);
      if (!(d > 0.0)) continue;
      const double d_2 = d * d, d_4 = d_2 * d_2;
      double error = square * gain[i] * pull[k] * d_4;
      const int row = kinks.row(i), other = kinks.row(k);
      if (row == other)
        error /= 24.0;
      else if (const double coupling = series_.coupling(row, other); coupling > 0.0)
        error *= d_2 * (beside * coupling + two * d_2);
      else
        error *= d_4 * (series_.share_neighbour(row, other) ? two : more * d_2);
      others.error += error;
      if (error > most) {
        most = error;
        others.between = 0.5 * (kinks.place(i) + kinks.place(k));
      }
    }
  }
  return others;
}

/// A bound of error_of_others() over h^2 where each kink has a row of its own: neighbours by their couplings, or, coarse, all by the
/// largest one; and all as if they were two rows apart.
double KinkResponse::bound_of_rows_apart(double end, double beside, double apart, bool coarse) {
  const KinkMoments& kinks = loads_.kinks();
  const double *gain = loads_.kink_sizes().gain(), *pull = loads_.kink_sizes().pull();
  double sum = run_widest<RowsApart>(kinks.count(), end, kinks.places(), pull, gain,
                                     coarse ? beside * series_.largest_coupling() : 0.0, apart);
  if (coarse) return sum;
  on_row_.resize(idx(series_.stride()));
  for (int i = 0; i < kinks.count(); ++i) on_row_[idx(kinks.row(i))] = {kinks.place(i), pull[i]};
  for (int i = 0; i < kinks.count(); ++i) {
    const int row = kinks.row(i);
    const double place = kinks.place(i);
    double of_neighbours = 0.0;
    series_.for_row(row, [&](int other, double stiffness) {
      const auto& beside_it = on_row_[idx(other)];
      // max(0, ahead) without a branch: no processor can foretell which of the two comes first.
      const double ahead = place - beside_it.place, d = 0.5 * (ahead + std::abs(ahead)), d_2 = d * d;
      of_neighbours += stiffness * beside_it.pull * (d_2 * d_2 * d_2);
    });
    sum += (place < end ? beside * gain[i] * series_.mobility(row) : 0.0) * of_neighbours;
  }
  for (int i = 0; i < kinks.count(); ++i) on_row_[idx(kinks.row(i))] = {};
  return sum;
}

}  // namespace drev
