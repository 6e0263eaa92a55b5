#pragma once
/// Integrals over a reference run: means, mean squares and Fourier coefficients of channels.
#include <complex>
#include <vector>

#include "tests/stability/coverage/reference_run.hpp"

namespace coverage {

/// Of each channel over [begin, end]; a watcher of a run. Gauss's rule on every step.
class Averages {
 public:
  /// Coefficients of exp(-i n omega t), n = 0 ... harmonics.
  Averages(std::vector<ChannelId> channels, Real begin, Real end, Real omega = 0, int harmonics = 0);
  void operator()(const ReferenceStep& step);

  Real mean(std::size_t channel) const { return sums_[channel].value / (end_ - begin_); }
  Real mean_square(std::size_t channel) const { return sums_[channel].square / (end_ - begin_); }
  /// a_n of y = Re sum a_n exp(i n omega t): twice the coefficient, except for n = 0.
  std::complex<Real> amplitude(std::size_t channel, int n) const;

 private:
  struct Sum {
    Real value = 0, square = 0;
    std::vector<std::complex<Real>> waves;
  };
  std::vector<ChannelId> channels_;
  Real begin_, end_, omega_;
  std::vector<Sum> sums_;
};

}  // namespace coverage
