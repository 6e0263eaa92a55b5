#include "solvers/periodic/motion_sections.hpp"

#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>

#include "solvers/periodic/bracketed_search.hpp"

namespace drev {

namespace {

using Lines = Eigen::VectorXcd;

constexpr double kBesideTop = 0.02;  // largest rise of a maximum above its samples over the range [-]
constexpr double kTopWidth = 1e-7;   // tolerance of its place relative to the distance of samples [-]

Lines lines_of(const std::vector<Entry>& row, const Eigen::MatrixXcd& z) {
  Lines sum = Lines::Zero(z.cols());
  for (const Entry& e : row) sum += e.coeff * z.row(e.index).transpose();
  return sum;
}

double sum_at(const Lines& lines, double psi) {
  const std::complex<double> one = std::polar(1.0, psi);
  std::complex<double> sum = 0.0;
  for (Eigen::Index n = lines.size() - 1; n >= 0; --n)
    sum = std::complex<double>(sum.real() * one.real() - sum.imag() * one.imag(),
                               sum.real() * one.imag() + sum.imag() * one.real()) +
          lines[n];
  return sum.real();
}

/// The largest value over the cycle: of equidistant samples, refined between the neighbours of local maxima.
double largest_of(const std::function<double(double)>& look, const Vector& samples, double sign) {
  const Eigen::Index count = samples.size();
  const double top = (sign * samples).maxCoeff(), range = samples.maxCoeff() - samples.minCoeff();
  const double h = kTwoPi / static_cast<double>(count);
  double best = top;
  for (Eigen::Index i = 0; i < count && range > 0.0; ++i) {
    const double here = sign * samples[i];
    if (here < top - kBesideTop * range || here < sign * samples[(i + count - 1) % count] ||
        here <= sign * samples[(i + 1) % count])
      continue;
    const double psi = h * static_cast<double>(i);
    const BracketedMaximum found =
        bracketed_maximum(psi - h, psi, psi + h, kTopWidth * h, [&](double at) { return sign * look(at); });
    best = std::max(best, found.value);
  }
  return sign * best;
}

}  // namespace

bool MotionSections::find(LawBalance& balance, const Vector& x, double speed, const std::vector<int>& lines,
                          Figures& figures) const {
  Eigen::MatrixXcd z;
  if (!balance.motion(x, speed, z)) return false;
  const auto count = static_cast<Eigen::Index>(sections_.size());
  const double w = balance.direction() * speed / balance.turns();
  const std::complex<double> i_w(0.0, w);
  for (Vector* values : {&figures.maximum, &figures.minimum, &figures.mean, &figures.twist_mean,
                         &figures.twist_maximum, &figures.twist_minimum, &figures.heat})
    values->setZero(count);
  figures.amplitude.setZero(static_cast<Eigen::Index>(lines.size()), count);
  figures.samples.resize(kSamples, count);
  figures.separates = !balance.closed();
  figures.left_over = balance.left_over();
  figures.z = z.rowwise().sum().real();
  Eigen::VectorXcd rates(z.cols());
  for (Eigen::Index n = 0; n < z.cols(); ++n) rates[n] = static_cast<double>(n) * i_w;
  figures.v = (z * rates).real();
  const Eigen::Index points = std::max<Eigen::Index>(kSamples, 8 * z.cols());
  const auto sampled = [&](const std::function<double(double)>& look, Eigen::Index number) {
    Vector values(number);
    for (Eigen::Index i = 0; i < number; ++i)
      values[i] = look(kTwoPi * static_cast<double>(i) / static_cast<double>(number));
    return values;
  };
  for (Eigen::Index c = 0; c < count; ++c) {
    const SectionRows& section = sections_[static_cast<std::size_t>(c)];
    std::function<double(double)> look;
    Lines force(z.cols());
    if (section.law >= 0) {
      const auto term = static_cast<std::size_t>(section.law);
      look = [&balance, &x, speed, term](double psi) {
        return balance.respond(balance.terms()[term], x, speed, psi).y;
      };
      for (Eigen::Index n = 0; n < z.cols(); ++n) force[n] = balance.force_line(term, x, static_cast<int>(n));
      figures.heat[c] = balance.heat(term);
    } else {
      force = lines_of(section.stiffness, z) + lines_of(section.damping, z).cwiseProduct(rates);
      // Heat is w/2 Im(T conj x), as of a linear sweep: with a complex stiffness T is the whole torque, which holds
      // those of the dashpots inside; else that of the damper, so that rounding of the elastic part adds nothing.
      const Lines lossy = section.frequency_term >= 0
                              ? force
                              : Lines(lines_of(section.damper, z).cwiseProduct(rates)),
                  twist = lines_of(section.twist, z).cwiseProduct(rates);
      look = [&force](double psi) { return sum_at(force, psi); };
      figures.heat[c] = 0.5 * twist.dot(lossy).real();
    }
    figures.mean[c] = force[0].real();
    for (std::size_t k = 0; k < lines.size(); ++k)
      if (lines[k] < force.size()) figures.amplitude(static_cast<Eigen::Index>(k), c) = force[lines[k]];
    const Vector values = sampled(look, points);
    figures.samples.col(c) = sampled(look, kSamples);
    figures.maximum[c] = largest_of(look, values, 1.0);
    figures.minimum[c] = largest_of(look, values, -1.0);
    if (section.twist.empty()) continue;
    const Lines twist = lines_of(section.twist, z);
    std::function<double(double)> twist_at = [&twist](double psi) { return sum_at(twist, psi); };
    if (section.law >= 0)
      twist_at = [&balance, &x, speed, &section](double psi) {
        return balance.deflection(balance.terms()[static_cast<std::size_t>(section.law)], x, speed, psi);
      };
    const Vector twists = sampled(twist_at, points);
    figures.twist_mean[c] = twists.mean();
    figures.twist_maximum[c] = largest_of(twist_at, twists, 1.0);
    figures.twist_minimum[c] = largest_of(twist_at, twists, -1.0);
  }
  return true;
}

double largest_difference(const MotionSections::Figures& a, const MotionSections::Figures& b) {
  double largest = 0.0;
  for (Eigen::Index c = 0; c < a.samples.cols(); ++c) {
    const double size = b.samples.col(c).cwiseAbs().maxCoeff();
    if (!(size > 0.0)) continue;
    const double samples = (a.samples.col(c) - b.samples.col(c)).cwiseAbs().maxCoeff();
    const double extremes =
        std::max(std::abs(a.maximum[c] - b.maximum[c]), std::abs(a.minimum[c] - b.minimum[c]));
    largest = std::max(largest, std::max(samples, extremes) / size);
  }
  return largest;
}

}  // namespace drev
