#include "tests/stability/coverage/reference_averages.hpp"

#include <algorithm>

namespace coverage {

namespace {

constexpr int kPoints = 20;

struct GaussRule {
  Real node[kPoints], weight[kPoints];  // on [0, 1]
  GaussRule() {
    for (int i = 0; i < kPoints; ++i) {
      Real x = std::cos(kTurn / 2 * (i + 0.75L) / (kPoints + 0.5L)), slope = 1;
      for (int k = 0; k < 50; ++k) {
        Real p = 1, before = 0;
        for (int j = 1; j <= kPoints; ++j) {
          const Real next = ((2 * j - 1) * x * p - (j - 1) * before) / j;
          before = p, p = next;
        }
        slope = kPoints * (x * p - before) / (x * x - 1);
        x -= p / slope;
      }
      node[i] = (1 + x) / 2, weight[i] = 1 / ((1 - x * x) * slope * slope);
    }
  }
};

}  // namespace

Averages::Averages(std::vector<ChannelId> channels, Real begin, Real end, Real omega, int harmonics)
    : channels_(std::move(channels)), begin_(begin), end_(end), omega_(omega), sums_(channels_.size()) {
  for (Sum& s : sums_) s.waves.resize(static_cast<std::size_t>(omega > 0 ? harmonics + 1 : 0));
}

void Averages::operator()(const ReferenceStep& step) {
  static const GaussRule rule;
  const Real from = std::max(begin_, step.t), to = std::min(end_, step.t + step.h);
  if (!(to > from)) return;
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const Poly y = step.model.channel(channels_[c]);
    for (int i = 0; i < kPoints; ++i) {
      const Real t = from + (to - from) * rule.node[i], w = (to - from) * rule.weight[i];
      const Real value = y.value(t - step.t);
      sums_[c].value += w * value, sums_[c].square += w * value * value;
      if (sums_[c].waves.empty()) continue;
      const std::complex<Real> turn = std::polar<Real>(1, -omega_ * t);
      std::complex<Real> wave = 1;
      for (std::complex<Real>& sum : sums_[c].waves) sum += w * value * wave, wave *= turn;
    }
  }
}

std::complex<Real> Averages::amplitude(std::size_t channel, int n) const {
  return sums_[channel].waves[static_cast<std::size_t>(n)] * static_cast<Real>(n == 0 ? 1 : 2) /
         (end_ - begin_);
}

}  // namespace coverage
