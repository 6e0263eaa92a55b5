#include "solvers/periodic/linear_response.hpp"

#include <drev/core/channel.hpp>
#include <drev/core/error.hpp>
#include <drev/core/law/frequency_stiffness.hpp>
#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace drev {

namespace {

using Complex = std::complex<double>;
using Section = LinearResponse::Section;

constexpr double kNoDrag = 1e-13;  // of the largest damping

template <class Values>
auto product(const std::vector<Entry>& row, const Values& z) {
  auto sum = z[0] * 0.0;
  for (const Entry& e : row) sum += e.coeff * z[static_cast<std::size_t>(e.index)];
  return sum;
}

std::string element_name(const System& system, ElementId id) {
  return system.element_instances()[idx(index(id))].name;
}

}  // namespace

LinearResponse::LinearResponse(const System& system, const LinearSweepOptions& options,
                               const std::vector<double>& orders, std::vector<Finding>& findings)
    : system_(system),
      assembler_(system),
      orders_(orders),
      elimination_(system.pattern()),
      lanes_(elimination_) {
  check_model(options.close_contacts, findings);
  content_.emplace(system, orders, findings);
  for (const LoadTerm* load : content_->loads()) load_rows_.push_back(system.row_of(load->node));
  assembler_.contact_values({1.0, 0.0, 0.0}, Contact::closed, mass_);
  assembler_.contact_values({0.0, 1.0, 0.0}, Contact::closed, damping_);
  assembler_.contact_values({0.0, 0.0, 1.0}, Contact::closed, stiffness_);
  sections_ = find_section_rows(system, options.sections, findings);
  direction_ = reference_direction(system_);
  if (findings.empty()) mean_.emplace(system_, damping_, stiffness_, options.balance, findings);
  rows_.emplace(system_, sections_);
  z_.resize(idx(system.size()));
  for (LaneArray* rows : {&re_, &im_, &p_re_, &p_im_}) rows->resize(idx(system.size()));
}

void LinearResponse::check_model(bool close_contacts, std::vector<Finding>& findings) const {
  const auto refuse = [&](const std::string& place, const std::string& why) {
    findings.push_back({system_.name() + (place.empty() ? "" : "/" + place), "", "", "", why});
  };
  if (system_.size() == 0) refuse("", "every node is prescribed: nothing vibrates");
  if (!system_.reference())
    refuse("", "no shaft turns nominally: orders need a reference shaft (nominal_speed or constant_speed)");
  for (const ScalarTerm& term : system_.scalars()) {
    const std::string name = element_name(system_, term.element);
    if (!close_contacts)
      refuse(name,
             "is not linear; close_contacts (drev sweep --contact closed) takes its stiffness with the "
             "contact closed, at its mean over the mesh");
    if (term.phase_node < 0) continue;
    for (int i = 0; i < 16; ++i)
      if (const Offset offset = term.force->offset(0.7 * i); offset.e != 0.0 || offset.de_dangle != 0.0) {
        refuse(name,
               "has a transmission error, which a linear sweep does not take; harmonic balance "
               "(solve_periodic, drev run --start periodic) does");
        break;
      }
  }
  for (const FrictionTerm& term : system_.frictions())
    refuse(element_name(system_, term.element),
           "sticks and slips, which a sweep does not take; run it in time (drev run)");
  for (const GeneralTerm& term : system_.generals())
    refuse(element_name(system_, term.element),
           "is a general element, which a linear sweep does not take; "
           "harmonic balance (solve_periodic) does");
  if (system_.any_prescribed_moves())
    for (int k = 0; k < system_.prescribed_count(); ++k)
      if (system_.prescribed()[idx(k)].at)
        refuse(system_.node_names()[idx(system_.prescribed_node(k))],
               "has a given motion in time, which has no orders");
}

void LinearResponse::add_frequency_terms(double omega) {
  damping_at_omega_ = damping_here_;
  stiffness_at_omega_ = stiffness_here_;
  const SparseMatrix& pattern = system_.pattern();
  beyond_.clear();
  for (const FrequencyTerm& term : system_.frequency_terms()) {
    const Complex k = term.stiffness->beyond_matrices(omega);
    beyond_.push_back(k);
    for (const Entry& c : term.z)
      for (const Entry& r : term.z) {
        const int* first = pattern.innerIndexPtr() + pattern.outerIndexPtr()[c.index];
        const int* last = pattern.innerIndexPtr() + pattern.outerIndexPtr()[c.index + 1];
        const auto slot = std::lower_bound(first, last, r.index) - pattern.innerIndexPtr();
        stiffness_at_omega_[slot] += k.real() * r.coeff * c.coeff;
        damping_at_omega_[slot] += k.imag() / omega * r.coeff * c.coeff;
      }
  }
}

