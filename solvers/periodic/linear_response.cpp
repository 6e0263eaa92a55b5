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
    : system_(system), assembler_(system), orders_(orders), elimination_(system.pattern()) {
  check_model(options.close_contacts, findings);
  content_.emplace(system, orders, findings);
  for (const LoadTerm* load : content_->loads()) load_rows_.push_back(system.row_of(load->node));
  assembler_.contact_values({1.0, 0.0, 0.0}, Contact::closed, mass_);
  assembler_.contact_values({0.0, 1.0, 0.0}, Contact::closed, damping_);
  assembler_.contact_values({0.0, 0.0, 1.0}, Contact::closed, stiffness_);
  sections_ = find_section_rows(system, options.sections, findings);
  direction_ = reference_direction(system_);
  if (findings.empty()) mean_.emplace(system_, damping_, stiffness_, options.balance, findings);
  z_.resize(idx(system.size()));
  p_.resize(idx(system.size()));
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
  const int* outer = system_.pattern().outerIndexPtr();
  const int* inner = system_.pattern().innerIndexPtr();
  for (Eigen::Index k = 0; k < orders; ++k) {
    if (only >= 0 && k != only) continue;
    std::fill(z_.begin(), z_.end(), Complex(0.0, 0.0));
    bool any = false;
    for (std::size_t l = 0; l < contents.size(); ++l) {
      const Complex c = contents[l].amplitudes[static_cast<std::size_t>(k)];
      if (c == 0.0) continue;
      any = true;
      for (const Entry& e : load_rows_[l]) z_[idx(e.index)] += e.coeff * c;
    }
    if (!any) continue;
    p_ = z_;
    const Complex s(0.0, direction_ * orders_[static_cast<std::size_t>(k)] * speed);
    const bool complex_stiffness = !system_.frequency_terms().empty();
    if (complex_stiffness) add_frequency_terms(std::abs(s.imag()));
    const Vector& damping_values = complex_stiffness ? damping_at_omega_ : damping_here_;
    if (!elimination_.factorize(mass_, damping_values,
                                complex_stiffness ? stiffness_at_omega_ : stiffness_here_, s)) {
      point.amplitude.row(k).setConstant(std::numeric_limits<double>::infinity());
      point.twist.row(k).setConstant(std::numeric_limits<double>::infinity());
      point.heat.setConstant(std::numeric_limits<double>::infinity());
      continue;
    }
    elimination_.solve(z_.data());
    const double rate = std::norm(s);
    for (Eigen::Index c = 0; c < count; ++c) {
      const Section& section = sections_[static_cast<std::size_t>(c)];
      const Complex damping = product(section.damping, z_), twist = product(section.twist, z_);
      // s is imaginary: s times a number turns it.
      point.amplitude(k, c) =
          product(section.stiffness, z_) + Complex(-s.imag() * damping.imag(), s.imag() * damping.real());
      point.twist(k, c) = twist;
      if (section.frequency_term >= 0) {
        // The matrices' torque and what is beyond them; heat = w/2 Im(T conj x). At a negative s k* is conjugate.
        const auto& term = system_.frequency_terms()[idx(section.frequency_term)];
        const Complex beyond = beyond_[idx(section.frequency_term)];
        point.amplitude(k, c) += (s.imag() > 0.0 ? beyond : std::conj(beyond)) * product(term.z, z_);
        point.heat[c] += 0.5 * s.imag() * (point.amplitude(k, c) * std::conj(twist)).imag();
        continue;
      }
      const Complex damper = product(section.damper, z_);
      point.heat[c] += 0.5 * rate * (damper.real() * twist.real() + damper.imag() * twist.imag());
    }
    double dissipated = 0.0, input = 0.0;
    for (int j = 0; j < system_.size(); ++j) {
      const Complex z = z_[idx(j)], p = p_[idx(j)];
      input += s.imag() * (z.real() * p.imag() - z.imag() * p.real());
      for (int e = outer[j]; e < outer[j + 1]; ++e) {
        const Complex other = z_[idx(inner[e])];
        dissipated += damping_values[e] * (z.real() * other.real() + z.imag() * other.imag());
      }
    }
    point.input_power += 0.5 * input;
    point.dissipated_power += 0.5 * rate * dissipated;
  }
}

}  // namespace drev
