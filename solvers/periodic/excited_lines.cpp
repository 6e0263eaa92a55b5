#include "solvers/periodic/excited_lines.hpp"

#include <drev/core/law/harmonic_load.hpp>
#include <drev/core/law/law_force.hpp>
#include <drev/core/load.hpp>
#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/dense/fourier.hpp"

namespace drev {

namespace {

using Complex = std::complex<double>;

constexpr int kLeastLines = 192, kMostLines = 1 << 13;
constexpr double kWhole = 1e-9;      // relative distance from a whole line, as OrderContent takes it
constexpr double kPastLines = 1e-3;  // part of a load's rms up to which no further harmonics are looked for
constexpr double kUnvaried = 1e-12;  // variation of a law's force relative to it that is rounding
constexpr double kNoVibration =
    1e-9;  // vibration of a section beside that of others of its unit that is rounding

}  // namespace

ExcitedLines::ExcitedLines(const System& system, double turns, const std::string& balance,
                           const std::vector<SectionRows>& sections)
    : system_(system),
      turns_(turns),
      rows_(sections),
      sections_(static_cast<Eigen::Index>(sections.size())),
      balance_(system, turns, balance, none_),
      elimination_(system.pattern()) {
  balance_.set_harmonics(1);
  Assembler assembler(system);
  assembler.contact_values({0.0, 0.0, 1.0}, Contact::closed, stiffness_);
  assembler.contact_values({0.0, 1.0, 0.0}, Contact::closed, damping_);
  for (const LawBalance::Term& term : balance_.terms()) {
    if (term.law == nullptr) continue;
    SectionRows rows;
    rows.unit = "deflection of a law";
    rows.stiffness = term.row;
    rows_.push_back(std::move(rows));
  }
  find_lines();
}

/// As many as the loads that state their harmonics have, and for others until little is left out.
void ExcitedLines::find_lines() {
  double highest = kLeastLines;
  std::set<double> strays;
  for (const LoadTerm& term : system_.loads()) {
    if (system_.node_map(term.node).prescribed >= 0) continue;
    const auto* load = dynamic_cast<const HarmonicLoad*>(term.load);
    stated_.push_back(load != nullptr);
    if (load != nullptr)
      for (const LoadOrder& of : load->orders().terms) {
        const double order = of.order * std::abs(system_.ratio(term.node)), line = order * turns_;
        if (std::abs(line - std::round(line)) > kWhole * line || line > kMostLines)
          strays.insert(order);
        else
          highest = std::max(highest, std::round(line));
      }
  }
  std::vector<Finding> none;
  strays_.assign(strays.begin(), strays.end());
  stray_content_.emplace(system_, strays_, none);
  for (lines_ = static_cast<int>(std::min<double>(highest, kMostLines));;
       lines_ = std::min(2 * lines_, kMostLines)) {
    std::vector<double> orders;
    for (int n = 1; n <= lines_; ++n) orders.push_back(n / turns_);
    content_.emplace(system_, std::move(orders), none);
    const double speed = system_.reference_speed() > 0.0 ? system_.reference_speed() : 1.0;
    const auto& contents = content_->at(balance_.direction() * speed);
    bool enough = true;
    for (std::size_t l = 0; l < contents.size(); ++l)
      enough = enough && (stated_[l] || contents[l].left_out <= kPastLines * contents[l].rms);
    if (enough || lines_ == kMostLines) break;
  }
  for (const LoadTerm* load : content_->loads()) load_rows_.push_back(system_.row_of(load->node));
}

/// F_n of the terms, lines x terms.
Eigen::MatrixXcd ExcitedLines::law_lines(double speed) {
  const auto& terms = balance_.terms();
  Eigen::MatrixXcd all = Eigen::MatrixXcd::Zero(lines_, static_cast<Eigen::Index>(terms.size()));
  Vector x;
  if (!balance_.linear_start(speed, x)) return all;
  for (int i = 0; i < balance_.inputs(); ++i) x.segment(3 * i + 1, 2).setZero();
  FourierTransform transform;
  const int samples = 4 * lines_;
  std::vector<double> force(idx(samples));
  std::vector<Complex> spectrum;
  for (std::size_t t = 0; t < terms.size(); ++t) {
    if (terms[t].law == nullptr || terms[t].law->phase_node < 0) continue;
    for (int s = 0; s < samples; ++s)
      force[idx(s)] = balance_.respond(terms[t], x, speed, kTwoPi * s / samples).y;
    const auto [low, high] = std::minmax_element(force.begin(), force.end());
    if (*high - *low <= kUnvaried * std::max(std::abs(*high), std::abs(*low))) continue;
    transform.forward(spectrum, force);
    for (int n = 1; n <= lines_; ++n)
      all(n - 1, static_cast<Eigen::Index>(t)) = 2.0 / samples * spectrum[idx(n)];
  }
  return all;
}

const Eigen::MatrixXd& ExcitedLines::at(double speed) {
  if (speed == speed_) return amplitudes_;
  speed_ = speed;
  amplitudes_.setZero(lines_ + 1, static_cast<Eigen::Index>(rows_.size()));
  const auto& contents = content_->at(balance_.direction() * speed);
  const Eigen::MatrixXcd laws = law_lines(speed);
  Eigen::VectorXcd z(system_.size());
  const auto add_load = [&](std::size_t l, Complex amplitude) {
    for (const Entry& e : load_rows_[l]) z[e.index] += e.coeff * amplitude;
  };
  const auto answer = [&](double order, Eigen::Index row) {
    if (z.isZero(0.0)) return;
    const Complex rate(0.0, balance_.direction() * order * speed);
    if (!elimination_.factorize(system_.mass_values(), damping_, stiffness_, rate)) return;
    elimination_.solve(z.data());
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      Complex sum = 0.0;
      for (const Entry& e : rows_[r].stiffness) sum += e.coeff * z[e.index];
      for (const Entry& e : rows_[r].damping) sum += rate * e.coeff * z[e.index];
      amplitudes_(row, static_cast<Eigen::Index>(r)) += std::abs(sum);
    }
  };
  for (int n = 1; n <= lines_; ++n) {
    z.setZero();
    for (std::size_t l = 0; l < contents.size(); ++l) add_load(l, contents[l].amplitudes[idx(n - 1)]);
    for (std::size_t t = 0; t < balance_.terms().size(); ++t)
      for (const Entry& e : balance_.terms()[t].row)
        z[e.index] -= e.coeff * laws(n - 1, static_cast<Eigen::Index>(t));
    answer(n / turns_, n - 1);
  }
  z.setZero();
  for (std::size_t l = 0; l < contents.size(); ++l)
    if (!stated_[l]) add_load(l, std::sqrt(2.0) * contents[l].left_out);
  answer(lines_ / turns_, lines_);
  for (std::size_t k = 0; k < strays_.size(); ++k) {
    z.setZero();
    const auto& of = stray_content_->at(balance_.direction() * speed);
    for (std::size_t l = 0; l < of.size(); ++l) add_load(l, of[l].amplitudes[k]);
    answer(strays_[k], lines_);
  }
  return amplitudes_;
}