const Vector& LinearResponse::damping_at(double speed) {
  damping_here_ = damping_;
  stiffness_here_ = stiffness_;
  content_->add_slopes(direction_ * speed, &damping_here_, &stiffness_here_);
  return damping_here_;
}

void LinearResponse::mean(double speed, Point& point) {
  const auto& contents = content_->at(direction_ * speed);
  Vector p = -direction_ * speed * system_.nominal_drag().head(system_.size());
  // Ratios to rounding leave that of the dampers between nodes of one speed.
  if (p.cwiseAbs().maxCoeff() <= kNoDrag * speed * damping_.cwiseAbs().maxCoeff()) p.setZero();
  const std::vector<Vector>& rigid = mean_->rigid();
  point.load_sum = Vector::Zero(static_cast<Eigen::Index>(rigid.size()));
  for (std::size_t f = 0; f < rigid.size(); ++f)
    point.load_sum[static_cast<Eigen::Index>(f)] += rigid[f].cwiseProduct(p).cwiseAbs().sum();
  for (std::size_t l = 0; l < contents.size(); ++l) {
    for (const Entry& e : load_rows_[l]) p[e.index] += e.coeff * contents[l].mean;
    for (std::size_t f = 0; f < rigid.size(); ++f)
      point.load_sum[static_cast<Eigen::Index>(f)] +=
          std::abs(product(load_rows_[l], rigid[f]) * contents[l].mean);
  }
  mean_->solve(p, &point.unbalanced);
  const std::vector<double> z(p.begin(), p.end());
  const auto count = static_cast<Eigen::Index>(sections_.size());
  point.mean.resize(count);
  point.twist_mean.resize(count);
  for (Eigen::Index s = 0; s < count; ++s) {
    const Section& section = sections_[static_cast<std::size_t>(s)];
    point.mean[s] = product(section.stiffness, z);
    point.twist_mean[s] = product(section.twist, z);
  }
}

void LinearResponse::vibration(double speed, Point& point, int only) {
  const auto& contents = content_->at(direction_ * speed);
  if (damping_here_.size() == 0 || content_->follows_speed()) damping_at(speed);
  const auto orders = static_cast<Eigen::Index>(orders_.size()),
             count = static_cast<Eigen::Index>(sections_.size());
  point.amplitude.setZero(orders, count);
  point.twist.setZero(orders, count);
  point.heat.setZero(count);
  point.input_power = point.dissipated_power = 0.0;
  active_.clear();
  for (int k = 0; k < static_cast<int>(orders); ++k) {
    if (only >= 0 && k != only) continue;
    const bool any = std::any_of(contents.begin(), contents.end(), [k](const OrderContent::Content& c) {
      return c.amplitudes[static_cast<std::size_t>(k)] != 0.0;
    });
    if (any) active_.push_back(k);
  }
  for (std::size_t first = 0; first < active_.size(); first += kLanes) solve_orders(speed, first, point);
}

bool LinearResponse::solve_lane(int lane, double omega) {
  for (std::size_t i = 0; i < z_.size(); ++i) z_[i] = {p_re_[i].v[lane], p_im_[i].v[lane]};
  const bool own = !system_.frequency_terms().empty();
  if (own) add_frequency_terms(std::abs(omega));
  const bool solved = elimination_.factorize(mass_, own ? damping_at_omega_ : damping_here_,
                                             own ? stiffness_at_omega_ : stiffness_here_, {0.0, omega});
  if (solved)
    elimination_.solve(z_.data());
  else
    std::fill(z_.begin(), z_.end(), Complex(0.0, 0.0));
  for (std::size_t i = 0; i < z_.size(); ++i) {
    re_[i].v[lane] = z_[i].real();
    im_[i].v[lane] = z_[i].imag();
  }
  return solved;
}

