#include <drev/core/assembler.hpp>
#include <drev/solvers/run/channel_values.hpp>
#include <drev/solvers/run/evaluated_state.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace drev {

namespace {

constexpr int kMostHalvings = 12;

/// Kronrod's rule on [-1, 1]: points > 0 and the middle; those of odd number are Gauss's of 7 points.
constexpr std::array<double, 8> kPoints{0.991455371120812639206854697526, 0.949107912342758524526189684048,
                                        0.864864423359769072789712788641, 0.741531185599394439863864773281,
                                        0.586087235467691130294144691693, 0.405845151377397166906606412077,
                                        0.207784955007898467600689403773, 0.0};
constexpr std::array<double, 8> kKronrod{0.022935322010529224963732008059, 0.063092092629978553290700663189,
                                         0.104790010322250183839876322542, 0.140653259715525918745189590510,
                                         0.169004726639267902826583426599, 0.190350578064785409913256402421,
                                         0.204432940075298892414161999235, 0.209482141084727828012999174892};
constexpr std::array<double, 4> kGauss{0.129484966168869693270611432679, 0.279705391489276667901467771424,
                                       0.381830050505118944950369775489, 0.417959183673469387755102040816};

}  // namespace

ChannelValues::ChannelValues(std::vector<Channel> channels)
    : channels_(std::move(channels)), place_(channels_.size(), -1) {
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    if (!channels_[c].over_run()) continue;
    place_[c] = static_cast<int>(integrals_.size());
    integrals_.push_back(c);
  }
  sums_.resize(integrals_.size());
  sizes_.resize(integrals_.size());
}

std::vector<double> ChannelValues::integrands(const Assembler& assembler, const EvaluatedState& point) const {
  std::vector<double> values;
  for (const std::size_t c : integrals_) values.push_back(channels_[c].integrand(assembler, point.state));
  return values;
}

void ChannelValues::start(const Assembler& assembler, const EvaluatedState& point) {
  std::fill(sums_.begin(), sums_.end(), 0.0);
  std::fill(sizes_.begin(), sizes_.end(), 0.0);
  restart(assembler, point);
}

void ChannelValues::restart(const Assembler& assembler, const EvaluatedState& point) {
  if (!integrals_.empty() && !motion_) last_ = integrands(assembler, point);
}

void ChannelValues::step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) {
  if (integrals_.empty()) return;
  const double h = to.state.t - from.state.t;
  if (motion_) {
    if (h > 0.0) add(from.state.t, to.state.t, kMostHalvings);
    return;
  }
  const std::vector<double> before = std::move(last_);
  last_ = integrands(assembler, to);
  for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += 0.5 * h * (before[i] + last_[i]);
}

void ChannelValues::add(double t_0, double t_1, int depth) {
  const double half = 0.5 * (t_1 - t_0), middle = 0.5 * (t_0 + t_1);
  std::vector<double> kronrod(sums_.size()), gauss(sums_.size()), size(sums_.size());
  const auto look = [&](double t, std::size_t point) {
    const StepMotion::Point inside = motion_->at(t);
    const std::vector<double> y = integrands(inside.assembler, inside.at);
    for (std::size_t i = 0; i < y.size(); ++i) {
      kronrod[i] += half * kKronrod[point] * y[i];
      size[i] += half * kKronrod[point] * std::abs(y[i]);
      if (point % 2 == 1) gauss[i] += half * kGauss[point / 2] * y[i];
    }
  };
  for (std::size_t point = 0; point < kPoints.size(); ++point) {
    look(middle - half * kPoints[point], point);
    if (kPoints[point] > 0.0) look(middle + half * kPoints[point], point);
  }
  bool settled = depth == 0 || !(middle > t_0 && middle < t_1);
  if (!settled) {
    settled = true;
    // The difference d of the rules is the error of Gauss's; Kronrod's is about (200 d)^1.5 (QUADPACK).
    static const double most = std::pow(kTolerance, 2.0 / 3.0) / 200.0;
    for (std::size_t i = 0; i < sums_.size(); ++i)
      settled = settled && !(std::abs(kronrod[i] - gauss[i]) > most * (sizes_[i] + size[i]));
  }
  if (!settled) {
    add(t_0, middle, depth - 1);
    add(middle, t_1, depth - 1);
    return;
  }
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    sums_[i] += kronrod[i];
    sizes_[i] += size[i];
  }
}

double ChannelValues::value(std::size_t c, const Assembler& assembler, const EvaluatedState& point) const {
  return place_[c] >= 0 ? sums_[static_cast<std::size_t>(place_[c])]
                        : channels_[c].evaluate(assembler, point.state);
}

bool ChannelValues::needs_acceleration() const {
  return std::any_of(channels_.begin(), channels_.end(),
                     [](const Channel& c) { return c.value_needs_acceleration(); });
}

bool ChannelValues::watches_loads() const {
  return std::any_of(integrals_.begin(), integrals_.end(),
                     [this](std::size_t c) { return channels_[c].follows_loads(); });
}

}  // namespace drev
