// The orders of a LinearResponse at a speed, several sets of lanes at once.
#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/periodic/linear_response.hpp"

namespace drev {

using Complex = std::complex<double>;

namespace {

/// Whether `count` ascending numbers follow each other without a gap.
bool in_a_row(const int* numbers, int count) { return numbers[count - 1] - numbers[0] == count - 1; }

}  // namespace

bool LinearResponse::solve_lane(int set, int lane) {
  const auto row = [&](std::size_t unknown) { return unknown * kLaneSets + idx(set); };
  const double omega = w_[idx(set)].v[lane];
  for (std::size_t i = 0; i < z_.size(); ++i) z_[i] = {p_re_[row(i)].v[lane], p_im_[row(i)].v[lane]};
  const bool own = !system_.frequency_terms().empty();
  if (own) add_frequency_terms(std::abs(omega));
  bool solved = elimination_->factorize(mass_, own ? damping_at_omega_ : damping_here_,
                                        own ? stiffness_at_omega_ : stiffness_here_, {0.0, omega});
  if (solved) elimination_->solve(z_.data());
  solved = solved && !(elimination_->pivoted() && is_resonant(omega));
  if (!solved) std::fill(z_.begin(), z_.end(), Complex(0.0, 0.0));
  for (std::size_t i = 0; i < z_.size(); ++i) {
    re_[row(i)].v[lane] = z_[i].real();
    im_[row(i)].v[lane] = z_[i].imag();
  }
  return solved;
}

bool LinearResponse::is_resonant(double omega) {
  constexpr double kSame = 1e-10;  // relative difference of frequencies that are one but for rounding [-]
  const SparseMatrix& pattern = system_.pattern();
  std::vector<Complex> change(z_.size());
  double size = 0.0, change_size = 0.0;
  for (int column = 0; column < system_.size(); ++column)
    for (int slot = pattern.outerIndexPtr()[column]; slot < pattern.outerIndexPtr()[column + 1]; ++slot)
      change[idx(pattern.innerIndexPtr()[slot])] += 2.0 * omega * omega * mass_[slot] * z_[idx(column)];
  elimination_->solve(change.data());
  for (std::size_t i = 0; i < z_.size(); ++i) size += std::norm(z_[i]), change_size += std::norm(change[i]);
  return kSame * kSame * change_size > size;
}

int LinearResponse::give_orders(double speed, std::size_t first) {
  const auto& contents = content_->at(direction_ * speed);
  const int used =
      static_cast<int>(std::min<std::size_t>(LaneSections::kFrequencies, active_.size() - first));
  const int sets = (used + kLanes - 1) / kLanes;
  const int* orders = &active_[first];
  for (int lane = 0; lane < sets * kLanes; ++lane)
    w_[idx(lane / kLanes)].v[lane % kLanes] =
        direction_ * orders_[idx(orders[lane < used ? lane : 0])] * speed;
  for (std::size_t l = 0; l < contents.size(); ++l) {
    const Complex* amplitudes = contents[l].amplitudes.data();
    Complex* to = &given_[l * LaneSections::kFrequencies];
    if (in_a_row(orders, used))
      std::copy_n(amplitudes + orders[0], used, to);
    else
      for (int lane = 0; lane < used; ++lane) to[lane] = amplitudes[orders[lane]];
    std::fill(to + used, to + sets * kLanes, Complex(0.0, 0.0));
  }
  // Loads that cancel leave rounding, which at the frequency of an undamped mode would pass for a load.
  constexpr double kCancelled = 1e-13;  // sum relative to the sum of the sizes [-]
  for (const std::vector<std::size_t>& loads : together_)
    for (int lane = 0; lane < used; ++lane) {
      const auto at = [&](std::size_t l) -> Complex& {
        return given_[l * LaneSections::kFrequencies + idx(lane)];
      };
      Complex sum = 0.0;
      double size = 0.0;
      for (const std::size_t l : loads) {
        const Complex torque = load_rows_[l][0].coeff * at(l);
        sum += torque, size += std::abs(torque.real()) + std::abs(torque.imag());
      }
      if (std::abs(sum.real()) + std::abs(sum.imag()) <= kCancelled * size)
        for (const std::size_t l : loads) at(l) = 0.0;
    }
  rows_->add_loads(sets, given_, p_re_.data(), p_im_.data());
  return used;
}

template <class Value>
void LinearResponse::solve_lanes(int used, const LaneDynamics<Value>& dynamics) {
  // For one or two frequencies lanes are slower than scalars.
  constexpr int kWorthLanes = 3;
  const int sets = (used + kLanes - 1) / kLanes;
  if (used >= kWorthLanes) {
    lanes_->solve(sets, dynamics, w_.data(), p_re_.data(), p_im_.data(), re_.data(), im_.data(),
                  lost_.data());
  } else {
    for (std::size_t i = 0; i < re_.size(); i += kLaneSets) re_[i] = im_[i] = {};
    lost_[0] = {};
    for (int lane = 0; lane < used; ++lane) lost_[0].v[lane] = 1.0;
  }
  for (int set = 0; set < sets; ++set)
    for (int lane = 0; lane < kLanes; ++lane) {
      double& lost = reinterpret_cast<double*>(&lost_[idx(set)].v)[lane];
      if (lost == 0.0) continue;
      if (set * kLanes + lane < used)
        lost = solve_lane(set, lane) ? 0.0 : 1.0;
      else
        for (std::size_t i = idx(set); i < re_.size(); i += kLaneSets) re_[i].v[lane] = im_[i].v[lane] = 0.0;
    }
}

void LinearResponse::solve_orders(double speed, std::size_t first, Point& point) {
  const int used = give_orders(speed, first), sets = (used + kLanes - 1) / kLanes;
  spread_frequency_terms(sets);
  const LaneSections::Motion motion{p_re_.data(), p_im_.data(), re_.data(), im_.data(), w_.data()};
  LaneSections::Powers powers;
  const auto solve = [&](const auto& dynamics) {
    solve_lanes(used, dynamics);
    powers = rows_->powers(sets, motion, dynamics);
  };
  if (all_constant_)
    solve(LaneDynamics<double>{mass_.data(), damping_here_.data(), stiffness_common_.data(),
                               loss_common_.data()});
  else
    solve(LaneDynamics<LaneRow>{mass_.data(), damping_here_.data(), stiffness_lanes_.data(),
                                loss_lanes_.data()});
  if (follows_amplitude_) add_twist_squares(used);
  rows_->find(sets, motion, beyond_re_, beyond_im_);
  point.input_power += powers.input;
  point.dissipated_power += powers.dissipated;
  const int* orders = &active_[first];
  const auto put = [&](const Complex* found, Complex* column) {
    if (in_a_row(orders, used))
      std::copy_n(found, used, column + orders[0]);
    else
      for (int lane = 0; lane < used; ++lane) column[orders[lane]] = found[lane];
  };
  for (std::size_t s = 0; s < sections_.size(); ++s) {
    const auto c = static_cast<Eigen::Index>(s);
    put(rows_->torques(s), point.amplitude.col(c).data());
    put(rows_->twists(s), point.twist.col(c).data());
    point.heat[c] += rows_->heat_of(s);
  }
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  for (int lane = 0; lane < used; ++lane) {
    if (lost_[idx(lane / kLanes)].v[lane % kLanes] == 0.0) continue;
    const Eigen::Index k = orders[lane];
    point.amplitude.row(k).setConstant(kInfinite);
    point.twist.row(k).setConstant(kInfinite);
    lost_orders_.push_back(static_cast<int>(k));
  }
}

LinearResponse::Resonance LinearResponse::resonance(double speed, int order) {
  constexpr double kAway = 1e-4;      // larger distance, beside which the mode's growth towards it shows [-]
  constexpr double kGrowth = 10.0;    // growth from kAway to kNear of what the mode moves [-]
  constexpr double kRounding = 1e-9;  // amplitude that is rounding, relative to the largest [-]
  Resonance found;
  Point away;
  solve((1.0 + kAway) * speed, away, order);
  const double before = motion();
  solve((1.0 + kNear) * speed, found.near, order);
  found.excited = motion() > kGrowth * before;
  const Vector at_away = away.amplitude.row(order).cwiseAbs(),
               at_near = found.near.amplitude.row(order).cwiseAbs();
  for (Eigen::Index c = 0; c < at_near.size(); ++c)
    found.unbounded.push_back(found.excited && at_near[c] > kGrowth * at_away[c] &&
                              at_near[c] > kRounding * at_near.maxCoeff());
  return found;
}

double LinearResponse::motion() const {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  if (active_.empty()) return 0.0;
  if (lost_[0].v[0] != 0.0) return kInfinite;
  double square = 0.0;
  for (std::size_t i = 0; i < re_.size(); i += kLaneSets)
    square += re_[i].v[0] * re_[i].v[0] + im_[i].v[0] * im_[i].v[0];
  return std::sqrt(square);
}

void LinearResponse::vibration(double speed, Point& point, int only) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  solve(speed, point, only);
  const std::vector<int> lost = lost_orders_;
  for (const int k : lost) {
    const Resonance at = resonance(speed, k);
    for (Eigen::Index c = 0; c < point.heat.size(); ++c) {
      const bool unbounded = at.unbounded[static_cast<std::size_t>(c)];
      point.amplitude(k, c) = unbounded ? kInfinite : at.near.amplitude(k, c);
      point.twist(k, c) = unbounded ? kInfinite : at.near.twist(k, c);
      if (at.near.heat[c] != 0.0) point.heat[c] += unbounded ? kInfinite : at.near.heat[c];
    }
    if (at.excited) continue;
    point.input_power += at.near.input_power;
    point.dissipated_power += at.near.dissipated_power;
  }
}

