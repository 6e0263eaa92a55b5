#include "solvers/periodic/damped_poles.hpp"

#include <drev/solvers/periodic/linear_sweep.hpp>

#include <cmath>

namespace drev {

namespace {

using Complex = std::complex<double>;

constexpr double kCoincide =
    1e-7;  // difference of lambda relative to it below which shapes are any of their common space [-]

}  // namespace

DampedPole DampedPoles::at(const SweepModes& modes, Eigen::Index mode, double speed) {
  Eigen::Index nearest = 0;
  (modes.speeds.array() - speed).abs().minCoeff(&nearest);
  const auto column = static_cast<std::size_t>(nearest);
  const Eigen::VectorXcd& all = lambda[column];
  const auto coincides = [](Complex a, Complex b) { return std::abs(a - b) <= kCoincide * std::abs(b); };
  std::vector<Eigen::Index> same{mode};
  for (Eigen::Index j = 0; j < all.size(); ++j)
    if (j != mode && coincides(all[j], all[mode])) same.push_back(j);
  DampedPole pole{{}, all(same), shapes[column](Eigen::all, same)};
  // Asked for only where it is needed: loads that are called are looked at anew at another speed.
  const auto damping_of = [&](double at, Complex of) { return matrices(at, of.imag()).damping; };
  if (modes.speeds.size() == 1) {
    pole.damping = damping_of(modes.speeds[nearest], all[mode]);
    return pole;
  }
  const Complex guess = modes.at(mode, speed);
  DampedPole here{{}, pole.lambda, pole.shapes};
  Eigen::Index count = 0;
  for (Eigen::Index j = 0; j < pole.lambda.size(); ++j) {
    Complex found = guess;
    Eigen::VectorXcd shape = pole.shapes.col(j);
    bool good = pairs.refine([&](double omega) { return matrices(speed, omega); }, found, shape);
    for (Eigen::Index k = 0; k < all.size() && j == 0; ++k)
      good &=
          all[k] == 0.0 || coincides(all[k], all[mode]) || std::abs(found - all[k]) > std::abs(found - guess);
    if (!good && j == 0) {
      pole.damping = damping_of(modes.speeds[nearest], all[mode]);
      pole.lambda.setConstant(guess);
      return pole;
    }
    if (!good || (j > 0 && !coincides(found, here.lambda[0]))) continue;
    here.lambda[count] = found;
    here.shapes.col(count++) = shape;
  }
  here.damping = damping_of(speed, here.lambda[0]);
  here.lambda = here.lambda.head(count).eval();
  here.shapes = here.shapes.leftCols(count).eval();
  return here;
}

}  // namespace drev
