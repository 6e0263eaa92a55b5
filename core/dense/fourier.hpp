#pragma once
/// Discrete Fourier transforms. Eigen's are compiled here once: their templates take seconds of compilation wherever they
/// are used.
#include <complex>
#include <memory>
#include <vector>

namespace drev {

/// Keeps the twiddle factors of the lengths that it has transformed; one thread at a time.
class FourierTransform {
 public:
  FourierTransform();
  ~FourierTransform();

  /// X_k = sum_j x_j e^{-2 pi i j k / N}, k = 0 to N/2, of N real values, N at least 2.
  void forward(std::vector<std::complex<double>>& lines, const std::vector<double>& values);

  /// Its inverse, N real values x_j = (1/N) sum_k X_k e^{2 pi i j k / N} over k = 0 to N - 1, X_{N-k} the conjugate of X_k,
  /// of which lines 0 to N/2 are given. `count` is N, at least 2.
  void inverse(std::vector<double>& values, const std::vector<std::complex<double>>& lines, int count);

 private:
  struct Plans;
  std::unique_ptr<Plans> plans_;
};

}  // namespace drev