Eigen::VectorXcd LinearResponse::forces() const {
  Eigen::VectorXcd p = Eigen::VectorXcd::Zero(system_.size());
  if (active_.empty()) return p;
  for (std::size_t i = 0; i < z_.size(); ++i)
    p[static_cast<Eigen::Index>(i)] = {p_re_[i * kLaneSets].v[0], direction_ * p_im_[i * kLaneSets].v[0]};
  return p;
}

Eigen::RowVectorXcd LinearResponse::amplitudes_of(const Eigen::VectorXcd& z) {
  Eigen::RowVectorXcd found = Eigen::RowVectorXcd::Zero(static_cast<Eigen::Index>(sections_.size()));
  if (active_.empty()) return found;
  for (std::size_t i = 0; i < z_.size(); ++i) {
    const Complex value = z[static_cast<Eigen::Index>(i)];
    re_[i * kLaneSets] = im_[i * kLaneSets] = {};
    re_[i * kLaneSets].v[0] = value.real();
    im_[i * kLaneSets].v[0] = direction_ * value.imag();
  }
  rows_->find(1, {p_re_.data(), p_im_.data(), re_.data(), im_.data(), w_.data()}, beyond_re_, beyond_im_);
  for (std::size_t s = 0; s < sections_.size(); ++s) {
    const Complex torque = *rows_->torques(s);
    found[static_cast<Eigen::Index>(s)] = {torque.real(), direction_ * torque.imag()};
  }
  return found;
}

void LinearResponse::add_twist_squares(int used) {
  twist_squares_.resize(carried_.size());
  for (std::size_t t = 0; t < carried_.size(); ++t)
    for (int lane = 0; lane < used; ++lane) {
      const auto set = idx(lane / kLanes);
      const int in_set = lane % kLanes;
      Complex twist = 0.0;
      for (const Entry& e : system_.frequency_terms()[t].z) {
        const auto row = idx(e.index) * kLaneSets + set;
        twist += e.coeff * Complex(re_[row].v[in_set], im_[row].v[in_set]);
      }
      twist_squares_[t] +=
          lost_[set].v[in_set] != 0.0 ? std::numeric_limits<double>::infinity() : std::norm(twist);
    }
}

}  // namespace drev
