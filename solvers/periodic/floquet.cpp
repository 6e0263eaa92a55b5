#include "solvers/periodic/floquet.hpp"

#include <drev/core/assembler.hpp>
#include <drev/core/law/law_force.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "core/dense/eigenvalues.hpp"
#include "core/dense/factorization.hpp"

namespace drev {

namespace {

Eigen::MatrixXd dense(const Assembler& assembler, const Weights& weights) {
  SparseMatrix matrix = assembler.system().pattern();
  Vector values(matrix.nonZeros());
  assembler.linear_values(weights, values);
  Eigen::Map<Vector>(matrix.valuePtr(), matrix.nonZeros()) = values;
  return Eigen::MatrixXd(matrix);
}

}  // namespace

double largest_floquet_exponent(const System& system, double period, int pieces) {
  Assembler assembler(system);
  const Eigen::Index n = system.size();
  const Eigen::MatrixXd stiffness = dense(assembler, {.k = 1.0});
  const CholeskyFactor mass(dense(assembler, {.m = 1.0}));
  const Eigen::MatrixXd drag = mass.solve(dense(assembler, {.c = 1.0}));
  // Rates in units of a frequency of the train, so that z and v/w are of one size.
  const double w = std::sqrt(mass.solve(stiffness).cwiseAbs().rowwise().sum().maxCoeff());
  const Vector rest = Vector::Zero(n);
  std::map<std::vector<double>, Eigen::MatrixXd> turns;  // by the meshes' stiffnesses
  Eigen::MatrixXd product = Eigen::MatrixXd::Identity(2 * n, 2 * n);
  for (int p = 0; p < pieces; ++p) {
    assembler.set_time((p + 0.5) * period / pieces);
    std::vector<double> slopes;
    Eigen::MatrixXd k = stiffness;
    for (const ScalarTerm& term : system.scalars()) {
      slopes.push_back(assembler.respond(term, rest, rest).dy_dx);
      for (const drev::Entry& a : term.z)
        for (const drev::Entry& b : term.z) k(a.index, b.index) += slopes.back() * a.coeff * b.coeff;
    }
    auto found = turns.find(slopes);
    if (found == turns.end()) {
      Eigen::MatrixXd rates = Eigen::MatrixXd::Zero(2 * n, 2 * n);
      rates.topRightCorner(n, n).diagonal().setConstant(w);
      rates.bottomLeftCorner(n, n) = -mass.solve(k) / w;
      rates.bottomRightCorner(n, n) = -drag;
      found = turns.emplace(slopes, exponential(rates * (period / pieces))).first;
    }
    product = found->second * product;
  }
  return std::log(spectral_radius(product)) / period;
}

FloquetProduct::FloquetProduct(const System& system) : system_(system) {
  Assembler assembler(system);
  stiffness_ = dense(assembler, {.k = 1.0});
  inverse_ = CholeskyFactor(dense(assembler, {.m = 1.0})).inverse();
  drag_ = inverse_ * dense(assembler, {.c = 1.0});
  Vector closed;
  assembler.contact_values({.k = 1.0}, Contact::closed, closed);
  SparseMatrix matrix = system.pattern();
  Eigen::Map<Vector>(matrix.valuePtr(), matrix.nonZeros()) = closed;
  w_ = std::sqrt((inverse_ * Eigen::MatrixXd(matrix)).cwiseAbs().rowwise().sum().maxCoeff());
  if (!(w_ > 0.0)) w_ = 1.0;
}

/// d(z, z'/w)/dt at a part of a panel, -1 to 1, by the polynomial through its points.
Eigen::MatrixXd FloquetProduct::rates(const LawBalance& balance, std::size_t panel, double part) const {
  const Eigen::Index n = system_.size();
  Eigen::MatrixXd k = stiffness_, c = Eigen::MatrixXd::Zero(n, n);
  const auto& terms = balance.terms();
  std::array<double, LawBalance::kPoints> basis{};
  const auto place = [](int g) { return g < 4 ? -kGaussPoints[idx(3 - g)] : kGaussPoints[idx(g - 4)]; };
  for (int g = 0; g < LawBalance::kPoints; ++g) {
    basis[idx(g)] = 1.0;
    for (int other = 0; other < LawBalance::kPoints; ++other)
      if (other != g) basis[idx(g)] *= (part - place(other)) / (place(g) - place(other));
  }
  const bool constant = balance.panels()[panel].constant;
  for (std::size_t t = 0; t < terms.size(); ++t) {
    LawBalance::Slopes s;
    if (constant) {
      s = balance.slopes(panel, 0, t);
    } else {
      for (int g = 0; g < LawBalance::kPoints; ++g) {
        const LawBalance::Slopes& here = balance.slopes(panel, g, t);
        s.x += basis[idx(g)] * here.x;
        s.rate += basis[idx(g)] * here.rate;
        s.angle += basis[idx(g)] * here.angle;
      }
    }
    for (const drev::Entry& a : terms[t].row) {
      for (const drev::Entry& b : terms[t].row) {
        k(a.index, b.index) += s.x * a.coeff * b.coeff;
        c(a.index, b.index) += s.rate * a.coeff * b.coeff;
      }
      if (s.angle != 0.0)
        for (const drev::Entry& b : terms[t].angle_row) k(a.index, b.index) += s.angle * a.coeff * b.coeff;
    }
  }
  Eigen::MatrixXd rates = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  rates.topRightCorner(n, n).diagonal().setConstant(w_);
  rates.bottomLeftCorner(n, n) = -inverse_ * k / w_;
  rates.bottomRightCorner(n, n) = -drag_ - inverse_ * c;
  return rates;
}

FloquetMultipliers FloquetProduct::multipliers(const LawBalance& balance, double speed) const {
  const auto& panels = balance.panels();
  const Eigen::Index n = system_.size();
  const double time = balance.turns() / speed;  // of a radian of the cycle
  const auto same = [&](std::size_t a, std::size_t b) {
    if (!panels[a].constant || !panels[b].constant) return false;
    for (std::size_t t = 0; t < balance.terms().size(); ++t)
      if (!(balance.slopes(a, 0, t) == balance.slopes(b, 0, t))) return false;
    return true;
  };
  Eigen::MatrixXd product = Eigen::MatrixXd::Identity(2 * n, 2 * n);
  const bool forward = balance.direction() > 0.0;
  for (std::size_t i = 0; i < panels.size();) {
    const std::size_t first = forward ? i : panels.size() - 1 - i;
    double length = panels[first].to - panels[first].from;
    std::size_t next = i + 1;
    for (; next < panels.size(); ++next) {
      const std::size_t p = forward ? next : panels.size() - 1 - next;
      if (!same(first, p)) break;
      length += panels[p].to - panels[p].from;
    }
    i = next;
    if (panels[first].constant) {
      product = exponential(rates(balance, first, 0.0) * (length * time)) * product;
      continue;
    }
    // Steps in which the fastest mode turns by no more than a third of a radian.
    const int steps = std::max(1, static_cast<int>(std::ceil(3.0 * w_ * length * time)));
    const double h = length * time / steps, root = std::sqrt(3.0);
    for (int s = 0; s < steps; ++s) {
      const double sign = forward ? 1.0 : -1.0;
      const auto at = [&](double part) { return sign * (-1.0 + (2.0 * s + 1.0 + part) / steps); };
      const Eigen::MatrixXd a = rates(balance, first, at(-1.0 / root)),
                            b = rates(balance, first, at(1.0 / root));
      product = exponential(0.5 * h * (a + b) - root / 12.0 * h * h * (a * b - b * a)) * product;
    }
  }
  FloquetMultipliers out;
  const GeneralEigen all = general_eigen(product);
  if (!all.converged) {
    out.largest = NAN;
    return out;
  }
  std::vector<std::complex<double>> values(all.values.begin(), all.values.end());
  std::stable_sort(values.begin(), values.end(),
                   [](const auto& x, const auto& y) { return std::abs(x - 1.0) < std::abs(y - 1.0); });
  const std::size_t rigid = std::min(values.size(), 2 * balance.mean().floating().size());
  values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rigid));
  out.values = Eigen::Map<Eigen::VectorXcd>(values.data(), static_cast<Eigen::Index>(values.size()));
  std::complex<double> at_minus_one = 1.0;
  for (const std::complex<double>& value : values) {
    out.largest = std::max(out.largest, std::abs(value));
    at_minus_one *= 1.0 + value;
    if (std::abs(value) <= 1.0 + kRounding) continue;
    ++out.outside;
    out.complex_outside = out.complex_outside || std::abs(value.imag()) > 1e-9 * std::abs(value);
  }
  out.at_minus_one = at_minus_one.real();
  return out;
}

}  // namespace drev