void LinearResponse::solve_orders(double speed, std::size_t first, Point& point) {
  const auto& contents = content_->at(direction_ * speed);
  const int used = static_cast<int>(std::min<std::size_t>(kLanes, active_.size() - first));
  Lanes w{};
  // Lanes that are not needed repeat the first.
  for (int lane = 0; lane < kLanes; ++lane)
    w[lane] = direction_ * orders_[idx(active_[first + idx(lane < used ? lane : 0)])] * speed;
  std::fill(p_re_.begin(), p_re_.end(), LaneRow{});
  std::fill(p_im_.begin(), p_im_.end(), LaneRow{});
  for (int lane = 0; lane < used; ++lane)
    for (std::size_t l = 0; l < contents.size(); ++l) {
      const Complex c = contents[l].amplitudes[idx(active_[first + idx(lane)])];
      for (const Entry& e : load_rows_[l]) {
        p_re_[idx(e.index)].v[lane] += e.coeff * c.real();
        p_im_[idx(e.index)].v[lane] += e.coeff * c.imag();
      }
    }
  re_ = p_re_;
  im_ = p_im_;
  const bool own = !system_.frequency_terms().empty();
  if (own) {
    damping_lanes_.resize(static_cast<std::size_t>(damping_here_.size()));
    stiffness_lanes_.resize(damping_lanes_.size());
    beyond_lanes_.resize(system_.frequency_terms().size());
    for (int lane = 0; lane < kLanes; ++lane) {
      if (lane < used) add_frequency_terms(std::abs(w[lane]));
      for (std::size_t e = 0; e < damping_lanes_.size(); ++e) {
        damping_lanes_[e].v[lane] = damping_at_omega_[static_cast<Eigen::Index>(e)];
        stiffness_lanes_[e].v[lane] = stiffness_at_omega_[static_cast<Eigen::Index>(e)];
      }
      for (std::size_t t = 0; t < beyond_.size(); ++t) beyond_lanes_[t][idx(lane)] = beyond_[t];
    }
  }
  // One or two frequencies are not worth the lanes.
  constexpr int kWorthLanes = 3;
  Lanes lost = Lanes{} + 1.0;
  if (used >= kWorthLanes && own)
    lanes_.solve(mass_.data(), damping_lanes_.data(), stiffness_lanes_.data(), w, re_, im_, lost);
  else if (used >= kWorthLanes)
    lanes_.solve(mass_.data(), damping_here_.data(), stiffness_here_.data(), w, re_, im_, lost);
  std::array<bool, kLanes> singular{};
  for (int lane = 0; lane < used; ++lane)
    if (lost[lane] != 0.0) singular[idx(lane)] = !solve_lane(lane, w[lane]);
  rows_->find(re_, im_);
  const auto each_lane = [&](const auto& task) {
    for (int lane = 0; lane < used; ++lane) task(lane, static_cast<Eigen::Index>(active_[first + idx(lane)]));
  };
  for (std::size_t s = 0; s < sections_.size(); ++s) {
    const Section& section = sections_[s];
    const auto c = static_cast<Eigen::Index>(s);
    using Row = LaneSections::Row;
    const LaneSections::Number elastic = rows_->of(s, Row::stiffness), rate = rows_->of(s, Row::damping),
                               twist = rows_->of(s, Row::twist), damper = rows_->of(s, Row::damper);
    // i w times a number turns it.
    Lanes re = elastic.re - w * rate.im, im = elastic.im + w * rate.re;
    Lanes heat = 0.5 * w * w * (damper.re * twist.re + damper.im * twist.im);
    if (section.frequency_term >= 0) {
      // The matrices' torque and what is beyond them; heat = w/2 Im(T conj x). At a negative w k* is conjugate.
      const LaneSections::Number own_row = rows_->of(s, Row::beyond);
      Lanes k_re{}, k_im{};
      for (int lane = 0; lane < kLanes; ++lane) {
        const Complex k = beyond_lanes_[idx(section.frequency_term)][idx(lane)];
        k_re[lane] = k.real();
        k_im[lane] = w[lane] > 0.0 ? k.imag() : -k.imag();
      }
      re += k_re * own_row.re - k_im * own_row.im;
      im += k_re * own_row.im + k_im * own_row.re;
      heat = 0.5 * w * (im * twist.re - re * twist.im);
    }
    each_lane([&](int lane, Eigen::Index k) {
      point.amplitude(k, c) = {re[lane], im[lane]};
      point.twist(k, c) = {twist.re[lane], twist.im[lane]};
      point.heat[c] += heat[lane];
    });
  }
  Lanes input{}, dissipated{};
  if (own)
    lane_powers(system_.pattern(), damping_lanes_.data(), w, p_re_, p_im_, re_, im_, input, dissipated);
  else
    lane_powers(system_.pattern(), damping_here_.data(), w, p_re_, p_im_, re_, im_, input, dissipated);
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  each_lane([&](int lane, Eigen::Index k) {
    point.input_power += input[lane];
    point.dissipated_power += dissipated[lane];
    if (!singular[idx(lane)]) return;
    point.amplitude.row(k).setConstant(kInfinite);
    point.twist.row(k).setConstant(kInfinite);
    point.heat.setConstant(kInfinite);
  });
}

}  // namespace drev