Eigen::MatrixXd ExcitedLines::shares(double speed) {
  Eigen::MatrixXd squares = at(speed).array().square();
  std::map<std::string, double> largest;
  for (std::size_t r = 0; r < rows_.size(); ++r)
    largest[rows_[r].unit] =
        std::max(largest[rows_[r].unit], squares.col(static_cast<Eigen::Index>(r)).sum());
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    auto column = squares.col(static_cast<Eigen::Index>(r));
    const double sum = column.sum();
    if (sum > kNoVibration * kNoVibration * largest[rows_[r].unit])
      column /= sum;
    else
      column.setZero();
  }
  return squares;
}

int ExcitedLines::fewest(const std::vector<double>& speeds, double share) {
  int most = 1;
  for (const double speed : speeds) {
    const Eigen::MatrixXd part = shares(speed);
    for (Eigen::Index r = 0; r < part.cols(); ++r) {
      double sum = 0.0;
      for (int line = lines_ + 1; line > most; --line) {
        sum += part(line - 1, r);
        if (sum > share * share) most = line;
      }
    }
  }
  return most;
}

Vector ExcitedLines::beyond(double speed, int harmonics) {
  const Eigen::MatrixXd& all = at(speed);
  const int from = std::min(harmonics, lines_);
  return all.leftCols(sections_).bottomRows(lines_ + 1 - from).colwise().sum().transpose();
}

double ExcitedLines::share_beyond(const std::vector<double>& speeds, int harmonics) {
  double largest = 0.0;
  const int from = std::min(harmonics, lines_);
  for (const double speed : speeds)
    largest = std::max(largest, shares(speed).bottomRows(lines_ + 1 - from).colwise().sum().maxCoeff());
  return std::sqrt(largest);
}

std::vector<int> ExcitedLines::excited(const std::vector<double>& speeds, double share) {
  std::vector<bool> is(idx(lines_), false);
  for (const double speed : speeds) {
    const Eigen::MatrixXd part = shares(speed);
    for (int n = 1; n <= lines_; ++n)
      is[idx(n - 1)] = is[idx(n - 1)] || part.row(n - 1).maxCoeff() > share * share;
  }
  std::vector<int> found;
  for (int n = 1; n <= lines_; ++n)
    if (is[idx(n - 1)]) found.push_back(n);
  return found;
}

}  // namespace drev
