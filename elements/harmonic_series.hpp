#pragma once
/// HarmonicSeries: Taylor series of mean + sum A_i cos(w_i), w_i = order_i theta + phase_i, along a
/// motion.
///
///   k c_k = -sum_{j=1..k} j w_j s_{k-j}        k s_k = sum_{j=1..k} j w_j c_{k-j}
///
/// for cos w = sum c_k s^k and sin w = sum s_k s^k. Exact to every degree. Source: recurrences of
/// automatic differentiation, e.g. A. Griewank, A. Walther, Evaluating Derivatives, SIAM, 2008,
/// chapter 13.
#include "core/load.hpp"
#include "elements/harmonic.hpp"

namespace drev {

class HarmonicSeries final : public LoadSeries {
 public:
  HarmonicSeries(double mean, std::vector<Harmonic> harmonics)
      : mean_(mean), harmonics_(std::move(harmonics)), waves_(harmonics_.size()) {}

  double coefficient(int k, const std::vector<double>& angle) override {
    double sum = k == 0 ? mean_ : 0.0;
    for (std::size_t i = 0; i < harmonics_.size(); ++i) {
      extend(waves_[i], harmonics_[i], static_cast<std::size_t>(k), angle);
      sum += harmonics_[i].amplitude * waves_[i].cosine.back();
    }
    return sum;
  }

 private:
  struct Wave {
    std::vector<double> cosine, sine;
  };
  static void extend(Wave& w, const Harmonic& h, std::size_t k, const std::vector<double>& angle) {
    if (k == 0) {
      const double argument = h.order * angle[0] + h.phase;
      w.cosine.assign(1, std::cos(argument));
      w.sine.assign(1, std::sin(argument));
      return;
    }
    double c = 0.0, s = 0.0;
    for (std::size_t j = 1; j <= k; ++j) {
      const double rate = static_cast<double>(j) * h.order * angle[j];
      c -= rate * w.sine[k - j];
      s += rate * w.cosine[k - j];
    }
    w.cosine.push_back(c / static_cast<double>(k));
    w.sine.push_back(s / static_cast<double>(k));
  }

  double mean_;
  std::vector<Harmonic> harmonics_;
  std::vector<Wave> waves_;
};

}  // namespace drev
