#include "core/dense/fourier.hpp"

#include <unsupported/Eigen/FFT>

namespace drev {

struct FourierTransform::Plans {
  Eigen::FFT<double> fft{Eigen::FFT<double>::impl_type(), Eigen::FFT<double>::HalfSpectrum};
};

FourierTransform::FourierTransform() : plans_(std::make_unique<Plans>()) {}
FourierTransform::~FourierTransform() = default;

void FourierTransform::forward(std::vector<std::complex<double>>& lines, const std::vector<double>& values) {
  plans_->fft.fwd(lines, values);
}

void FourierTransform::inverse(std::vector<double>& values, const std::vector<std::complex<double>>& lines,
                               int count) {
  plans_->fft.inv(values, lines, count);
}

}  // namespace drev
